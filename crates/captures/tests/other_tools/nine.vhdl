library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use ieee.fixed_pkg.all;
use std.textio.all;
use work.table.all;

-- The nine values of std_ulogic, alone and in vectors that ascend, descend and do not end at 0.
entity nine is
end entity;

architecture bench of nine is
  signal level : std_ulogic;
  signal driven : std_logic;
  signal down : std_logic_vector(8 downto 0);
  signal up : std_ulogic_vector(3 to 11);
  signal far : unsigned(40 downto 33);
  signal small : sfixed(2 downto -3);
  signal wide : std_logic_vector(99 downto 0) := (others => 'Z');
  signal single : std_logic_vector(5 downto 5);
  signal empty : std_logic_vector(0 downto 1);
  signal flag : bit;
  signal word : bit_vector(0 to 6);
begin
  driven <= down(0);
  driven <= up(11);
  process
  begin
    for value in std_ulogic loop
      wait for 1 ns;
      level <= value;
      down <= down(7 downto 0) & value;
      up <= up(4 to 11) & value;
      far <= far(34 downto 33) & "10-" & value & "LH";
      small <= to_sfixed(real(std_ulogic'pos(value) - 4) / 8.0, small);
      wide <= value & wide(99 downto 1);
      single <= (others => value);
      flag <= not flag;
      word <= to_bitvector(std_logic_vector(to_unsigned(std_ulogic'pos(value) * 13, 7)));
    end loop;
    wait for 500 ps;
    up <= "UX01ZWLH-";
    down <= "-HLWZ10XU";
    wait for 1 ns;
    wait;
  end process;

  postponed process (all)
    variable row : line;
  begin
    start(row, "bits nine.level;bits nine.driven;bits[8:0] nine.down;bits[3:11] nine.up;bits[40:33] nine.far;"
      & "bits[2:-3] nine.small;bits[99:0] nine.wide;bits[5:5] nine.single;bits nine.flag;bits[0:6] nine.word");
    put(row, to_string(level)); put(row, to_string(driven)); put(row, to_string(down)); put(row, to_string(up));
    put(row, to_string(far)); put(row, to_string(to_slv(small))); put(row, to_string(wide));
    put(row, to_string(single)); put(row, to_string(flag)); put(row, to_string(word));
    writeline(output, row);
  end process;
end architecture;
