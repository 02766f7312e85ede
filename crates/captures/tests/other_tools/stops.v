`timescale 10ps / 10ps
`default_nettype none

module stops_inner (input wire clk);
  reg [3:0] count = 0;
  reg seen;
  always @(posedge clk) begin
    count <= count + 1;
    seen <= clk;
  end
endmodule

// A dump that begins late, stops, goes on and states all values again, of one scope only.
module stops;
  reg clk = 0;
  reg is_dumped = 0;
  stops_inner inner (clk);
  wire clk_seen = is_dumped ? clk : 1'bx;
  wire [3:0] count_seen = is_dumped ? inner.count : 4'bx;
  wire seen_seen = is_dumped ? inner.seen : 1'bx;
  always #5 clk = ~clk;

  initial begin
    $timeformat(-12, 0, "", 0);
    $display("time_ps;bits stops.inner.clk;bits[3:0] stops.inner.count;bits stops.inner.seen");
    #13 $dumpfile(`FILE);
    $dumpvars(1, inner);
    $monitor("%0t;%b;%b;%b", $realtime, clk_seen, count_seen, seen_seen);
    is_dumped = 1;
    #20 $dumpoff; is_dumped = 0;
    #27 $dumpon; is_dumped = 1;
    #11 $dumpall; $dumpflush;
    #10 $dumpoff; is_dumped = 0;
    #7 $finish(0);
  end
endmodule
