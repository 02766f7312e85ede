library ieee; use ieee.std_logic_1164.all; use ieee.numeric_std.all;
entity types is end;
architecture a of types is
  type st is (Idle, Run, 'x', Done);
  type rec is record a: std_logic; n: integer; s: st; end record;
  type mat is array (0 to 1, 1 downto 0) of std_logic_vector(3 downto 0);
  signal s: st := Idle; signal b: boolean := false; signal c: character := 'a';
  signal str: string(1 to 3) := "abc"; signal tm: time := 1 ns; signal r: real := 0.5;
  signal i: integer := -3; signal n: natural range 0 to 7 := 2; signal u: std_ulogic := 'U';
  signal v: std_ulogic_vector(8 downto 0) := "UX01ZWLH-"; signal up: std_logic_vector(0 to 3) := "0001";
  signal q: rec := ('0', 5, Run); signal m: mat := (others => (others => "1010")); signal bt: bit := '0'; signal bv: bit_vector(2 downto 0) := "010";
begin
  process begin
    wait for 1 ns; s <= Run; b <= true; c <= 'Z'; str <= "xyz"; tm <= 5 us; r <= -1.25e30; i <= 7; n <= 5; u <= 'H'; v <= "-HLWZ10XU"; up <= "1000"; q <= ('1', -1, Done); m(0,1) <= "0000"; bt <= '1'; bv <= "101";
    wait for 2 ns; s <= 'x'; b <= false; c <= ' '; r <= 3.0; u <= '0';
    wait for 1 ns; s <= Done; wait;
  end process;
end;
