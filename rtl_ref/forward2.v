`timescale 1ps / 1fs
`default_nettype none

// The output layer: one multiply-accumulate unit, one neuron an edge, then the bias.
module forward2 #(
    parameter W2File = "rtl_ref/w2.mem",  // one row of eight weights [2^-14]
    parameter B2File = "rtl_ref/b2.mem"   // the bias [2^-17]
) (
    input wire clk_125,
    input wire rst,
    // estimator_ctrl
    input wire forward2_en,         // accumulates
    input wire [3:0] neuron,        // 0 begins the sum, 8 is the bias, from 9 on the sum holds
    // Activations of the hidden layer [2^-15]
    input wire signed [15:0] l1_out_0,
    input wire signed [15:0] l1_out_1,
    input wire signed [15:0] l1_out_2,
    input wire signed [15:0] l1_out_3,
    input wire signed [15:0] l1_out_4,
    input wire signed [15:0] l1_out_5,
    input wire signed [15:0] l1_out_6,
    input wire signed [15:0] l1_out_7,
    // The depth, when algo_done is high; before that, a partial sum [2^-29 m]
    output reg signed [35:0] depth
);
    reg signed [35:0] depth_next;
    reg signed [15:0] activation, weight;

    reg [127:0] w2_rom [0:0];
    reg [15:0] b2_rom [0:0];
    initial begin
        $readmemh(W2File, w2_rom);
        $readmemh(B2File, b2_rom);
    end

    wire [127:0] w2 = w2_rom[0];
    wire [15:0] b2 = b2_rom[0];

    initial depth = 36'sd0;

    always @* begin
        case (neuron)
            4'd0: activation = l1_out_0;
            4'd1: activation = l1_out_1;
            4'd2: activation = l1_out_2;
            4'd3: activation = l1_out_3;
            4'd4: activation = l1_out_4;
            4'd5: activation = l1_out_5;
            4'd6: activation = l1_out_6;
            4'd7: activation = l1_out_7;
            // The bias is a product too, 4096 x B2, so that nothing is added outside the DSP48E1.
            default: activation = 16'sd4096;
        endcase
        weight = neuron[3] ? b2 : w2[{neuron[2:0], 4'd0} +: 16];
        depth_next = depth;
        if (forward2_en && neuron <= 4'd8)
            depth_next = (neuron == 4'd0 ? 36'sd0 : depth) + activation * weight;
    end

    always @(posedge clk_125) begin
        if (rst) depth <= 36'sd0;
        else depth <= depth_next;
    end
endmodule
