`default_nettype none

// What holds of an estimator in every cycle, for every pattern of starts and resets, once it has been reset in the
// first. `HOLDS names the property to prove.
//
// Cycle ek is the k-th after the edge e0 that takes a start. Registers of the estimator are joined to the wires of
// their names when Yosys flattens (hierconn); they make the induction go through without unrolling an estimation.
module `MODULE (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,
    input wire mode,
    input wire [15:0] count
);
    parameter Latency = `LATENCY;  // cycle of algo_done
    wire algo_done;

    // Counts by itself: a start is taken unless one is under way, and is under way until algo_done.
    reg first = 1'b1;      // the first cycle
    reg under_way = 1'b0;  // cycles e0 .. e(Latency - 1)
    reg done = 1'b0;       // cycle eLatency
    reg [15:0] k = 16'd0;  // in cycle ek

    always @(posedge clk_sys) begin
        first <= 1'b0;
        under_way <= !rst && (under_way ? k + 1 < Latency : algo_start);
        done <= !rst && under_way && k + 1 == Latency;
        k <= !rst && under_way ? k + 16'd1 : 16'd0;
    end

