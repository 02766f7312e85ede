`timescale 1ps / 1ps
`default_nettype none

// With eight neurons, as the blocks beside it are.
module depth_estimator #(
    // verilator lint_off UNUSEDPARAM
    parameter [4:0] Neurons = 5'd8,
    // verilator lint_on UNUSEDPARAM
    parameter W1File = "rtl_ref/w1.mem",         // see forward1
    parameter B1File = "rtl_ref/b1.mem",
    parameter W2File = "rtl_ref/w2.mem",         // see forward2
    parameter B2File = "rtl_ref/b2.mem",
    parameter TansigFile = "rtl_ref/tansig.mem"  // see tansig
) (
    input wire clk_125,
    input wire rst,
    input wire algo_start,            // starts an estimation
    // Histogram
    output wire read_en,              // the histogram's word at read_addr is being read
    output wire [7:0] read_addr,      // word of the histogram
    input wire [15:0] count,          // word of the histogram at read_addr [hits]
    // Result
    output wire signed [35:0] depth,  // when algo_done is high; before, a partial sum [2^-29 m]
    output wire algo_done             // the depth is ready; one cycle
);
    wire [8:0] rom_addr;
    wire forward1_en;
    wire tansig_en;
    wire forward2_en;
    wire [3:0] neuron;
    wire signed [35:0] l1_in_0, l1_in_1, l1_in_2, l1_in_3, l1_in_4, l1_in_5, l1_in_6, l1_in_7;
    wire signed [15:0] l1_out_0, l1_out_1, l1_out_2, l1_out_3;
    wire signed [15:0] l1_out_4, l1_out_5, l1_out_6, l1_out_7;

    estimator_ctrl estimator_ctrl (
        .clk_125(clk_125),
        .rst(rst),
        .algo_start(algo_start),
        .algo_done(algo_done),
        .read_en(read_en),
        .read_addr(read_addr),
        .rom_addr(rom_addr),
        .forward1_en(forward1_en),
        .tansig_en(tansig_en),
        .forward2_en(forward2_en),
        .neuron(neuron)
    );

    forward1 #(
        .W1File(W1File),
        .B1File(B1File)
    ) forward1 (
        .clk_125(clk_125),
        .rst(rst),
        .forward1_en(forward1_en),
        .read_en(read_en),
        .read_addr(read_addr),
        .rom_addr(rom_addr),
        .count(count),
        .l1_in_0(l1_in_0),
        .l1_in_1(l1_in_1),
        .l1_in_2(l1_in_2),
        .l1_in_3(l1_in_3),
        .l1_in_4(l1_in_4),
        .l1_in_5(l1_in_5),
        .l1_in_6(l1_in_6),
        .l1_in_7(l1_in_7)
    );

    tansig #(
        .TansigFile(TansigFile)
    ) tansig (
        .clk_125(clk_125),
        .rst(rst),
        .tansig_en(tansig_en),
        .l1_in_0(l1_in_0),
        .l1_in_1(l1_in_1),
        .l1_in_2(l1_in_2),
        .l1_in_3(l1_in_3),
        .l1_in_4(l1_in_4),
        .l1_in_5(l1_in_5),
        .l1_in_6(l1_in_6),
        .l1_in_7(l1_in_7),
        .l1_out_0(l1_out_0),
        .l1_out_1(l1_out_1),
        .l1_out_2(l1_out_2),
        .l1_out_3(l1_out_3),
        .l1_out_4(l1_out_4),
        .l1_out_5(l1_out_5),
        .l1_out_6(l1_out_6),
        .l1_out_7(l1_out_7)
    );

    forward2 #(
        .W2File(W2File),
        .B2File(B2File)
    ) forward2 (
        .clk_125(clk_125),
        .rst(rst),
        .forward2_en(forward2_en),
        .neuron(neuron),
        .l1_out_0(l1_out_0),
        .l1_out_1(l1_out_1),
        .l1_out_2(l1_out_2),
        .l1_out_3(l1_out_3),
        .l1_out_4(l1_out_4),
        .l1_out_5(l1_out_5),
        .l1_out_6(l1_out_6),
        .l1_out_7(l1_out_7),
        .depth(depth)
    );
endmodule
