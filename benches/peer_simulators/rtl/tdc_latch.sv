`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// Copies the taps on a hit only.
module tdc_latch (
    input wire clk_125,
    input wire rst,
    input wire start,
    input wire window,
    input wire [2:0] coarse,
    input wire [799:0] taps,
    output reg hit,
    output reg [2:0] hit_coarse,
    output reg [799:0] hit_taps
);
    reg used;
    reg tap_0_last;

    initial begin
        {hit, used, tap_0_last} = 3'd0;
        hit_coarse = 3'd0;
        hit_taps = 800'd0;
    end

    always @(`RISE_125) begin
        if (rst) begin
            {hit, used, tap_0_last} <= 3'd0;
            hit_coarse <= 3'd0;
            hit_taps <= 800'd0;
        end else begin
            hit <= 1'b0;
            tap_0_last <= taps[0];
            if (taps[0] && !tap_0_last && window && !used) begin
                hit <= 1'b1;
                hit_coarse <= coarse;
                hit_taps <= taps;
                used <= 1'b1;
            end
            if (start) used <= 1'b0;
        end
    end
endmodule
