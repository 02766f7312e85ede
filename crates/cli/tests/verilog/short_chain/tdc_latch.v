`timescale 1ns/1ps
`default_nettype none

// The latch of a delay line of 700 taps.
module tdc_latch (
    input wire clk_sys,
    input wire rst,
    input wire start,
    input wire window,
    input wire [2:0] coarse,
    input wire [699:0] taps,
    output reg hit,
    output reg [2:0] hit_coarse,
    output reg [699:0] hit_taps
);
    reg used = 1'b0;
    reg before = 1'b0;
    wire first = taps[0] & ~before & window & ~used;

    initial begin
        hit = 1'b0;
        hit_coarse = 3'd0;
        hit_taps = 700'd0;
    end

    always @(posedge clk_sys) hit_taps <= taps;

    always @(posedge clk_sys)
        if (rst) begin
            hit <= 1'b0;
            hit_coarse <= 3'd0;
            used <= 1'b0;
            before <= 1'b0;
        end else begin
            before <= taps[0];
            hit <= first;
            used <= (used | first) & ~start;
            if (first) hit_coarse <= coarse;
        end
endmodule

`default_nettype wire
