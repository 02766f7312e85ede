`default_nettype none

// What holds of centroid_estimator in every cycle, for every pattern of starts and resets, once it
// has been reset in the first. `HOLDS names the property to prove. Its registers make the induction
// go through without unrolling an estimation. A design with the default number of bins need not have a
// parameter for it.
`ifdef BINS
`define PARAMETERS #(.BinBits($clog2(`BINS)))
`else
`define BINS 256
`define PARAMETERS
`endif
module check_centroid #(
    parameter Latency = `BINS + 56  // cycle of algo_done, counted from the edge that takes a start
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,
    input wire [15:0] count
);
    wire algo_done;
    (* hierconn *) wire \dut.busy ;
    (* hierconn *) wire [$clog2(`BINS + 56)-1:0] \dut.step ;

    centroid_estimator `PARAMETERS dut (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .count(count),
        .algo_done(algo_done)
    );

    // Counts by itself: a start is taken unless one is under way, and is under way until algo_done.
    reg first = 1'b1;      // the first cycle
    reg under_way = 1'b0;  // cycles e0 .. e(Latency - 1)
    reg done = 1'b0;       // cycle eLatency
    reg [10:0] k = 11'd0;  // in cycle ek

    always @(posedge clk_sys) begin
        first <= 1'b0;
        under_way <= !rst && (under_way ? k + 1 < Latency : algo_start);
        done <= !rst && under_way && k + 1 == Latency;
        k <= !rst && under_way ? k + 11'd1 : 11'd0;
    end

    wire centroid_latency = algo_done == done;

    wire in_step = \dut.busy == under_way
        && \dut.step == (under_way ? k : 11'd0)
        && k <= Latency && (under_way || done || k == 11'd0) && done == (k == Latency);

    always @* begin
        if (first) assume (rst);
        else assert (in_step && `HOLDS);
    end
endmodule
