`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// As in rtl_ref.
module control_sync (
    input wire clk_125,
    input wire mode,
    input wire [1:0] laser_freq,
    input wire laser_en,
    input wire dsp_en,
    input wire dsp_rst,
    output reg mode_sync,
    output reg [1:0] laser_freq_sync,
    output reg laser_en_sync,
    output reg dsp_en_sync,
    output reg dsp_rst_sync
);
    reg mode_meta;
    reg [1:0] laser_freq_meta;
    reg laser_en_meta;
    reg dsp_en_meta;
    reg dsp_rst_meta;

    initial begin
        {mode_meta, laser_freq_meta, laser_en_meta, dsp_en_meta, dsp_rst_meta} = 6'd0;
        {mode_sync, laser_freq_sync, laser_en_sync, dsp_en_sync, dsp_rst_sync} = 6'd0;
    end

    always @(`RISE_AWAKE) begin
        mode_meta <= mode;
        laser_freq_meta <= laser_freq;
        laser_en_meta <= laser_en;
        dsp_en_meta <= dsp_en;
        dsp_rst_meta <= dsp_rst;
        mode_sync <= mode_meta;
        laser_freq_sync <= laser_freq_meta;
        laser_en_sync <= laser_en_meta;
        dsp_en_sync <= dsp_en_meta;
        dsp_rst_sync <= dsp_rst_meta;
    end
endmodule
