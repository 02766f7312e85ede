`timescale 1ps / 1fs
`default_nettype none

// The output layer: one multiply-accumulate unit, one neuron an edge, then the bias.
module forward2 #(
    parameter [4:0] Neurons = 5'd8,       // hidden neurons, 1 to 16
    parameter W2File = "rtl_ref/w2.mem",  // one row, a weight for each neuron [2^-14]
    parameter B2File = "rtl_ref/b2.mem"   // the bias [2^-17]
) (
    input wire clk_125,
    input wire rst,
    // estimator_ctrl
    input wire forward2_en,  // accumulates
    // 0 begins the sum, the one past the last neuron is the bias, then the sum holds
    input wire [$clog2(Neurons + 2)-1:0] neuron,
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
    // The depth, when algo_done is high; before that, a partial sum [2^-29 m]
    output reg signed [35:0] depth
);
    reg signed [35:0] depth_next;
    reg signed [15:0] activation, weight;

    reg [16*Neurons-1:0] w2_rom [0:0];
    reg [15:0] b2_rom [0:0];
    initial begin
        $readmemh(W2File, w2_rom);
        $readmemh(B2File, b2_rom);
    end

    wire [16*Neurons-1:0] w2 = w2_rom[0];
    wire [15:0] b2 = b2_rom[0];

    // The ports side by side.
    wire [16*16-1:0] l1_out = {l1_out_15, l1_out_14, l1_out_13, l1_out_12, l1_out_11, l1_out_10, l1_out_9, l1_out_8,
                               l1_out_7, l1_out_6, l1_out_5, l1_out_4, l1_out_3, l1_out_2, l1_out_1, l1_out_0};

    initial depth = 36'sd0;

    integer k;
    always @* begin
        // The bias is a product too, 4096 x B2, so that nothing is added outside the DSP48E1.
        activation = 16'sd4096;
        weight = b2;
        for (k = 0; k < Neurons; k = k + 1) begin
            if (neuron == k[$clog2(Neurons + 2)-1:0]) begin
                activation = l1_out[16*k +: 16];
                weight = w2[16*k +: 16];
            end
        end
        depth_next = depth;
        if (forward2_en && neuron <= Neurons[$clog2(Neurons + 2)-1:0])
            depth_next = (neuron == 0 ? 36'sd0 : depth) + activation * weight;
    end

    always @(posedge clk_125) begin
        if (rst) depth <= 36'sd0;
        else depth <= depth_next;
    end
endmodule
