use std.textio.all;
use work.table.all;

-- Scalars of every kind, with subtypes, and strings.
entity scalars is
end entity;

architecture bench of scalars is
  type state_t is (idle, 'x', run, \Odd one\, done);
  type only_t is (only);
  type resistance is range 0 to 1_000_000 units ohm; kohm = 1000 ohm; end units;
  type modes_t is array (natural range <>) of state_t;
  type numbers_t is array (integer range <>) of integer;
  signal state : state_t;
  signal single : only_t;
  signal is_on : boolean;
  signal letter : character;
  signal level : severity_level;
  signal count : integer;
  signal share : integer range -100 to 100 := 0;
  signal natural_one : natural;
  signal gap : time;
  signal delay : delay_length := 0 fs;
  signal load : resistance;
  signal ratio : real;
  signal name : string(1 to 4);
  signal modes : modes_t(2 downto 1);
  signal numbers : numbers_t(-1 to 1) := (others => 0);
begin
  process
  begin
    wait for 10 ps;
    state <= 'x'; is_on <= true; letter <= 'a'; level <= warning; count <= integer'low; share <= -100;
    natural_one <= natural'high; gap <= -3 us; delay <= 1 fs; load <= 4700 ohm; ratio <= -0.1;
    name <= "abcd"; modes <= (run, done); numbers(-1) <= -5;
    wait for 10 ps;
    state <= \Odd one\; is_on <= false; letter <= ';'; level <= failure; count <= -1;
    share <= 99; natural_one <= 65536; gap <= 2562047788 us; load <= 1000 kohm; ratio <= 1.0e300;
    name(2) <= ' '; modes(1) <= 'x'; numbers <= (1, -2, integer'high);
    wait for 10 ps;
    state <= done; letter <= character'val(233); ratio <= 0.1 + 0.2; name <= "z""z\";
    wait for 10 ps;
    letter <= del; ratio <= -2.2250738585072014e-308; count <= 0;
    wait for 10 ps;
    wait;
  end process;

  postponed process (all)
    variable row : line;
  begin
    start(row, "word scalars.state;word scalars.single;word scalars.is_on;"
      & "character scalars.letter;word scalars.level;number scalars.count;number scalars.share;"
      & "number scalars.natural_one;number scalars.gap;number scalars.delay;number scalars.load;real scalars.ratio;"
      & "character scalars.name[1];character scalars.name[2];character scalars.name[3];character scalars.name[4];"
      & "word scalars.modes[2];word scalars.modes[1];"
      & "number scalars.numbers[-1];number scalars.numbers[0];number scalars.numbers[1]");
    put(row, state_t'image(state)); put(row, only_t'image(single));
    put(row, boolean'image(is_on)); put(row, integer'image(character'pos(letter)));
    put(row, severity_level'image(level)); put(row, integer'image(count)); put(row, integer'image(share));
    put(row, integer'image(natural_one)); put(row, time'image(gap)); put(row, time'image(delay));
    put(row, resistance'image(load)); put(row, to_string(ratio, "%.17g"));
    for place in name'range loop
      put(row, integer'image(character'pos(name(place))));
    end loop;
    for place in modes'range loop
      put(row, state_t'image(modes(place)));
    end loop;
    for place in numbers'range loop
      put(row, integer'image(numbers(place)));
    end loop;
    writeline(output, row);
  end process;
end architecture;
