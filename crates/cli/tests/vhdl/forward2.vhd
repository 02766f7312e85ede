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

-- The output layer of eight neurons: two products an edge, and the bias before the first.
entity forward2 is
  generic (
    W2File : string := "w2.mem";
    B2File : string := "b2.mem"
  );
  port (
    clk_sys : in std_logic;
    rst : in std_logic;
    pair : in std_logic_vector(2 downto 0);
    forward2_first : in std_logic;
    forward2_en : in std_logic;
    depth_en : in std_logic;
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
  type operands is array (natural range <>) of signed(15 downto 0);
  type products is array (0 to 1) of signed(31 downto 0);
  type sums is array (0 to 1) of signed(35 downto 0);
  constant W2 : std_logic_vector(127 downto 0) := first_line(W2File, 128);
  constant Bias : signed(35 downto 0) := shift_left(resize(signed(first_line(B2File, 16)), 36), 12);
  -- Zeros stand past the last neuron.
  constant Weights : operands(0 to 15) := (
    signed(W2(15 downto 0)), signed(W2(31 downto 16)), signed(W2(47 downto 32)),
    signed(W2(63 downto 48)), signed(W2(79 downto 64)), signed(W2(95 downto 80)),
    signed(W2(111 downto 96)), signed(W2(127 downto 112)), others => (others => '0')
  );
  signal activations : operands(0 to 15);
  signal a, b : operands(0 to 1) := (others => (others => '0'));
  signal product : products := (others => (others => '0'));
  signal sum : sums := (others => (others => '0'));
  signal total : signed(35 downto 0) := (others => '0');
begin
  activations <= (
    signed(l1_out_0), signed(l1_out_1), signed(l1_out_2), signed(l1_out_3), signed(l1_out_4),
    signed(l1_out_5), signed(l1_out_6), signed(l1_out_7), others => (others => '0')
  );
  depth <= std_logic_vector(total);

  process (clk_sys)
    variable begins : signed(35 downto 0);
  begin
    if rising_edge(clk_sys) then
      for k in 0 to 1 loop
        a(k) <= activations(to_integer(unsigned(pair)) * 2 + k);
        b(k) <= Weights(to_integer(unsigned(pair)) * 2 + k);
        product(k) <= a(k) * b(k);
        if forward2_en = '1' then
          if forward2_first = '0' then
            begins := sum(k);
          elsif k = 0 then
            begins := Bias;
          else
            begins := (others => '0');
          end if;
          sum(k) <= begins + product(k);
        end if;
      end loop;
      if rst then
        total <= (others => '0');
      elsif depth_en = '1' then
        total <= sum(0) + sum(1);
      end if;
    end if;
  end process;
end architecture;
