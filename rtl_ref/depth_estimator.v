`timescale 1ps / 1fs
`default_nettype none

// The neural depth estimator: wires its four blocks.
//
// Its ports are a socket: any module with them, of any latency, can take its place. Its own latency is
// as many cycles as there are bins and neurons, and three, from eight neurons on.
module depth_estimator #(
    parameter integer BinBits = 8,     // see estimator_ctrl
    parameter integer CountBits = 16,  // of a word of the histogram, 8 to 24
    parameter integer SumBits = 36,    // see forward1
    parameter integer W1Bits = 16,
    parameter integer W1Fraction = 23,
    parameter integer B1Bits = 16,
    parameter integer B1Fraction = 13,
    parameter integer AddressBits = 12,         // see tansig
    parameter integer RangeLog2 = 2,
    parameter integer ActivationBits = 16,      // see forward2
    parameter integer ActivationFraction = 15,
    parameter integer W2Bits = 16,
    parameter integer W2Fraction = 14,
    parameter integer B2Bits = 16,
    parameter integer B2Fraction = 17,
    parameter integer Neurons = 8,    // hidden neurons, 1 to 32
    parameter W1File = "rtl_ref/w1.mem",         // see forward1
    parameter B1File = "rtl_ref/b1.mem",
    parameter W2File = "rtl_ref/w2.mem",         // see forward2
    parameter B2File = "rtl_ref/b2.mem",
    parameter TansigFile = "rtl_ref/tansig.mem"  // see tansig
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,                // starts an estimation
    // Histogram
    output wire read_en,                  // the histogram's word at read_addr is being read
    output wire [BinBits-1:0] read_addr,  // word of the histogram
    input wire [CountBits-1:0] count,     // word of the histogram at read_addr [hits]
    // Result
    output wire signed [35:0] depth,      // from algo_done until the next one [2^-29 m]
    output wire algo_done                 // the depth is ready; one cycle
);
    wire [BinBits-1:0] rom_addr;
    wire forward1_first;
    wire forward1_en;
    wire tansig_en;
    wire [(Neurons > 16 ? 3 : 2):0] pair;
    wire forward2_first;
    wire forward2_en;
    wire depth_en;
    wire signed [SumBits-1:0] l1_in_0, l1_in_1, l1_in_2, l1_in_3, l1_in_4, l1_in_5, l1_in_6, l1_in_7, l1_in_8;
    wire signed [SumBits-1:0] l1_in_9, l1_in_10, l1_in_11, l1_in_12, l1_in_13, l1_in_14, l1_in_15, l1_in_16;
    wire signed [SumBits-1:0] l1_in_17, l1_in_18, l1_in_19, l1_in_20, l1_in_21, l1_in_22, l1_in_23, l1_in_24;
    wire signed [SumBits-1:0] l1_in_25, l1_in_26, l1_in_27, l1_in_28, l1_in_29, l1_in_30, l1_in_31;
    wire signed [ActivationBits-1:0] l1_out_0, l1_out_1, l1_out_2, l1_out_3, l1_out_4, l1_out_5, l1_out_6;
    wire signed [ActivationBits-1:0] l1_out_7, l1_out_8, l1_out_9, l1_out_10, l1_out_11, l1_out_12, l1_out_13;
    wire signed [ActivationBits-1:0] l1_out_14, l1_out_15, l1_out_16, l1_out_17, l1_out_18, l1_out_19;
    wire signed [ActivationBits-1:0] l1_out_20, l1_out_21, l1_out_22, l1_out_23, l1_out_24, l1_out_25;
    wire signed [ActivationBits-1:0] l1_out_26, l1_out_27, l1_out_28, l1_out_29, l1_out_30, l1_out_31;

    estimator_ctrl #(
        .BinBits(BinBits),
        .Neurons(Neurons)
    ) estimator_ctrl (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .algo_done(algo_done),
        .read_en(read_en),
        .read_addr(read_addr),
        .rom_addr(rom_addr),
        .forward1_first(forward1_first),
        .forward1_en(forward1_en),
        .tansig_en(tansig_en),
        .pair(pair),
        .forward2_first(forward2_first),
        .forward2_en(forward2_en),
        .depth_en(depth_en)
    );

    forward1 #(
        .BinBits(BinBits),
        .CountBits(CountBits),
        .SumBits(SumBits),
        .W1Bits(W1Bits),
        .W1Fraction(W1Fraction),
        .B1Bits(B1Bits),
        .B1Fraction(B1Fraction),
        .Neurons(Neurons),
        .W1File(W1File),
        .B1File(B1File)
    ) forward1 (
        .clk_sys(clk_sys),
        .rst(rst),
        .forward1_first(forward1_first),
        .forward1_en(forward1_en),
        .rom_addr(rom_addr),
        .count(count),
        .l1_in_0(l1_in_0),
        .l1_in_1(l1_in_1),
        .l1_in_2(l1_in_2),
        .l1_in_3(l1_in_3),
        .l1_in_4(l1_in_4),
        .l1_in_5(l1_in_5),
        .l1_in_6(l1_in_6),
        .l1_in_7(l1_in_7),
        .l1_in_8(l1_in_8),
        .l1_in_9(l1_in_9),
        .l1_in_10(l1_in_10),
        .l1_in_11(l1_in_11),
        .l1_in_12(l1_in_12),
        .l1_in_13(l1_in_13),
        .l1_in_14(l1_in_14),
        .l1_in_15(l1_in_15),
        .l1_in_16(l1_in_16),
        .l1_in_17(l1_in_17),
        .l1_in_18(l1_in_18),
        .l1_in_19(l1_in_19),
        .l1_in_20(l1_in_20),
        .l1_in_21(l1_in_21),
        .l1_in_22(l1_in_22),
        .l1_in_23(l1_in_23),
        .l1_in_24(l1_in_24),
        .l1_in_25(l1_in_25),
        .l1_in_26(l1_in_26),
        .l1_in_27(l1_in_27),
        .l1_in_28(l1_in_28),
        .l1_in_29(l1_in_29),
        .l1_in_30(l1_in_30),
        .l1_in_31(l1_in_31)
    );

    tansig #(
        .SumBits(SumBits),
        .W1Fraction(W1Fraction),
        .AddressBits(AddressBits),
        .RangeLog2(RangeLog2),
        .ActivationBits(ActivationBits),
        .Neurons(Neurons),
        .TansigFile(TansigFile)
    ) tansig (
        .clk_sys(clk_sys),
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
        .l1_in_8(l1_in_8),
        .l1_in_9(l1_in_9),
        .l1_in_10(l1_in_10),
        .l1_in_11(l1_in_11),
        .l1_in_12(l1_in_12),
        .l1_in_13(l1_in_13),
        .l1_in_14(l1_in_14),
        .l1_in_15(l1_in_15),
        .l1_in_16(l1_in_16),
        .l1_in_17(l1_in_17),
        .l1_in_18(l1_in_18),
        .l1_in_19(l1_in_19),
        .l1_in_20(l1_in_20),
        .l1_in_21(l1_in_21),
        .l1_in_22(l1_in_22),
        .l1_in_23(l1_in_23),
        .l1_in_24(l1_in_24),
        .l1_in_25(l1_in_25),
        .l1_in_26(l1_in_26),
        .l1_in_27(l1_in_27),
        .l1_in_28(l1_in_28),
        .l1_in_29(l1_in_29),
        .l1_in_30(l1_in_30),
        .l1_in_31(l1_in_31),
        .l1_out_0(l1_out_0),
        .l1_out_1(l1_out_1),
        .l1_out_2(l1_out_2),
        .l1_out_3(l1_out_3),
        .l1_out_4(l1_out_4),
        .l1_out_5(l1_out_5),
        .l1_out_6(l1_out_6),
        .l1_out_7(l1_out_7),
        .l1_out_8(l1_out_8),
        .l1_out_9(l1_out_9),
        .l1_out_10(l1_out_10),
        .l1_out_11(l1_out_11),
        .l1_out_12(l1_out_12),
        .l1_out_13(l1_out_13),
        .l1_out_14(l1_out_14),
        .l1_out_15(l1_out_15),
        .l1_out_16(l1_out_16),
        .l1_out_17(l1_out_17),
        .l1_out_18(l1_out_18),
        .l1_out_19(l1_out_19),
        .l1_out_20(l1_out_20),
        .l1_out_21(l1_out_21),
        .l1_out_22(l1_out_22),
        .l1_out_23(l1_out_23),
        .l1_out_24(l1_out_24),
        .l1_out_25(l1_out_25),
        .l1_out_26(l1_out_26),
        .l1_out_27(l1_out_27),
        .l1_out_28(l1_out_28),
        .l1_out_29(l1_out_29),
        .l1_out_30(l1_out_30),
        .l1_out_31(l1_out_31)
    );

    forward2 #(
        .ActivationBits(ActivationBits),
        .ActivationFraction(ActivationFraction),
        .W2Bits(W2Bits),
        .W2Fraction(W2Fraction),
        .B2Bits(B2Bits),
        .B2Fraction(B2Fraction),
        .Neurons(Neurons),
        .W2File(W2File),
        .B2File(B2File)
    ) forward2 (
        .clk_sys(clk_sys),
        .rst(rst),
        .pair(pair),
        .forward2_first(forward2_first),
        .forward2_en(forward2_en),
        .depth_en(depth_en),
        .l1_out_0(l1_out_0),
        .l1_out_1(l1_out_1),
        .l1_out_2(l1_out_2),
        .l1_out_3(l1_out_3),
        .l1_out_4(l1_out_4),
        .l1_out_5(l1_out_5),
        .l1_out_6(l1_out_6),
        .l1_out_7(l1_out_7),
        .l1_out_8(l1_out_8),
        .l1_out_9(l1_out_9),
        .l1_out_10(l1_out_10),
        .l1_out_11(l1_out_11),
        .l1_out_12(l1_out_12),
        .l1_out_13(l1_out_13),
        .l1_out_14(l1_out_14),
        .l1_out_15(l1_out_15),
        .l1_out_16(l1_out_16),
        .l1_out_17(l1_out_17),
        .l1_out_18(l1_out_18),
        .l1_out_19(l1_out_19),
        .l1_out_20(l1_out_20),
        .l1_out_21(l1_out_21),
        .l1_out_22(l1_out_22),
        .l1_out_23(l1_out_23),
        .l1_out_24(l1_out_24),
        .l1_out_25(l1_out_25),
        .l1_out_26(l1_out_26),
        .l1_out_27(l1_out_27),
        .l1_out_28(l1_out_28),
        .l1_out_29(l1_out_29),
        .l1_out_30(l1_out_30),
        .l1_out_31(l1_out_31),
        .depth(depth)
    );
endmodule
