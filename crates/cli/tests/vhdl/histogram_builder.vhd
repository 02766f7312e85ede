library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

-- The histogram, with one address for clearing, counting and reading. Its names have capitals.
entity Histogram_Builder is
  port (
    Clk_Sys    : in  std_logic;
    Clear      : in  std_logic;
    Clear_Addr : in  std_logic_vector(7 downto 0);
    Tdc_Valid  : in  std_logic;
    Tdc_Code   : in  std_logic_vector(7 downto 0);
    Read_En    : in  std_logic;
    Read_Addr  : in  std_logic_vector(7 downto 0);
    Count      : out std_logic_vector(15 downto 0)
  );
end entity;

architecture rtl of Histogram_Builder is
  type ram_t is array (0 to 255) of unsigned(15 downto 0);
  signal ram      : ram_t := (others => (others => '0'));
  signal addr     : unsigned(7 downto 0);
  signal hit_word : unsigned(15 downto 0) := (others => '0');
  signal first, second : std_logic := '0';  -- cycle of a hit
begin
  addr <= unsigned(Clear_Addr) when Clear else
          unsigned(Tdc_Code) when first or second else
          unsigned(Read_Addr);
  Count <= std_logic_vector(ram(to_integer(addr))) when Read_En else (others => '0');

  process (Clk_Sys)
  begin
    if rising_edge(Clk_Sys) then
      hit_word <= ram(to_integer(addr));
      first <= Tdc_Valid and not Clear;
      second <= first and not Clear;
      if Clear then
        ram(to_integer(addr)) <= (others => '0');
      elsif second then
        ram(to_integer(addr)) <= hit_word + 1;
      end if;
    end if;
  end process;
end architecture;
