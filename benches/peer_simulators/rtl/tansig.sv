`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// Looks up only when it is told to.
module tansig #(
    parameter integer AddressBits = 12,
    parameter integer Shift = 14,
    parameter TansigFile = "rtl_ref/tansig.mem"
) (
    input wire clk_125,
    input wire rst,
    input wire tansig_en,
    input wire signed [35:0] l1_in_0,
    input wire signed [35:0] l1_in_1,
    input wire signed [35:0] l1_in_2,
    input wire signed [35:0] l1_in_3,
    input wire signed [35:0] l1_in_4,
    input wire signed [35:0] l1_in_5,
    input wire signed [35:0] l1_in_6,
    input wire signed [35:0] l1_in_7,
    output reg signed [15:0] l1_out_0,
    output reg signed [15:0] l1_out_1,
    output reg signed [15:0] l1_out_2,
    output reg signed [15:0] l1_out_3,
    output reg signed [15:0] l1_out_4,
    output reg signed [15:0] l1_out_5,
    output reg signed [15:0] l1_out_6,
    output reg signed [15:0] l1_out_7
);
    reg signed [15:0] rom [0:(1 << AddressBits) - 1];
    initial $readmemh(TansigFile, rom);

    // verilator tracing_off
    function [AddressBits-1:0] address;
        input signed [35:0] l1_in;
        reg signed [36:0] rounded;
        begin
            rounded = {l1_in[35], l1_in};
            rounded = (rounded + (37'sd1 <<< (Shift - 1))) >>> Shift;
            if (rounded < -(37'sd1 <<< (AddressBits - 1)))
                address = {1'b1, {AddressBits - 1{1'b0}}};
            else if (rounded >= 37'sd1 <<< (AddressBits - 1))
                address = {1'b0, {AddressBits - 1{1'b1}}};
            else
                address = rounded[AddressBits-1:0];
        end
    endfunction
    // verilator tracing_on

    initial begin
        {l1_out_0, l1_out_1, l1_out_2, l1_out_3} = 64'd0;
        {l1_out_4, l1_out_5, l1_out_6, l1_out_7} = 64'd0;
    end

    always @(`RISE_AWAKE) if (rst || tansig_en) begin
        if (rst) begin
            {l1_out_0, l1_out_1, l1_out_2, l1_out_3} <= 64'd0;
            {l1_out_4, l1_out_5, l1_out_6, l1_out_7} <= 64'd0;
        end else begin
            l1_out_0 <= rom[address(l1_in_0)];
            l1_out_1 <= rom[address(l1_in_1)];
            l1_out_2 <= rom[address(l1_in_2)];
            l1_out_3 <= rom[address(l1_in_3)];
            l1_out_4 <= rom[address(l1_in_4)];
            l1_out_5 <= rom[address(l1_in_5)];
            l1_out_6 <= rom[address(l1_in_6)];
            l1_out_7 <= rom[address(l1_in_7)];
        end
    end
endmodule
