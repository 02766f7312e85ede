library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use std.textio.all;

-- The first line of a file in hexadecimal.
package memory_file is
  impure function first_line(name : string; bits : positive) return std_logic_vector;
end package;

package body memory_file is
  impure function first_line(name : string; bits : positive) return std_logic_vector is
    file lines : text open read_mode is name;
    variable row : line;
    variable result : std_logic_vector(bits - 1 downto 0);
  begin
    readline(lines, row);
    hread(row, result);
    return result;
  end function;
end package body;

library ieee;
use ieee.std_logic_1164.all;
use ieee.numeric_std.all;
use work.memory_file.all;

-- The output layer of eight neurons: one product an edge, then the bias.
entity forward2 is
  generic (
    W2File : string := "w2.mem";
    B2File : string := "b2.mem"
  );
  port (
    clk_125 : in std_logic;
    rst : in std_logic;
    forward2_en : in std_logic;
    neuron : in std_logic_vector(3 downto 0);
    l1_out_0 : in std_logic_vector(15 downto 0);
    l1_out_1 : in std_logic_vector(15 downto 0);
    l1_out_2 : in std_logic_vector(15 downto 0);
    l1_out_3 : in std_logic_vector(15 downto 0);
    l1_out_4 : in std_logic_vector(15 downto 0);
    l1_out_5 : in std_logic_vector(15 downto 0);
    l1_out_6 : in std_logic_vector(15 downto 0);
    l1_out_7 : in std_logic_vector(15 downto 0);
    depth : out std_logic_vector(35 downto 0)
  );
end entity;

architecture rtl of forward2 is
  type operands is array (0 to 8) of signed(15 downto 0);
  constant W2 : std_logic_vector(127 downto 0) := first_line(W2File, 128);
  constant B2 : std_logic_vector(15 downto 0) := first_line(B2File, 16);
  constant Weights : operands := (
    signed(W2(15 downto 0)), signed(W2(31 downto 16)), signed(W2(47 downto 32)),
    signed(W2(63 downto 48)), signed(W2(79 downto 64)), signed(W2(95 downto 80)),
    signed(W2(111 downto 96)), signed(W2(127 downto 112)), signed(B2)
  );
  signal activations : operands;
  signal sum : signed(35 downto 0) := (others => '0');
begin
  activations <= (
    signed(l1_out_0), signed(l1_out_1), signed(l1_out_2), signed(l1_out_3), signed(l1_out_4),
    signed(l1_out_5), signed(l1_out_6), signed(l1_out_7), to_signed(4096, 16)
  );
  depth <= std_logic_vector(sum);

  process (clk_125)
    variable before : signed(35 downto 0);
  begin
    if rising_edge(clk_125) then
      if rst then
        sum <= (others => '0');
      elsif forward2_en = '1' and unsigned(neuron) <= 8 then
        before := sum;
        if unsigned(neuron) = 0 then
          before := (others => '0');
        end if;
        sum <= before
          + activations(to_integer(unsigned(neuron))) * Weights(to_integer(unsigned(neuron)));
      end if;
    end if;
  end process;
end architecture;
