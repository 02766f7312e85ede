`timescale 1ps / 1fs
`default_nettype none

// The output layer: two multiply-accumulate units, one for the even and one for the odd neurons, so
// two neurons an edge.
//
//   activation_k (A), w2_k (B)  ->  term_k (M)  ->  sum_k (P)  ->  depth = sum_0 + sum_1
module forward2 #(
    parameter integer ActivationBits = 16,      // of an activation, and how many are fraction
    parameter integer ActivationFraction = 15,
    parameter integer W2Bits = 16,              // of a weight, and how many are fraction
    parameter integer W2Fraction = 14,
    parameter integer B2Bits = 16,              // of the bias, and how many are fraction
    parameter integer B2Fraction = 17,
    parameter integer Neurons = 8,             // hidden neurons, 1 to 32
    parameter W2File = "rtl_ref/w2.mem",        // one row, a weight for each neuron [2^-W2Fraction]
    parameter B2File = "rtl_ref/b2.mem"         // the bias [2^-B2Fraction]
) (
    input wire clk_sys,
    input wire rst,
    // estimator_ctrl
    input wire [(Neurons > 16 ? 3 : 2):0] pair,  // neurons 2 pair and 2 pair + 1 become operands
    input wire forward2_first,  // the sums begin, one of them with the bias
    input wire forward2_en,     // accumulates
    input wire depth_en,        // the sums become the depth
    // Activations of the hidden layer; not looked at past the last neuron [2^-ActivationFraction]
    input wire signed [ActivationBits-1:0] l1_out_0,
    input wire signed [ActivationBits-1:0] l1_out_1,
    input wire signed [ActivationBits-1:0] l1_out_2,
    input wire signed [ActivationBits-1:0] l1_out_3,
    input wire signed [ActivationBits-1:0] l1_out_4,
    input wire signed [ActivationBits-1:0] l1_out_5,
    input wire signed [ActivationBits-1:0] l1_out_6,
    input wire signed [ActivationBits-1:0] l1_out_7,
    input wire signed [ActivationBits-1:0] l1_out_8,
    input wire signed [ActivationBits-1:0] l1_out_9,
    input wire signed [ActivationBits-1:0] l1_out_10,
    input wire signed [ActivationBits-1:0] l1_out_11,
    input wire signed [ActivationBits-1:0] l1_out_12,
    input wire signed [ActivationBits-1:0] l1_out_13,
    input wire signed [ActivationBits-1:0] l1_out_14,
    input wire signed [ActivationBits-1:0] l1_out_15,
    input wire signed [ActivationBits-1:0] l1_out_16,
    input wire signed [ActivationBits-1:0] l1_out_17,
    input wire signed [ActivationBits-1:0] l1_out_18,
    input wire signed [ActivationBits-1:0] l1_out_19,
    input wire signed [ActivationBits-1:0] l1_out_20,
    input wire signed [ActivationBits-1:0] l1_out_21,
    input wire signed [ActivationBits-1:0] l1_out_22,
    input wire signed [ActivationBits-1:0] l1_out_23,
    input wire signed [ActivationBits-1:0] l1_out_24,
    input wire signed [ActivationBits-1:0] l1_out_25,
    input wire signed [ActivationBits-1:0] l1_out_26,
    input wire signed [ActivationBits-1:0] l1_out_27,
    input wire signed [ActivationBits-1:0] l1_out_28,
    input wire signed [ActivationBits-1:0] l1_out_29,
    input wire signed [ActivationBits-1:0] l1_out_30,
    input wire signed [ActivationBits-1:0] l1_out_31,
    // From algo_done until the next one [2^-29 m]
    output reg signed [35:0] depth
);
    // Fraction bits of a product, by how many the bias is shifted up, and the depth is: up or down.
    localparam integer TermFraction = ActivationFraction + W2Fraction, BiasShift = TermFraction - B2Fraction;
    localparam integer Up = TermFraction < 29 ? 29 - TermFraction : 0, Down = TermFraction > 29 ? TermFraction - 29 : 0;
    // Of a product, and of a sum: what the depth keeps of it, or a product and its sign.
    localparam integer TermBits = ActivationBits + W2Bits;
    localparam integer SumBits = 36 + Down > TermBits + 1 ? 36 + Down : TermBits + 1;
    // Pairs that pair can name.
    localparam integer Places = Neurons > 16 ? 16 : 8;

    reg signed [ActivationBits-1:0] activation_0, activation_1;
    reg signed [W2Bits-1:0] w2_0, w2_1;
    reg signed [TermBits-1:0] term_0, term_1;
    reg signed [SumBits-1:0] sum_0, sum_1;

    reg signed [SumBits-1:0] sum_0_next, sum_1_next;
    reg signed [35:0] depth_next;

    reg [W2Bits*Neurons-1:0] w2_rom [0:0];
    reg [B2Bits-1:0] b2_rom [0:0];
    initial begin
        $readmemh(W2File, w2_rom);
        $readmemh(B2File, b2_rom);
    end

    wire [B2Bits-1:0] b2 = b2_rom[0];
    wire signed [SumBits-1:0] bias = {{SumBits - B2Bits{b2[B2Bits-1]}}, b2} <<< BiasShift;

    // The ports side by side.
    /* verilator lint_off UNUSED */
    wire [ActivationBits*32-1:0] ports = {l1_out_31, l1_out_30, l1_out_29, l1_out_28, l1_out_27, l1_out_26,
        l1_out_25, l1_out_24, l1_out_23, l1_out_22, l1_out_21, l1_out_20, l1_out_19, l1_out_18, l1_out_17,
        l1_out_16, l1_out_15, l1_out_14, l1_out_13, l1_out_12, l1_out_11, l1_out_10, l1_out_9, l1_out_8,
        l1_out_7, l1_out_6, l1_out_5, l1_out_4, l1_out_3, l1_out_2, l1_out_1, l1_out_0};
    wire signed [SumBits-1:0] both = (sum_0 + sum_1) >>> Down;
    /* verilator lint_on UNUSED */

    // Past the last neuron stand zeros.
    wire [(2*Places+1)*ActivationBits-1:0] l1_out
        = {{(2 * Places + 1 - Neurons) * ActivationBits{1'b0}}, ports[ActivationBits*Neurons-1:0]};
    wire [(2*Places+1)*W2Bits-1:0] w2 = {{(2 * Places + 1 - Neurons) * W2Bits{1'b0}}, w2_rom[0]};

    initial begin
        {activation_0, activation_1} = {2 * ActivationBits{1'b0}};
        {w2_0, w2_1} = {2 * W2Bits{1'b0}};
        {term_0, term_1} = {2 * TermBits{1'b0}};
        {sum_0, sum_1} = {2 * SumBits{1'b0}};
        depth = 36'sd0;
    end

    always @* begin
        sum_0_next = sum_0;
        sum_1_next = sum_1;
        depth_next = depth;
        if (forward2_en) begin
            sum_0_next = (forward2_first ? bias : sum_0) + {{SumBits - TermBits{term_0[TermBits-1]}}, term_0};
            sum_1_next = (forward2_first ? {SumBits{1'b0}} : sum_1)
                         + {{SumBits - TermBits{term_1[TermBits-1]}}, term_1};
        end
        if (depth_en) depth_next = both[35:0] <<< Up;
    end

    always @(posedge clk_sys) begin
        activation_0 <= l1_out[2*ActivationBits*pair +: ActivationBits];
        activation_1 <= l1_out[2*ActivationBits*pair+ActivationBits +: ActivationBits];
        w2_0 <= w2[2*W2Bits*pair +: W2Bits];
        w2_1 <= w2[2*W2Bits*pair+W2Bits +: W2Bits];
        term_0 <= activation_0 * w2_0;
        term_1 <= activation_1 * w2_1;
        sum_0 <= sum_0_next;
        sum_1 <= sum_1_next;
        if (rst) depth <= 36'sd0;
        else depth <= depth_next;
    end
endmodule
