`timescale 1ps / 1fs
`default_nettype none

// Counts the cycles of a shot, and closes the TDC's window after all that it can count.
module coarse_counter #(
    parameter integer CoarseBits = 3  // eight cycles, 64 ns
) (
    input wire clk_sys,
    input wire rst,
    input wire start,                    // a shot begins
    output reg [CoarseBits-1:0] coarse,  // whole cycles from the laser edge to the edge before the last
    output reg window                    // a hit now belongs to the shot
);
    localparam [CoarseBits-1:0] None = {CoarseBits{1'b0}};

    reg [CoarseBits-1:0] coarse_next;
    reg window_next;

    initial begin
        coarse = None;
        window = 1'b0;
    end

    always @* begin
        coarse_next = coarse;
        window_next = window;
        if (start) begin
            coarse_next = None;
            window_next = 1'b1;
        end else if (window) begin
            if (&coarse) window_next = 1'b0;
            else coarse_next = coarse + 1'b1;
        end
    end

    always @(posedge clk_sys) begin
        if (rst) begin
            coarse <= None;
            window <= 1'b0;
        end else begin
            coarse <= coarse_next;
            window <= window_next;
        end
    end
endmodule
