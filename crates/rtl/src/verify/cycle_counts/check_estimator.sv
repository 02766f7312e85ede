`default_nettype none

// What holds of depth_estimator in every cycle, for every pattern of starts and resets, once it
// has been reset in the first. `HOLDS names the property to prove.
//
// Cycle ek is the k-th after the edge e0 that takes a start. The registers of estimator_ctrl are
// joined to the wires of their names when Yosys flattens (hierconn); they make the induction go
// through without unrolling an estimation.
//
// A design with the default numbers of neurons and bins need not have parameters for them.
`ifdef NEURONS
`ifdef BINS
`define PARAMETERS #(.Neurons(`NEURONS), .BinBits($clog2(`BINS)))
`else
`define PARAMETERS #(.Neurons(`NEURONS))
`endif
`else
`define NEURONS 8
`ifdef BINS
`define PARAMETERS #(.BinBits($clog2(`BINS)))
`else
`define PARAMETERS
`endif
`endif
`ifndef BINS
`define BINS 256
`endif

module check_estimator #(
    // Cycle of algo_done
    parameter Latency = `BINS + (`NEURONS < 8 ? 7 + (`NEURONS + 1) / 2 : 3 + `NEURONS),
    parameter Forward1 = `BINS,              // cycles of forward1_en, from e2 on
    parameter Tansig = 1,                    // cycles of tansig_en, from e(BINS + 2) on
    parameter Forward2 = (`NEURONS + 1) / 2  // cycles of forward2_en, from e(BINS + 6) on
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,
    input wire [15:0] count
);
    wire algo_done;
    (* hierconn *) wire \dut.estimator_ctrl.busy ;
    (* hierconn *) wire [$clog2(`BINS + (`NEURONS < 8 ? 7 + (`NEURONS + 1) / 2 : 3 + `NEURONS))-1:0] \dut.estimator_ctrl.step ;
    (* hierconn *) wire \dut.estimator_ctrl.forward1_en ;
    (* hierconn *) wire \dut.estimator_ctrl.tansig_en ;
    (* hierconn *) wire \dut.estimator_ctrl.forward2_en ;

    depth_estimator `PARAMETERS dut (
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

    wire shown = under_way || done;
    wire latency = algo_done == done;
    wire forward1_cycles =
        \dut.estimator_ctrl.forward1_en == (shown && k >= 2 && k < 2 + Forward1);
    wire tansig_cycles =
        \dut.estimator_ctrl.tansig_en == (shown && k >= `BINS + 2 && k < `BINS + 2 + Tansig);
    wire forward2_cycles =
        \dut.estimator_ctrl.forward2_en == (shown && k >= `BINS + 6 && k < `BINS + 6 + Forward2);

    wire in_step = \dut.estimator_ctrl.busy == under_way
        && \dut.estimator_ctrl.step == (under_way ? k : 11'd0)
        && k <= Latency && (shown || k == 11'd0) && done == (k == Latency);

    always @* begin
        if (first) assume (rst);
        else assert (in_step && `HOLDS);
    end
endmodule
