`default_nettype none

// A circuit for Yosys: registers, an inner module and a memory, all set at reset.
module yosys_stage (input wire clk, input wire rst, input wire [3:0] a, output reg [8:2] y);
  always @(posedge clk)
    if (rst) y <= 3;
    else y <= y + a;
endmodule

module yosys_states (input wire clk, input wire rst, output reg [3:0] count, output wire [8:2] sum);
  reg [1:0] state;
  reg [0:70] wide;
  wire odd = ^count;
  yosys_stage stage (.clk(clk), .rst(rst), .a(count), .y(sum));
  always @(posedge clk)
    if (rst) begin
      count <= 9;
      state <= 1;
      wide <= 5;
    end else begin
      count <= count + 3;
      state <= {state[0], odd};
      wide <= {wide[9:70], sum, state};
    end
endmodule

`ifdef BENCH
// Prints what Icarus makes of the circuit with the clock and the reset of Yosys's `sim`.
module bench;
  reg clk = 1'bx;
  reg rst = 1;
  wire [3:0] count;
  wire [8:2] sum;
  yosys_states yosys_states (clk, rst, count, sum);
  integer k;
  initial begin
    yosys_states.count = 0;
    yosys_states.state = 0;
    yosys_states.wide = 0;
    yosys_states.stage.y = 0;
    $write("time_ps;bits yosys_states.clk;bits yosys_states.rst;bits[3:0] yosys_states.count;");
    $write("bits[8:2] yosys_states.sum;");
    $write("bits[1:0] yosys_states.state;bits[0:70] yosys_states.wide;bits yosys_states.odd;");
    $write("bits yosys_states.stage.clk;bits yosys_states.stage.rst;bits[3:0] yosys_states.stage.a;");
    $display("bits[8:2] yosys_states.stage.y");
    for (k = 0; k <= 100; k = k + 5) begin
      #1 $display("%0d;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b;%b", 1000 * k, clk, rst, count, sum, yosys_states.state,
        yosys_states.wide, yosys_states.odd, yosys_states.stage.clk, yosys_states.stage.rst, yosys_states.stage.a,
        yosys_states.stage.y);
      clk = k % 10 == 5;
      if (k == 15) rst <= 0;
    end
  end
endmodule
`endif
