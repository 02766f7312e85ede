`timescale 1ps / 1fs
`default_nettype none

// Prints the estimator's cycle counts: for a start while it is idle, and for a start that is held,
// which is taken again with algo_done.
module bench_estimator;
    reg clk_sys = 1'b0, rst = 1'b1, algo_start = 1'b0;
    wire algo_done, ctrl_done, forward1_en, tansig_en, forward2_en;

`ifdef NEURONS
    defparam depth_estimator.Neurons = `NEURONS;
    defparam estimator_ctrl.Neurons = `NEURONS;
`endif
`ifdef BINS
    defparam depth_estimator.BinBits = $clog2(`BINS);
    defparam estimator_ctrl.BinBits = $clog2(`BINS);
`endif

    depth_estimator depth_estimator (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .count(16'd0),
        .algo_done(algo_done)
    );

    estimator_ctrl estimator_ctrl (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .algo_done(ctrl_done),
        .forward1_en(forward1_en),
        .tansig_en(tansig_en),
        .forward2_en(forward2_en)
    );

    // Each cycle is looked at in its middle, where the inputs of the next edge are set.
    integer k, forward1, tansig, forward2;

    task edge_with(input start);
        begin
            algo_start = start;
            #4000 clk_sys = 1'b1;
            #4000 clk_sys = 1'b0;
        end
    endtask

    // From the edge that takes a start to algo_done, or for 2000 cycles.
    task estimation(input hold);
        begin
            k = -1;
            {forward1, tansig, forward2} = 96'd0;
            while (k < 2000 && (k < 0 || algo_done !== 1'b1)) begin
                edge_with(k < 0 || hold);
                k = k + 1;
                if (forward1_en === 1'b1) forward1 = forward1 + 1;
                if (tansig_en === 1'b1) tansig = tansig + 1;
                if (forward2_en === 1'b1) forward2 = forward2 + 1;
            end
            if (algo_done === 1'b1) $display("count latency %0d", k);
            $display("count forward1_cycles %0d", forward1);
            $display("count tansig_cycles %0d", tansig);
            $display("count forward2_cycles %0d", forward2);
        end
    endtask

    initial begin
        repeat (3) edge_with(1'b0);
        rst = 1'b0;
        repeat (3) edge_with(1'b0);
        estimation(1'b0);
        repeat (3) edge_with(1'b0);
        estimation(1'b1);
        estimation(1'b1);
        $finish;
    end
endmodule
