`timescale 1ps / 1fs
`default_nettype none

// Brings the acquisition computer's signals into clk_sys, two flip-flops each, which belong side by side. The bits of
// laser_freq cross one by one; with a host, they are taken once two samples of all of them agree.
module control_sync #(
    parameter integer RateBits = 2,
    parameter [0:0] Hosted = 1'b0
) (
    input wire clk_sys,
    // Acquisition computer, asynchronous
    input wire mode,                       // SPAD quench mode
    input wire [RateBits-1:0] laser_freq,  // laser repetition rate
    input wire laser_en,                   // lets the laser fire
    input wire dsp_en,                     // lets the estimator start
    input wire dsp_rst,                    // abandons the frame
    // The same in clk_sys
    (* ASYNC_REG = "TRUE" *) output reg mode_sync,
    (* ASYNC_REG = "TRUE" *) output reg [RateBits-1:0] laser_freq_sync,
    (* ASYNC_REG = "TRUE" *) output reg laser_en_sync,
    (* ASYNC_REG = "TRUE" *) output reg dsp_en_sync,
    (* ASYNC_REG = "TRUE" *) output reg dsp_rst_sync
);
    (* ASYNC_REG = "TRUE" *) reg mode_meta;
    (* ASYNC_REG = "TRUE" *) reg [RateBits-1:0] laser_freq_meta;
    (* ASYNC_REG = "TRUE" *) reg [RateBits-1:0] laser_freq_second;
    reg [RateBits-1:0] laser_freq_third;
    (* ASYNC_REG = "TRUE" *) reg laser_en_meta;
    (* ASYNC_REG = "TRUE" *) reg dsp_en_meta;
    (* ASYNC_REG = "TRUE" *) reg dsp_rst_meta;

    initial begin
        {mode_meta, laser_freq_meta, laser_en_meta, dsp_en_meta, dsp_rst_meta} = {4 + RateBits{1'b0}};
        {laser_freq_second, laser_freq_third} = {2 * RateBits{1'b0}};
        {mode_sync, laser_freq_sync, laser_en_sync, dsp_en_sync, dsp_rst_sync} = {4 + RateBits{1'b0}};
    end

    always @(posedge clk_sys) begin
        mode_meta <= mode;
        laser_freq_meta <= laser_freq;
        laser_en_meta <= laser_en;
        dsp_en_meta <= dsp_en;
        dsp_rst_meta <= dsp_rst;
        mode_sync <= mode_meta;
        laser_freq_second <= Hosted ? laser_freq_meta : {RateBits{1'b0}};
        laser_freq_third <= laser_freq_second;
        if (!Hosted) laser_freq_sync <= laser_freq_meta;
        else if (laser_freq_second == laser_freq_third) laser_freq_sync <= laser_freq_third;
        laser_en_sync <= laser_en_meta;
        dsp_en_sync <= dsp_en_meta;
        dsp_rst_sync <= dsp_rst_meta;
    end
endmodule
