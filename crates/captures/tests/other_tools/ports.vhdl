library ieee;
use ieee.std_logic_1164.all;

package ports_package is
  signal common : std_logic_vector(1 downto 0) := "0Z";
end package;

library ieee;
use ieee.std_logic_1164.all;

entity ports_stage is
  generic (width : positive);
  port (a : in std_logic_vector(width - 1 downto 0); b : in std_logic_vector(0 to 1);
    y : out std_logic_vector(width to 2 * width - 1); seen : out std_logic_vector(width downto 0));
end entity;
architecture stage of ports_stage is
  signal copy : std_logic_vector(width downto 0);
begin
  copy <= a & b(0) after 250 ps;
  y <= not copy(width downto 1);
  seen <= copy;
end architecture;

library ieee;
use ieee.std_logic_1164.all;
use std.textio.all;
use work.table.all;
use work.ports_package.all;

-- Slices, bits, fields and joined parts of signals as ports, in generate statements, blocks and generics.
entity ports is
end entity;

architecture bench of ports is
  type pair_t is record
    high, low : std_logic_vector(0 to 3);
  end record;
  signal bus_d : std_logic_vector(9 downto 2) := x"00";
  signal bus_u : std_logic_vector(2 to 9) := x"00";
  signal pair : pair_t := (x"0", x"0");
  signal y_slice, y_joined : std_logic_vector(0 to 3);
  signal y_for : std_logic_vector(5 downto 0);
  type taps_t is array (-1 to 1) of std_logic;
  type seen_t is array (-1 to 1) of std_logic_vector(2 downto 0);
  signal taps : taps_t;
  signal seen : seen_t;
  signal seen_sliced, seen_joined : std_logic_vector(4 downto 0);
begin
  sliced : entity work.ports_stage generic map (4) port map (bus_d(7 downto 4), bus_u(8 to 9), y_slice, seen_sliced);
  joined : entity work.ports_stage generic map (4) port map (
    a(3 downto 2) => pair.low(1 to 2), a(1) => bus_u(2), a(0) => bus_d(9), b(0) => common(1), b(1) => pair.high(3),
    y => y_joined, seen => seen_joined);
  each : for k in -1 to 1 generate
    signal tapped : std_logic;
  begin
    tapped <= bus_d(4 + k) xor common(0);
    taps(k) <= tapped;
    stage : entity work.ports_stage generic map (2)
      port map (bus_d(7 + 2 * k downto 6 + 2 * k), pair.low(1 + k to 2 + k), y_for(3 + 2 * k downto 2 + 2 * k),
        seen(k));
  end generate;
  chosen : if bus_d'length = 8 generate
    inside : block
      signal parity : std_logic;
    begin
      parity <= xor bus_d;
    end block;
  end generate;

  process
  begin
    wait for 1 ns;
    bus_d <= "01100011"; bus_u <= "10010110"; pair <= ("0101", "0011"); common <= "10";
    wait for 1 ns;
    bus_d(6 downto 5) <= "ZX"; bus_u(9) <= 'H'; pair.low <= "1L0W"; common(1) <= '0';
    wait for 1 ns;
    bus_d <= x"a5"; pair.high <= "111-";
    wait for 1 ns;
    wait;
  end process;

  postponed process (all)
    variable row : line;
    function part(k : string) return string is
      constant stage : string := "] ports.each(" & k & ").stage.";
    begin
      return ";bits ports.each(" & k & ").tapped;bits[1:0" & stage & "a;bits[0:1" & stage & "b;bits[2:0" & stage
        & "copy;bits[2:3" & stage & "y;bits[2:0" & stage
        & "seen;bits[2:0] ports.seen[" & k & "]";
    end function;
  begin
    start(row, "bits[1:0] ports_package.common;bits[9:2] ports.bus_d;bits[2:9] ports.bus_u;bits[0:3] ports.pair.high;"
      & "bits[0:3] ports.pair.low;bits[0:3] ports.y_slice;bits[0:3] ports.y_joined;bits[5:0] ports.y_for;"
      & "bits[4:0] ports.sliced.copy;bits[3:0] ports.sliced.a;bits[0:1] ports.sliced.b;bits[4:7] ports.sliced.y;"
      & "bits[4:0] ports.joined.copy;bits[3:0] ports.joined.a;bits[0:1] ports.joined.b;bits[4:7] ports.joined.y"
      & part("-1") & part("0") & part("1") & ";bits ports.chosen.inside.parity;bits[-1:1] ports.taps"
      & ";bits[4:0] ports.seen_sliced;bits[4:0] ports.sliced.seen;bits[4:0] ports.seen_joined"
      & ";bits[4:0] ports.joined.seen");
    put(row, to_string(common)); put(row, to_string(bus_d)); put(row, to_string(bus_u));
    put(row, to_string(pair.high)); put(row, to_string(pair.low));
    put(row, to_string(y_slice)); put(row, to_string(y_joined)); put(row, to_string(y_for));
    put(row, to_string(seen_sliced)); put(row, to_string(bus_d(7 downto 4))); put(row, to_string(bus_u(8 to 9)));
    put(row, to_string(y_slice));
    put(row, to_string(seen_joined)); put(row, to_string(pair.low(1 to 2) & bus_u(2) & bus_d(9)));
    put(row, to_string(common(1) & pair.high(3))); put(row, to_string(y_joined));
    for k in -1 to 1 loop
      put(row, to_string(taps(k))); put(row, to_string(bus_d(7 + 2 * k downto 6 + 2 * k)));
      put(row, to_string(pair.low(1 + k to 2 + k))); put(row, to_string(seen(k)));
      put(row, to_string(y_for(3 + 2 * k downto 2 + 2 * k)));
      put(row, to_string(seen(k))); put(row, to_string(seen(k)));
    end loop;
    put(row, to_string(xor bus_d)); put(row, to_string(std_logic_vector'(taps(-1) & taps(0) & taps(1))));
    put(row, to_string(seen_sliced)); put(row, to_string(seen_sliced));
    put(row, to_string(seen_joined)); put(row, to_string(seen_joined));
    writeline(output, row);
  end process;
end architecture;
