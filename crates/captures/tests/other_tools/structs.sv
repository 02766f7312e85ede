`timescale 1ns / 1ps

// Types of SystemVerilog: enumerations, packed structures and unions, and packed and unpacked arrays.
package structs_package;
  typedef enum logic [1:0] {IDLE, RUN, DONE = 3} state_t;
  typedef struct packed {logic [3:0] high; logic valid; logic [2:0] low;} pair_t;
  typedef struct packed {pair_t first; state_t state;} outer_t;
  typedef union packed {logic [7:0] word; pair_t pair;} either_t;
endpackage

module structs;
  import structs_package::*;
  logic clk = 0;
  state_t state = IDLE;
  pair_t pair = '0;
  outer_t outer = '0;
  either_t either = '0;
  logic [1:0][2:4] packed_grid = '0;
  logic [3:0] memory [5:7];
  logic grid [0:1][0:1];
  pair_t pairs [1:0];
  real ratio = 0;
  int number = 0;
  longint long_number = 0;
  byte octet = 0;
  logic [0:9] up = '0;
  logic [12:8] far = '0;
  logic [131:0] wide = '0;

  initial begin
    memory[5] = 0; memory[6] = 0; memory[7] = 0;
    grid[0][0] = 0; grid[0][1] = 0; grid[1][0] = 0; grid[1][1] = 0;
    pairs[0] = '0; pairs[1] = '0;
    $dumpfile("structs.wave");
    $dumpvars;
    $write("time_ps;bits structs.clk;bits[1:0] structs.state;bits[7:0] structs.pair;bits[9:0] structs.outer;");
    $write("bits[7:0] structs.either;");
    $write("bits[5:0] structs.packed_grid;bits[3:0] structs.memory[5];bits[3:0] structs.memory[6];");
    $write("bits[3:0] structs.memory[7];");
    $write("bits[1:0] structs.grid[0];bits[1:0] structs.grid[1];bits[7:0] structs.pairs[0];");
    $write("bits[7:0] structs.pairs[1];");
    $write("real structs.ratio;number[31:0] structs.number;number[63:0] structs.long_number;");
    $write("number[7:0] structs.octet;bits[0:9] structs.up;bits[12:8] structs.far;");
    $write("bits[131:0] structs.wide;bits[3:0] structs.pair.high;bits structs.pair.valid;bits[2:0] structs.pair.low;");
    $write("bits[3:0] structs.outer.first.high;");
    $write("bits structs.outer.first.valid;bits[2:0] structs.outer.first.low;bits[1:0] structs.outer.state;");
    $write("bits[2:4] structs.packed_grid[0];");
    $write("bits[2:4] structs.packed_grid[1];bits[3:0] structs.pairs[1].high;bits structs.pairs[1].valid;");
    $write("bits[2:0] structs.pairs[1].low;");
    $write("bits[7:0] structs.either.word;bits[3:0] structs.either.pair.high;bits structs.either.pair.valid;");
    $write("bits[2:0] structs.either.pair.low;bits[3:0] structs.pairs[0].high;bits structs.pairs[0].valid;");
    $write("bits[2:0] structs.pairs[0].low\n");
    #1.5 state = RUN; pair = '{4'ha, 1'b1, 3'd5}; packed_grid[1] = 3'b011; memory[6] = 4'h9; grid[1][0] = 1;
    ratio = 0.1; number = -2; long_number = -64'd5_000_000_000; octet = -100; up = 10'h2f1; wide[131:126] = 6'b101101;
    #1.5 outer = '{'{4'h3, 1'b0, 3'd6}, DONE}; pairs[1] = '{4'hc, 1'b1, 3'd1}; either.pair.low = 3'd7; far = 5'b10010;
    ratio = 0.1 + 0.2; memory[7] = 4'hf; grid[0][1] = 1; packed_grid[0] = 3'b100;
    #1.5 state = DONE; either.word = 8'h5a; outer.first.valid = 1;
    wide = {4'hc, 128'h0123_4567_89ab_cdef_fedc_ba98_7654_3210};
    ratio = -1.0e300; number = 32'h7fff_ffff; pairs[0].low = 3'd2;
    #1.25 $finish;
  end
  always #0.75 clk = ~clk;

  // A row is printed a picosecond after its instant, because Verilator has no `$strobe`.
  initial for (int at = 0; at <= 5250; at += 750) begin
    #0.001 $write("%0d;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;", at, clk, state, pair, outer, either, packed_grid,
      memory[5], memory[6], memory[7], {grid[0][1], grid[0][0]}, {grid[1][1], grid[1][0]}, pairs[0], pairs[1]);
    $write("%.17g;%0d;%0d;%0d;%b;%b;%b;", ratio, number, long_number, octet, up, far, wide);
    $write("%b;%b;%b;%b;%b;%b;%b;%b;%b;", pair.high, pair.valid, pair.low, outer.first.high, outer.first.valid,
      outer.first.low, outer.state, packed_grid[0], packed_grid[1]);
    $display("%b;%b;%b;%b;%b;%b;%b;%b;%b;%b", pairs[1].high, pairs[1].valid, pairs[1].low, either.word,
      either.pair.high, either.pair.valid, either.pair.low, pairs[0].high, pairs[0].valid, pairs[0].low);
    #0.749;
  end
endmodule
