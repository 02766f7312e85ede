
  -- Numbers, because GHDL's stack has no room for so many bits.
  type words is array (natural range <>) of natural;

  impure function read_words(name : string; size : positive) return words is
    file words_file : text open read_mode is name;
    variable row : line;
    variable word : std_logic_vector(15 downto 0);
    variable result : words(0 to size - 1) := (others => 0);
  begin
    for k in result'range loop
      exit when endfile(words_file);
      readline(words_file, row);
      hread(row, word);
      result(k) := to_integer(unsigned(word));
    end loop;
    return result;
  end function;

