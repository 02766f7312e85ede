`timescale 1ps / 1fs
`default_nettype none

// Prints cycle counts of an estimator: for a start while it is idle, for a start that is held, which is taken again
// with algo_done, and for histograms that are empty, full, and in between.
module `MODULE;
    reg clk_sys = 1'b0, rst = 1'b1, algo_start = 1'b0, mode = 1'b0;
    reg [15:0] count = 16'd0;
    wire algo_done;
    integer k;  // cycle, counted from the edge that takes a start

