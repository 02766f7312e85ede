library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

-- A count of a clock, for tests that read GHDL's waveforms.
entity counter is
end entity;

architecture bench of counter is
  signal clk : std_logic := '0';
  signal count : unsigned(7 downto 0) := (others => '0');
  signal bus_z : std_logic_vector(3 downto 0) := "ZZ0X";
begin
  clk <= not clk after 5 ns;
  process (clk)
  begin
    if rising_edge(clk) then
      count <= count + 1;
      if count = 7 then
        bus_z <= "1H0L";
      end if;
    end if;
  end process;
end architecture;
