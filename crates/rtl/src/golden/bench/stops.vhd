
  stops : process
    file stops_file : text open read_mode is "tdc_stop.mem";
    variable row : line;
    variable stop_at : std_logic_vector(63 downto 0); -- [fs]
    variable instant : time;
  begin
    while not endfile(stops_file) loop
      readline(stops_file, row);
      hread(row, stop_at);
      instant := to_integer(unsigned(stop_at(59 downto 30))) * (2 ** 30 * 1 fs)
        + to_integer(unsigned(stop_at(29 downto 0))) * 1 fs;
      wait for instant - now;
      tdc_stop <= not tdc_stop;
    end loop;
    wait;
  end process;
