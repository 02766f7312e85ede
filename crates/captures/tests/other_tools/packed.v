`timescale 100ps / 10ps
`default_nettype none

// Types of SystemVerilog: enumerations, packed structures and arrays, integers of two values, and strings.
module packed_types;
  typedef enum logic [2:0] {IDLE = 1, RUN = 3, DONE = 6} state_t;
  typedef struct packed {logic [3:0] high; logic valid; logic [2:0] low;} pair_t;
  state_t state;
  pair_t pair;
  logic [1:0][3:0] rows;
  bit [4:0] two;
  byte little;
  shortint short_number;
  longint long_number;
  int number;
  byte unsigned octet;
  logic signed [7:-2] fixed;

  initial begin
    $dumpfile(`FILE);
    $dumpvars;
    $timeformat(-12, 0, "", 0);
    $display({"time_ps;bits[2:0] packed_types.state;bits[7:0] packed_types.pair;bits[7:0] packed_types.rows;",
      "bits[4:0] packed_types.two;number[7:0] packed_types.little;number[15:0] packed_types.short_number;",
      "number[63:0] packed_types.long_number;number[31:0] packed_types.number;number[7:0] packed_types.octet;",
      "bits[7:-2] packed_types.fixed"});
    $monitor("%0t;%b;%b;%b;%b;%0d;%0d;%0d;%0d;%0d;%b", $realtime, state, pair, rows, two, little, short_number,
      long_number, number, octet, fixed);
    #1.1 state = IDLE; pair = {4'hc, 1'b1, 3'bxz0}; rows[1] = 4'h7; two = 5'b1x0z1; little = -1; number = -2147483648;
    #1.1 state = RUN; pair.valid = 0; rows[0][2] = 1'b1; short_number = -300; long_number = -64'd5; octet = 200;
    #1.1 state = DONE; pair.low = 3'd5; rows = 8'hz3; little = 127; fixed = -3;
    #1.1 fixed = 10'b01_zz_xx_1111; long_number = 64'h7fff_ffff_ffff_ffff;
    #1 $finish(0);
  end
endmodule
