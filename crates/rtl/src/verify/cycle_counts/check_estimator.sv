`default_nettype none

// What holds of depth_estimator in every cycle, for every pattern of starts and resets, once it
// has been reset in the first. `HOLDS names the property to prove.
//
// Cycle ek is the k-th after the edge e0 that takes a start. The registers of estimator_ctrl are
// joined to the wires of their names when Yosys flattens (hierconn); they make the induction go
// through without unrolling an estimation.
//
// A design with the default number of neurons need not have a parameter for it.
`ifdef NEURONS
`define PARAMETERS #(.Neurons(`NEURONS))
`else
`define NEURONS 8
`define PARAMETERS
`endif

module check_estimator #(
    // Cycle of algo_done
    parameter Latency = `NEURONS < 8 ? 263 + (`NEURONS + 1) / 2 : 259 + `NEURONS,
    parameter Forward1 = 256,                // cycles of forward1_en, from e2 on
    parameter Tansig = 1,                    // cycles of tansig_en, from e258 on
    parameter Forward2 = (`NEURONS + 1) / 2  // cycles of forward2_en, from e262 on
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,
    input wire [15:0] count
);
    wire algo_done;
    (* hierconn *) wire \dut.estimator_ctrl.busy ;
    (* hierconn *) wire [8:0] \dut.estimator_ctrl.step ;
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
    reg [8:0] k = 9'd0;    // in cycle ek

    always @(posedge clk_sys) begin
        first <= 1'b0;
        under_way <= !rst && (under_way ? k + 1 < Latency : algo_start);
        done <= !rst && under_way && k + 1 == Latency;
        k <= !rst && under_way ? k + 9'd1 : 9'd0;
    end

    wire shown = under_way || done;
    wire latency = algo_done == done;
    wire forward1_cycles =
        \dut.estimator_ctrl.forward1_en == (shown && k >= 2 && k < 2 + Forward1);
    wire tansig_cycles =
        \dut.estimator_ctrl.tansig_en == (shown && k >= 258 && k < 258 + Tansig);
    wire forward2_cycles =
        \dut.estimator_ctrl.forward2_en == (shown && k >= 262 && k < 262 + Forward2);

    wire in_step = \dut.estimator_ctrl.busy == under_way
        && \dut.estimator_ctrl.step == (under_way ? k : 9'd0)
        && k <= Latency && (shown || k == 9'd0) && done == (k == Latency);

    always @* begin
        if (first) assume (rst);
        else assert (in_step && `HOLDS);
    end
endmodule
