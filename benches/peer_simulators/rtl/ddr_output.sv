`timescale 1ps / 1ps
`default_nettype none

// As in rtl_ref.
module ddr_output (
    input wire clk_250,
    input wire d,
    output wire q
);
    reg level;

    initial level = 1'b0;

`ifdef SELF_CLOCKED
    always @(edge clk_250) level <= tof_top.pll.rises && d;
`else
    always @(posedge clk_250 or negedge clk_250) level <= clk_250 && d;
`endif

    assign q = level;
endmodule
