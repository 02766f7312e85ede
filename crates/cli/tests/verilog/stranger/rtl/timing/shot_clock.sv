`timescale 1ns/1ps
`include "widths.svh"

// Clocks since the laser, and the window of the TDC. Nothing has a value before the reset.
module shot_clock (
    input  logic clk,
    input  logic rst_n,
    input  logic start,
    output logic [`COARSE_BITS-1:0] coarse,
    output logic window
);
    always_ff @(posedge clk)
        if (!rst_n) begin
            coarse <= '0;
            window <= 1'b0;
        end else if (start) begin
            coarse <= '0;
            window <= 1'b1;
        end else if (window) begin
            if (coarse == `LAST_COARSE) window <= 1'b0;
            else coarse <= coarse + 1'b1;
        end
endmodule
