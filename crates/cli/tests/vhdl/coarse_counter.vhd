library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

-- Counts the cycles of a shot, and closes the window after eight.
entity coarse_counter is
  port (
    clk_sys : in  std_logic;
    rst     : in  std_logic;
    start   : in  std_logic;
    coarse  : out std_logic_vector(2 downto 0) := "000";
    window  : out std_logic := '0'
  );
end entity;

architecture rtl of coarse_counter is
  signal count : unsigned(2 downto 0) := "000";
  signal open_now : std_logic := '0';
begin
  coarse <= std_logic_vector(count);
  window <= open_now;

  process (clk_sys)
  begin
    if rising_edge(clk_sys) then
      if rst = '1' then
        count <= "000";
        open_now <= '0';
      elsif start = '1' then
        count <= "000";
        open_now <= '1';
      elsif open_now = '1' then
        if count = 7 then
          open_now <= '0';
        else
          count <= count + 1;
        end if;
      end if;
    end if;
  end process;
end architecture;
