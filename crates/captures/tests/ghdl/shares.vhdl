library ieee;
use ieee.std_logic_1164.all;

-- A port of three bits, for entities whose ports share signals.
entity three is
  port (up : in std_logic_vector(0 to 2); down : in std_logic_vector(2 downto 0));
end entity;
architecture bench of three is begin end architecture;

library ieee;
use ieee.std_logic_1164.all;

-- Names that share parts of their signals, and types of every kind, for tests that read GHDL's waveforms.
entity shares is
end entity;

architecture bench of shares is
  type state_t is (idle, run, done);
  subtype busy_t is state_t range run to done;
  type pair_t is record
    high : std_logic_vector(1 downto 0);
    low : std_logic_vector(0 to 3);
  end record;
  type grid_t is array (0 to 1, 0 to 2) of std_logic;
  type rows_t is array (natural range <>) of std_logic_vector(3 downto 0);
  signal state : state_t := idle;
  signal busy : busy_t := run;
  signal is_on : boolean := false;
  signal pair : pair_t := ("00", "0000");
  signal grid : grid_t := (others => (others => '0'));
  signal rows : rows_t(2 downto 1) := (others => x"0");
  signal wide : std_logic_vector(7 downto 0) := x"00";
  signal rising : std_logic_vector(0 to 7) := x"00";
  signal one : std_logic := '0';
  signal count : integer := 0;
  signal gap : time := 0 ns;
  signal ratio : real := 0.0;
begin
  inner : entity work.three port map (up => wide(6 downto 4), down => rising(1 to 3));
  joined : entity work.three port map (
    up(0 to 1) => pair.high, up(2) => one, down(2) => wide(0), down(1 downto 0) => rising(6 to 7));
  process
  begin
    wait for 5 ns;
    wide <= "01100011"; rising <= "01100011"; one <= '1'; pair <= ("10", "0111");
    grid(1, 2) <= '1'; rows(1) <= x"a";
    state <= run; busy <= done; is_on <= true; count <= -2; gap <= 3 us; ratio <= 0.5;
    wait for 5 ns;
    wide <= "00101100"; rising <= "11010100"; one <= 'Z'; pair <= ("01", "100X");
    state <= done; is_on <= false;
    wait for 10 ns;
    wait;
  end process;
end architecture;
