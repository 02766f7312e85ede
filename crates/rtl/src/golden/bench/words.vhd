
  type words is array (natural range <>) of std_logic_vector(15 downto 0);

  impure function read_words(name : string; size : positive) return words is
    file words_file : text open read_mode is name;
    variable row : line;
    variable result : words(0 to size - 1) := (others => (others => '0'));
  begin
    for k in result'range loop
      exit when endfile(words_file);
      readline(words_file, row);
      hread(row, result(k));
    end loop;
    return result;
  end function;

