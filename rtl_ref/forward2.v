`timescale 1ps / 1fs
`default_nettype none

// The output layer: two multiply-accumulate units, one for the even and one for the odd neurons, so
// two neurons an edge.
//
//   activation_k (A), w2_k (B)  ->  term_k (M)  ->  sum_k (P)  ->  depth = sum_0 + sum_1
module forward2 #(
    parameter [4:0] Neurons = 5'd8,       // hidden neurons, 1 to 16
    parameter W2File = "rtl_ref/w2.mem",  // one row, a weight for each neuron [2^-14]
    parameter B2File = "rtl_ref/b2.mem"   // the bias [2^-17]
) (
    input wire clk_sys,
    input wire rst,
    // estimator_ctrl
    input wire [2:0] pair,      // neurons 2 pair and 2 pair + 1 become operands
    input wire forward2_first,  // the sums begin, one of them with the bias
    input wire forward2_en,     // accumulates
    input wire depth_en,        // the sums become the depth
    // Activations of the hidden layer; not looked at past the last neuron [2^-15]
    input wire signed [15:0] l1_out_0,
    input wire signed [15:0] l1_out_1,
    input wire signed [15:0] l1_out_2,
    input wire signed [15:0] l1_out_3,
    input wire signed [15:0] l1_out_4,
    input wire signed [15:0] l1_out_5,
    input wire signed [15:0] l1_out_6,
    input wire signed [15:0] l1_out_7,
    input wire signed [15:0] l1_out_8,
    input wire signed [15:0] l1_out_9,
    input wire signed [15:0] l1_out_10,
    input wire signed [15:0] l1_out_11,
    input wire signed [15:0] l1_out_12,
    input wire signed [15:0] l1_out_13,
    input wire signed [15:0] l1_out_14,
    input wire signed [15:0] l1_out_15,
    // From algo_done until the next one [2^-29 m]
    output reg signed [35:0] depth
);
    reg signed [15:0] activation_0, activation_1, w2_0, w2_1;
    reg signed [31:0] term_0, term_1;
    reg signed [35:0] sum_0, sum_1;

    reg signed [35:0] sum_0_next, sum_1_next, depth_next;

    reg [16*Neurons-1:0] w2_rom [0:0];
    reg [15:0] b2_rom [0:0];
    initial begin
        $readmemh(W2File, w2_rom);
        $readmemh(B2File, b2_rom);
    end

    wire [15:0] b2 = b2_rom[0];
    wire signed [35:0] bias = {{8{b2[15]}}, b2, 12'd0};

    // The ports side by side.
    /* verilator lint_off UNUSED */
    wire [16*16-1:0] ports = {l1_out_15, l1_out_14, l1_out_13, l1_out_12, l1_out_11, l1_out_10, l1_out_9,
                              l1_out_8, l1_out_7, l1_out_6, l1_out_5, l1_out_4, l1_out_3, l1_out_2,
                              l1_out_1, l1_out_0};
    /* verilator lint_on UNUSED */

    // Past the last neuron stand zeros.
    wire [16*17-1:0] l1_out = {{16 * (17 - Neurons){1'b0}}, ports[16*Neurons-1:0]};
    wire [16*17-1:0] w2 = {{16 * (17 - Neurons){1'b0}}, w2_rom[0]};

    initial begin
        {activation_0, activation_1, w2_0, w2_1} = 64'd0;
        {term_0, term_1} = 64'd0;
        {sum_0, sum_1, depth} = 108'd0;
    end

    always @* begin
        sum_0_next = sum_0;
        sum_1_next = sum_1;
        depth_next = depth;
        if (forward2_en) begin
            sum_0_next = (forward2_first ? bias : sum_0) + {{4{term_0[31]}}, term_0};
            sum_1_next = (forward2_first ? 36'sd0 : sum_1) + {{4{term_1[31]}}, term_1};
        end
        if (depth_en) depth_next = sum_0 + sum_1;
    end

    always @(posedge clk_sys) begin
        activation_0 <= l1_out[{1'b0, pair, 5'd0} +: 16];
        activation_1 <= l1_out[{1'b0, pair, 5'd16} +: 16];
        w2_0 <= w2[{1'b0, pair, 5'd0} +: 16];
        w2_1 <= w2[{1'b0, pair, 5'd16} +: 16];
        term_0 <= activation_0 * w2_0;
        term_1 <= activation_1 * w2_1;
        sum_0 <= sum_0_next;
        sum_1 <= sum_1_next;
        if (rst) depth <= 36'sd0;
        else depth <= depth_next;
    end
endmodule
