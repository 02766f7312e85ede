`timescale 1ps / 1fs
`default_nettype none

// Says which taps are a shot's first hit, or while free is high, any. All pass through one register, at every edge: an enable that
// comes from tap 0 and has as many loads as there are taps would be the slowest path of the device.
module tdc_latch #(
    parameter integer Taps = 800,
    parameter integer CoarseBits = 3,
    parameter [0:0] Calibrated = 1'b0,  // looks at free
    parameter [0:0] Hosted = 1'b0       // likewise
) (
    input wire clk_sys,
    input wire rst,
    input wire start,                        // a shot begins
    // coarse_counter
    input wire window,                       // a hit now belongs to the shot
    // verilator lint_off UNUSEDSIGNAL
    input wire free,                         // every hit counts, whatever the shot
    // verilator lint_on UNUSEDSIGNAL
    input wire [CoarseBits-1:0] coarse,      // coarse count, in step with the taps
    // carry_chain
    input wire [Taps-1:0] taps,              // taps sampled at the last edge
    // tdc_decoder
    output reg hit,                          // hit_taps are a new hit; one cycle
    output reg [CoarseBits-1:0] hit_coarse,  // coarse count of the last hit
    output reg [Taps-1:0] hit_taps           // taps sampled at the edge before
);
    reg used;        // the shot has had its hit
    reg tap_0_last;  // tap 0 at the edge before

    reg hit_next, used_next, tap_0_last_next;
    reg [CoarseBits-1:0] hit_coarse_next;

    initial begin
        {hit, used, tap_0_last} = 3'd0;
        hit_coarse = {CoarseBits{1'b0}};
        hit_taps = {Taps{1'b0}};
    end

    always @* begin
        hit_next = taps[0] && !tap_0_last && ((Calibrated || Hosted) && free || window && !used);
        hit_coarse_next = hit_coarse;
        used_next = used;
        tap_0_last_next = taps[0];
        if (hit_next) begin
            hit_coarse_next = coarse;
            used_next = 1'b1;
        end
        // A hit kept now belongs to the shot before.
        if (start) used_next = 1'b0;
    end

    always @(posedge clk_sys) begin
        hit_taps <= taps;
        if (rst) begin
            hit <= 1'b0;
            hit_coarse <= {CoarseBits{1'b0}};
            used <= 1'b0;
            tap_0_last <= 1'b0;
        end else begin
            hit <= hit_next;
            hit_coarse <= hit_coarse_next;
            used <= used_next;
            tap_0_last <= tap_0_last_next;
        end
    end
endmodule
