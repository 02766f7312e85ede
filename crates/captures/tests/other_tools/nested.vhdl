library ieee;
use ieee.std_logic_1164.all;
use std.textio.all;
use work.table.all;

-- Records in records and in arrays, arrays of arrays, and arrays of two and three dimensions.
entity nested is
end entity;

architecture bench of nested is
  type state_t is (idle, run, done);
  subtype busy_t is state_t range run to done;
  type inner_t is record
    level : std_logic;
    code : std_logic_vector(3 downto 0);
    state : state_t;
  end record;
  type outer_t is record
    first, second : inner_t;
    ratio : real;
    busy : busy_t;
    flags : bit_vector(1 to 2);
  end record;
  type inners_t is array (natural range <>) of inner_t;
  type grid_t is array (1 downto 0, 2 to 4) of std_logic;
  type table_t is array (state_t, 0 to 1) of integer;
  type cube_t is array (0 to 1, 1 downto 0, 0 to 2) of bit;
  type words_t is array (natural range <>) of std_logic_vector;
  type open_t is record
    bus_a, bus_b : std_logic_vector;
  end record;
  signal level : bit;
  signal outer : outer_t := (('0', x"0", idle), ('U', "ZZZZ", run), 0.0, run, "00");
  signal list : inners_t(0 to 1);
  signal grid : grid_t;
  signal lookup : table_t := (others => (others => 0));
  signal cube : cube_t;
  signal words : words_t(3 downto 2)(0 to 3) := (x"0", x"1");
  signal pair : open_t(bus_a(2 downto 0), bus_b(7 to 8));
begin
  process
  begin
    wait for 3 ns;
    outer.first <= ('1', "10XZ", run); list(1).code(2) <= 'H'; grid(1, 4) <= 'L'; lookup(run, 0) <= -7;
    cube(1, 0, 2) <= '1'; words(2) <= "01W-"; pair.bus_a <= "110";
    wait for 3 ns;
    outer.second.state <= idle; outer.ratio <= 0.5; outer.busy <= done; level <= '1'; outer.flags(2) <= '1';
    list(0) <= ('-', x"9", run); grid <= ("01X", "Z1H"); lookup <= ((1, 2), (3, 4), (5, 6));
    cube(0, 1, 0) <= '1'; cube(1, 0, 2) <= '0'; words <= (x"c", x"5"); pair.bus_b <= "01";
    wait for 3 ns;
    wait;
  end process;

  postponed process (all)
    variable row : line;
    procedure put(one : inner_t) is
    begin
      put(row, to_string(one.level)); put(row, to_string(one.code)); put(row, state_t'image(one.state));
    end procedure;
  begin
    start(row, "bits nested.level;bits nested.outer.first.level;bits[3:0] nested.outer.first.code;"
      & "word nested.outer.first.state;"
      & "bits nested.outer.second.level;bits[3:0] nested.outer.second.code;word nested.outer.second.state;"
      & "real nested.outer.ratio;word nested.outer.busy;bits[1:2] nested.outer.flags;"
      & "bits nested.list[0].level;bits[3:0] nested.list[0].code;word nested.list[0].state;"
      & "bits nested.list[1].level;bits[3:0] nested.list[1].code;word nested.list[1].state;"
      & "bits[2:4] nested.grid[1];bits[2:4] nested.grid[0];"
      & "number nested.lookup[0][0];number nested.lookup[0][1];number nested.lookup[1][0];number nested.lookup[1][1];"
      & "number nested.lookup[2][0];number nested.lookup[2][1];"
      & "bits[0:2] nested.cube[0][1];bits[0:2] nested.cube[0][0];"
      & "bits[0:2] nested.cube[1][1];bits[0:2] nested.cube[1][0];"
      & "bits[0:3] nested.words[3];bits[0:3] nested.words[2];"
      & "bits[2:0] nested.pair.bus_a;bits[7:8] nested.pair.bus_b");
    put(row, to_string(level)); put(outer.first); put(outer.second);
    put(row, to_string(outer.ratio, "%.17g")); put(row, state_t'image(outer.busy));
    put(row, to_string(outer.flags));
    put(list(0)); put(list(1));
    for y in grid'range(1) loop
      put(row, to_string(std_logic_vector'(grid(y, 2) & grid(y, 3) & grid(y, 4))));
    end loop;
    for state in state_t loop
      put(row, integer'image(lookup(state, 0))); put(row, integer'image(lookup(state, 1)));
    end loop;
    for z in cube'range(1) loop
      for y in cube'range(2) loop
        put(row, to_string(bit_vector'(cube(z, y, 0) & cube(z, y, 1) & cube(z, y, 2))));
      end loop;
    end loop;
    put(row, to_string(words(3))); put(row, to_string(words(2)));
    put(row, to_string(pair.bus_a)); put(row, to_string(pair.bus_b));
    writeline(output, row);
  end process;
end architecture;
