`timescale 1ps / 1fs
`default_nettype none

// The activation of the hidden layer, from a table: eight lookups in one cycle.
module tansig #(
    parameter integer AddressBits = 12,           // size of the table, which covers +-4
    parameter integer Shift = 14,                 // fraction bits of l1_in that the address drops
    parameter TansigFile = "rtl_ref/tansig.mem"   // by address as an unsigned number [2^-15]
) (
    input wire clk_125,
    input wire rst,
    input wire tansig_en,  // looks up the activations
    // Sums of the neurons [2^-23]
    input wire signed [35:0] l1_in_0,
    input wire signed [35:0] l1_in_1,
    input wire signed [35:0] l1_in_2,
    input wire signed [35:0] l1_in_3,
    input wire signed [35:0] l1_in_4,
    input wire signed [35:0] l1_in_5,
    input wire signed [35:0] l1_in_6,
    input wire signed [35:0] l1_in_7,
    // Activations of the neurons [2^-15]
    output reg signed [15:0] l1_out_0,
    output reg signed [15:0] l1_out_1,
    output reg signed [15:0] l1_out_2,
    output reg signed [15:0] l1_out_3,
    output reg signed [15:0] l1_out_4,
    output reg signed [15:0] l1_out_5,
    output reg signed [15:0] l1_out_6,
    output reg signed [15:0] l1_out_7
);
    reg signed [15:0] l1_out_0_next, l1_out_1_next, l1_out_2_next, l1_out_3_next;
    reg signed [15:0] l1_out_4_next, l1_out_5_next, l1_out_6_next, l1_out_7_next;

    // Block RAM, or LUTs for gate-level simulation, since Yosys has no model of a block RAM.
`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg signed [15:0] rom [0:(1 << AddressBits) - 1];
    initial $readmemh(TansigFile, rom);

    // The sum, rounded half up and saturated: the only rounding in the datapath.
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

    wire signed [15:0] entry_0 = rom[address(l1_in_0)];
    wire signed [15:0] entry_1 = rom[address(l1_in_1)];
    wire signed [15:0] entry_2 = rom[address(l1_in_2)];
    wire signed [15:0] entry_3 = rom[address(l1_in_3)];
    wire signed [15:0] entry_4 = rom[address(l1_in_4)];
    wire signed [15:0] entry_5 = rom[address(l1_in_5)];
    wire signed [15:0] entry_6 = rom[address(l1_in_6)];
    wire signed [15:0] entry_7 = rom[address(l1_in_7)];

    initial begin
        l1_out_0 = 16'sd0;
        l1_out_1 = 16'sd0;
        l1_out_2 = 16'sd0;
        l1_out_3 = 16'sd0;
        l1_out_4 = 16'sd0;
        l1_out_5 = 16'sd0;
        l1_out_6 = 16'sd0;
        l1_out_7 = 16'sd0;
    end

    always @* begin
        l1_out_0_next = l1_out_0;
        l1_out_1_next = l1_out_1;
        l1_out_2_next = l1_out_2;
        l1_out_3_next = l1_out_3;
        l1_out_4_next = l1_out_4;
        l1_out_5_next = l1_out_5;
        l1_out_6_next = l1_out_6;
        l1_out_7_next = l1_out_7;
        if (tansig_en) begin
            l1_out_0_next = entry_0;
            l1_out_1_next = entry_1;
            l1_out_2_next = entry_2;
            l1_out_3_next = entry_3;
            l1_out_4_next = entry_4;
            l1_out_5_next = entry_5;
            l1_out_6_next = entry_6;
            l1_out_7_next = entry_7;
        end
    end

    always @(posedge clk_125) begin
        if (rst) begin
            l1_out_0 <= 16'sd0;
            l1_out_1 <= 16'sd0;
            l1_out_2 <= 16'sd0;
            l1_out_3 <= 16'sd0;
            l1_out_4 <= 16'sd0;
            l1_out_5 <= 16'sd0;
            l1_out_6 <= 16'sd0;
            l1_out_7 <= 16'sd0;
        end else begin
            l1_out_0 <= l1_out_0_next;
            l1_out_1 <= l1_out_1_next;
            l1_out_2 <= l1_out_2_next;
            l1_out_3 <= l1_out_3_next;
            l1_out_4 <= l1_out_4_next;
            l1_out_5 <= l1_out_5_next;
            l1_out_6 <= l1_out_6_next;
            l1_out_7 <= l1_out_7_next;
        end
    end
endmodule
