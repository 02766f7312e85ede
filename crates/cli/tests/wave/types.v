`timescale 1ns/10ps
module inner(input wire [0:7] up, input wire \a.b , output reg [3:0] q);
  always @(up or \a.b ) #1 q = up[4:7] ^ {4{\a.b }};
endmodule

module types;
  reg clk = 0;
  reg [7:0] n = 8'bx;
  reg [0:7] up = 8'h81;
  reg signed [64:0] wide = -65'sd1;
  reg [299:0] huge = {300{1'bz}};
  integer i = -5;
  real r = 0.1;
  time t = 12;
  event e;
  tri1 pulled = clk ? 1'b0 : 1'bz;
  wire [3:0] q;
  wire \odd.name = n[0];
  inner \in[0] (.up(up), .\a.b (clk), .q(q));
  generate genvar g; for (g = 0; g < 2; g = g + 1) begin : lane
    reg [1:0] v = g;
    always @(posedge clk) v <= v + 1;
  end endgenerate
  always #2.5 clk = ~clk;
  initial begin
    if ($test$plusargs("fst")) $dumpfile("icarus.fst"); else $dumpfile("icarus.vcd");
    $dumpvars(0, types);
    #7 n = 8'h3x; up = 8'b1z0x; -> e;
    #1 wide = 65'h1_2345_6789_abcd_ef01; huge = 300'h5; r = -1.0e30; i = 7;
    #3 n = 8'b0; wide = 65'bz; r = 1.0/3.0; t = $time; -> e;
    #9 $finish;
  end
endmodule
