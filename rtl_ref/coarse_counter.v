`timescale 1ps / 1fs
`default_nettype none

// Counts the cycles of a shot, and closes the TDC's window after eight (64 ns).
module coarse_counter (
    input wire clk_sys,
    input wire rst,
    input wire start,         // a shot begins
    output reg [2:0] coarse,  // whole cycles from the laser edge to the edge before the last
    output reg window         // a hit now belongs to the shot
);
    reg [2:0] coarse_next;
    reg window_next;

    initial begin
        coarse = 3'd0;
        window = 1'b0;
    end

    always @* begin
        coarse_next = coarse;
        window_next = window;
        if (start) begin
            coarse_next = 3'd0;
            window_next = 1'b1;
        end else if (window) begin
            if (coarse == 3'd7) window_next = 1'b0;
            else coarse_next = coarse + 3'd1;
        end
    end

    always @(posedge clk_sys) begin
        if (rst) begin
            coarse <= 3'd0;
            window <= 1'b0;
        end else begin
            coarse <= coarse_next;
            window <= window_next;
        end
    end
endmodule
