library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;

-- Counts hits; a second address is for reading. Nothing has a value at power-up.
entity histogram is
  port (
    clk        : in  std_logic;
    clear      : in  std_logic;
    clear_word : in  std_logic_vector(7 downto 0);
    hit        : in  std_logic;
    code       : in  std_logic_vector(7 downto 0);
    read_en    : in  std_logic;
    read_addr  : in  std_logic_vector(7 downto 0);
    count      : out std_logic_vector(15 downto 0)
  );
end entity;

architecture rtl of histogram is
  type memory is array (0 to 255) of unsigned(15 downto 0);
  signal words : memory;
begin
  count <= std_logic_vector(words(to_integer(unsigned(read_addr))));

  process (clk)
  begin
    if rising_edge(clk) then
      if clear = '1' then
        words(to_integer(unsigned(clear_word))) <= (others => '0');
      elsif hit = '1' then
        words(to_integer(unsigned(code))) <= words(to_integer(unsigned(code))) + 1;
      end if;
    end if;
  end process;
end architecture;
