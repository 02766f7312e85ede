`timescale 1ns/1ps
`default_nettype none

// A histogram in flip-flops, all counts on one output, as in the thesis's Listing 6.1.
module HB (
    input wire CLK,
    input wire CLEAR,
    input wire [7:0] CLEAR_BIN,
    input wire TDC_VALID,
    input wire [7:0] TDC_CODE,
    output reg [4095:0] Histogram
);
    initial Histogram = 4096'd0;

    always @(posedge CLK)
        if (CLEAR) Histogram[16 * CLEAR_BIN +: 16] <= 16'd0;
        else if (TDC_VALID)
            Histogram[16 * TDC_CODE +: 16] <= Histogram[16 * TDC_CODE +: 16] + 16'd1;
endmodule

`default_nettype wire
