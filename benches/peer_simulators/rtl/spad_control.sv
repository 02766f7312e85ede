`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// As in rtl_ref; the row in use never changes.
module spad_control (
    input wire clk_125,
    input wire rst,
    input wire mode,
    input wire pre_start,
    output reg spad_rst,
    output wire [39:0] spad_sel
);
    initial spad_rst = 1'b0;

    assign spad_sel = 40'd1;

    always @(`RISE_125) spad_rst <= !rst && pre_start && !mode;
endmodule
