-- Golden vectors for {name} by tofsim {version}: scenario {source}, seed {seed}.
-- Line k of stimulus.mem is taken by edge k, line k of expected.mem seen just before it.
library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

entity tb_{name} is
  -- Whether what comes before the first reset is compared too.
  generic (FromPowerUp : boolean := false);
end entity;

architecture bench of tb_{name} is
  constant Cycles : positive := {cycles};
  constant FirstEdge : time := {first_edge};
  constant Period : time := {period};

{signals}
begin
  dut : entity work.{name}
{generics}    port map (
{ports}
    );
{statements}
  main : process
    file stimulus_file : text open read_mode is "stimulus.mem";
    file expected_file : text open read_mode is "expected.mem";
    -- Whole digits of a line, and what of them counts.
    variable stimulus : std_logic_vector({digits_in} downto 0);
    variable digits : std_logic_vector({digits_out} downto 0);
    variable got, want : std_logic_vector({line_out} downto 0);
    variable row : line;
    variable mismatches : natural := 0;
    -- Lines not compared yet; below 0: until a reset.
    variable quiet : integer := {quiet};

    procedure show(
      name : string; cycle : natural; before : time; right, seen : std_logic_vector
    ) is
      variable text_row : line;
    begin
      if seen /= right then
        write(text_row, "mismatch: cycle " & to_string(cycle) & ", time ");
        write(text_row, FirstEdge + cycle * Period - before, unit => ps);
        write(text_row, ", " & name & ": expected " & to_hstring(right));
        write(text_row, ", got " & to_hstring(seen));
        writeline(output, text_row);
      end if;
    end procedure;
  begin
    if FromPowerUp then
      quiet := 0;
    end if;
    readline(stimulus_file, row);
    hread(row, stimulus);
{before}    for cycle in 0 to Cycles - 1 loop
      readline(expected_file, row);
      hread(row, digits);
      want := digits({line_out} downto 0);
      got := want;
{steps}      if cycle < Cycles - 1 then
        readline(stimulus_file, row);
        hread(row, stimulus);
      end if;
    end loop;
    if mismatches = 0 then
      write(row, string'("tb_{name}: PASS, "));
    else
      write(row, string'("tb_{name}: FAIL, "));
    end if;
    write(row, to_string(Cycles) & " cycles, " & to_string(mismatches) & " mismatches");
    writeline(output, row);
    assert mismatches = 0
      report "tb_{name}: " & to_string(mismatches) & " mismatches" severity failure;
    std.env.finish;
    wait;
  end process;
end architecture;
