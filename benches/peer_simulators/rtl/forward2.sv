`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// Multiplies only when it accumulates.
module forward2 #(
    parameter W2File = "rtl_ref/w2.mem",
    parameter B2File = "rtl_ref/b2.mem"
) (
    input wire clk_125,
    input wire rst,
    input wire forward2_en,
    input wire [3:0] neuron,
    input wire signed [15:0] l1_out_0,
    input wire signed [15:0] l1_out_1,
    input wire signed [15:0] l1_out_2,
    input wire signed [15:0] l1_out_3,
    input wire signed [15:0] l1_out_4,
    input wire signed [15:0] l1_out_5,
    input wire signed [15:0] l1_out_6,
    input wire signed [15:0] l1_out_7,
    output reg signed [35:0] depth
);
    // verilator tracing_off
    reg [127:0] w2_rom [0:0];
    reg [15:0] b2_rom [0:0];
    initial begin
        $readmemh(W2File, w2_rom);
        $readmemh(B2File, b2_rom);
        depth = 36'sd0;
    end

    always @(`RISE_AWAKE) if (rst || forward2_en) begin : work
        reg signed [15:0] activation, weight;
        case (neuron)
            4'd0: activation = l1_out_0;
            4'd1: activation = l1_out_1;
            4'd2: activation = l1_out_2;
            4'd3: activation = l1_out_3;
            4'd4: activation = l1_out_4;
            4'd5: activation = l1_out_5;
            4'd6: activation = l1_out_6;
            4'd7: activation = l1_out_7;
            default: activation = 16'sd4096;
        endcase
        weight = neuron[3] ? b2_rom[0] : w2_rom[0][{neuron[2:0], 4'd0} +: 16];
        if (rst) depth <= 36'sd0;
        else if (neuron <= 4'd8)
            depth <= (neuron == 4'd0 ? 36'sd0 : depth) + activation * weight;
    end
    // verilator tracing_on
endmodule
