`timescale 1ns / 10ps
`default_nettype none

// Values that are no vectors: real numbers, integers, times, events, text in registers, and memories.
module values;
  real ratio;
  realtime at;
  integer count;
  time stamp;
  event tick;
  reg [8 * 5:1] text;
  reg [7:0] memory [2:4];
  reg signed [3:0] grid [0:1];
  integer ticks = 0;
  always @tick ticks = ticks + 1;

  initial begin
    $dumpfile(`FILE);
    $dumpvars;
    $dumpvars(0, memory[2], memory[3], memory[4], grid[0], grid[1]);
    $timeformat(-12, 0, "", 0);
    $display({"time_ps;real values.ratio;real values.at;bits[31:0] values.count;bits[63:0] values.stamp;",
      "event values.tick;",
      "bits[40:1] values.text;bits[7:0] values.\\memory[2];bits[7:0] values.\\memory[3];bits[7:0] values.\\memory[4];",
      "bits[3:0] values.\\grid[0];bits[3:0] values.\\grid[1];bits[31:0] values.ticks"});
    $monitor("%0t;%.17g;%.17g;%b;%b;%0d;%b;%b;%b;%b;%b;%b;%b", $realtime, ratio,
      at, count, stamp, ticks, text, memory[2], memory[3], memory[4], grid[0], grid[1], ticks);
    #1 ratio = 0.1; at = $realtime; count = -1; stamp = $time; text = "hello"; memory[3] = 8'h5x; -> tick;
    #1.25 ratio = -1.0 / 3.0; at = $realtime; count = 32'h8000_0000; text = "a b"; memory[4] = 8'hzf; grid[1] = -2;
    #1 -> tick; ratio = 1.0e300; stamp = 64'hffff_ffff_ffff_fffe; text = "x\0y\n\\";
    #1 ratio = 0.1 + 0.2; count = 32'h7fff_ffff; memory[2] = 0; grid[0] = 7;
    #0.5 -> tick; -> tick; ratio = -2.2250738585072014e-308;
    #0.01 ratio = 1.0 / 0.0; count = 32'bx;
    #0.01 ratio = -1.0 / 0.0; count = 0;
    #1 $finish(0);
  end
endmodule
