`timescale 1ps / 1ps
`default_nettype none

// As in rtl_ref.
module reset_sync (
    input wire clk,
    input wire rst,
    input wire locked,
    output reg rst_sync
);
    reg meta;

    initial {rst_sync, meta} = 2'b11;

`ifdef SELF_CLOCKED
    always @(edge clk) if (tof_top.pll.rises) begin
`else
    always @(posedge clk) begin
`endif
        meta <= rst | ~locked;
        rst_sync <= meta;
    end
endmodule
