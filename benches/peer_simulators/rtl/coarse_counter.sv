`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// As in rtl_ref, without a wire for every next value.
module coarse_counter (
    input wire clk_125,
    input wire rst,
    input wire start,
    output reg [2:0] coarse,
    output reg window
);
    initial begin
        coarse = 3'd0;
        window = 1'b0;
    end

    always @(`RISE_125) begin
        if (rst) begin
            coarse <= 3'd0;
            window <= 1'b0;
        end else if (start) begin
            coarse <= 3'd0;
            window <= 1'b1;
        end else if (window) begin
            if (coarse == 3'd7) window <= 1'b0;
            else coarse <= coarse + 3'd1;
        end
    end
endmodule
