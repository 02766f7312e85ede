`timescale 1ps / 1fs
`default_nettype none

// Prints the likelihood estimator's latency: for a start while it is idle, for a start that is held, which is
// taken again with algo_done, and for histograms that are empty, full, and in between.
module bench_likelihood;
    reg clk_sys = 1'b0, rst = 1'b1, algo_start = 1'b0;
    reg [15:0] count = 16'd0;
    wire algo_done;

`ifdef LIKELIHOOD
    likelihood_estimator #(`LIKELIHOOD) likelihood_estimator (
`else
    likelihood_estimator likelihood_estimator (
`endif
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .mode(1'b0),
        .count(count),
        .algo_done(algo_done)
    );

    integer k;

    task edge_with(input start);
        begin
            algo_start = start;
            #4000 clk_sys = 1'b1;
            #4000 clk_sys = 1'b0;
        end
    endtask

    // From the edge that takes a start to algo_done, or for longer than any estimation takes.
    task estimation(input hold);
        begin
            k = -1;
            while (k < 2000 + 32 * `LIKELIHOOD_BINS && (k < 0 || algo_done !== 1'b1)) begin
                edge_with(k < 0 || hold);
                k = k + 1;
            end
            if (algo_done === 1'b1) $display("count likelihood_latency %0d", k);
        end
    endtask

    initial begin
        repeat (3) edge_with(1'b0);
        rst = 1'b0;
        repeat (3) edge_with(1'b0);
        estimation(1'b0);
        repeat (3) edge_with(1'b0);
        count = 16'd65535;
        estimation(1'b1);
        count = 16'd40;
        estimation(1'b1);
        $finish;
    end
endmodule
