`timescale 1ns / 1ps
`default_nettype none

// Levels of registers and nets: four values, resolution, wide and signed vectors, and glitches within an instant.
module levels;
  reg level;
  reg [7:0] down;
  reg [0:6] up;
  reg [40:33] far;
  reg [2:-3] little;
  reg [129:0] wide;
  reg signed [5:0] sum;
  reg [3:0] data;
  reg enable;
  wire [3:0] bus = enable ? data : 4'bz;
  tri1 pulled = enable ? data[0] : 1'bz;
  wand joined = data[1];
  wor either = data[1];
  wire late;
  assign joined = data[2];
  assign either = data[2];
  assign (weak0, weak1) bus = 4'b10z1;
  assign #0.125 late = ^data;

  initial begin
    $dumpfile(`FILE);
    $dumpvars;
    $timeformat(-12, 0, "", 0);
    $display({"time_ps;bits levels.level;bits[7:0] levels.down;bits[0:6] levels.up;bits[40:33] levels.far;",
      "bits[2:-3] levels.little;bits[129:0] levels.wide;bits[5:0] levels.sum;bits[3:0] levels.data;",
      "bits levels.enable;bits[3:0] levels.bus;bits levels.pulled;bits levels.joined;bits levels.either;",
      "bits levels.late"});
    $monitor("%0t;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b", $realtime, level, down, up, far, little, wide, sum, data,
      enable, bus, pulled, joined, either, late);
    #1 level = 0; down = 8'h0f; up = 7'b1100000; far = 8'bzzzz_xx01; sum = -3; data = 4'b0110; enable = 1;
    #1 level = 1'bz; down[3] = 1'bx; up[0] = 0; little = 6'b10_0011;
    wide = 130'h2_0123_4567_89ab_cdef_0000_0000_0000_0001;
    #0 down = 8'haa; data = 4'b1111;
    #0 down = 8'h55; data = 4'b0011;
    #0.3 enable = 0; wide[65:62] = 4'bzx10; far = 0;
    #0.3 enable = 1'bx; level = 1; sum = sum - 29; wide = {130{1'bx}};
    #0.001 level = 0; wide = {1'b1, 129'bz};
    #0.001 level = 1; wide = 0; data = 4'b1x0z; enable = 1;
    #100 level = 1'bx;
    #1 $finish(0);
  end
endmodule
