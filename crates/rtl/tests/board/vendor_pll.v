`timescale 1ps / 1fs
`default_nettype none

// A PLL as both vendors have it: it measures its input, and divides a VCO of that frequency by Multiply / Divide. The
// clocks run from the eighth rise of the input on, and are locked after a microsecond if the loop is closed.
module vendor_pll #(
    parameter real LeastVcoMhz = 0.0,
    parameter real MostVcoMhz = 0.0,
    parameter real PeriodNs = 0.0,  // of the input as the instance says it; 0: it does not
    parameter integer Multiply = 1,
    parameter integer Divide = 1,
    parameter integer Divide0 = 1,
    parameter integer Divide1 = 1,
    parameter integer FeedbackDivide = 1,
    parameter integer Phase0 = 0,   // count of the divider with which an output rises
    parameter integer Phase1 = 0
) (
    input wire clk_in,
    input wire feedback_in,
    output reg feedback_out,
    output reg clk_0,
    output reg clk_1,
    output reg locked
);
    integer half;      // halves of a period of the VCO
    integer returned;  // rises of the feedback
    real first, period, half_ps;

    initial returned = 0;
    always @(posedge feedback_in) returned = returned + 1;

    initial begin
        locked = 1'b0;
        #1000001 locked = returned > 8;
    end

    initial begin
        {feedback_out, clk_0, clk_1} = 3'd0;
        @(posedge clk_in) first = $realtime;
        repeat (7) @(posedge clk_in);
        period = ($realtime - first) / 7.0;
        half_ps = period * Divide / Multiply / 2.0;
        if (5.0e5 / half_ps < LeastVcoMhz || 5.0e5 / half_ps > MostVcoMhz) begin
            $display("%m: the VCO would run at %f MHz", 5.0e5 / half_ps);
            $finish;
        end
        if (PeriodNs != 0.0 && (PeriodNs * 1000.0 > period + 1.0 || PeriodNs * 1000.0 < period - 1.0)) begin
            $display("%m: the input has a period of %f ps, not of %f ns", period, PeriodNs);
            $finish;
        end
        half = 0;
        forever begin
            clk_0 <= (half + 2 * (Divide0 - Phase0)) % (2 * Divide0) < Divide0;
            clk_1 <= (half + 2 * (Divide1 - Phase1)) % (2 * Divide1) < Divide1;
            feedback_out <= half % (2 * FeedbackDivide) < FeedbackDivide;
            #(half_ps) half = half + 1;
        end
    end
endmodule
