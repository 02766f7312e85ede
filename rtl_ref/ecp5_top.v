`timescale 1ps / 1fs
`default_nettype none

// The device on Lattice's ECP5 Evaluation Board, with an oscillator in the place X5; for synthesis only, with the
// macro ECP5.
`ifdef SYNTHESIS
`ifdef ECP5
module ecp5_top #(
    parameter [0:0] Hosted = 1'b1,               // see tof_top
    parameter [0:0] Calibrated = 1'b1,
    parameter [15:0] CalibrationFrames = 16'd64,
    // Of the scenario kc705 with tdc.recalibrate_frames=64, pll.part=ecp5, pll.divide=2 and pll.output_divide=4
    parameter [63:0] ParametersHash = 64'hf4c05bf7c788278d
) (
    // Board
    input wire clk_in,                // oscillator, 200 MHz
    output wire clk_in_en,            // its enable
    input wire reset_n,               // button, active low
    output wire locked_n,             // LED, active low: the clocks run
    // Laser
    output wire laser_on_lvds_p,      // positive pin; its I/O cell drives the negative one
    // Host, over the USB-UART
    input wire uart_rx,               // from it
    output wire uart_tx,              // to it
    output wire armed_n,              // LED, active low: the laser may fire
    input wire interlock,             // low while the laser's interlock is closed
    input wire select_pins_n,         // switch, active low: the acquisition computer's pins are in force, and not the host
    // SPAD array
    input wire tdc_stop,              // its output, asynchronous
    output wire spad_rst,             // recharges the SPAD and keeps it off
    output wire [39:0] spad_sel,      // row, one-hot
    // Acquisition computer
    input wire mode,                  // SPAD quench mode
    input wire [1:0] laser_freq,      // laser repetition rate
    input wire laser_en,              // lets the laser fire
    input wire dsp_en,                // lets the estimator start
    input wire dsp_rst,               // abandons the frame
    output wire signed [35:0] depth,  // from algo_done until the next one [2^-29 m]
    output wire algo_done,            // the depth is ready; one cycle
    output wire hist_valid,           // a word of the histogram is being read
    output wire [7:0] hist_bin,       // which word
    output wire [15:0] hist_count,    // the word [hits]
    output wire frame_done            // the frame has ended; one cycle
);
    wire locked, armed, ring_on, hit;

    assign clk_in_en = 1'b1;
    assign locked_n = !locked;
    assign armed_n = !armed;

    ring_oscillator ring_oscillator (
        .enable(ring_on),
        .tdc_stop(tdc_stop),
        .hit(hit)
    );

    // The VCO at 500 MHz.
    tof_top #(
        .Hosted(Hosted),
        .ParametersHash(ParametersHash),
        .Calibrated(Calibrated),
        .CalibrationFrames(CalibrationFrames),
        .InputHz(200000000),
        .Multiply(5),
        .Divide(2),
        .OutputDivide(4)
    ) tof_top (
        .clk_in(clk_in),
        .rst(!reset_n),
        .locked(locked),
        .laser_on_lvds_p(laser_on_lvds_p),
        .laser_on_lvds_n(),
        .tdc_stop(hit),
        .ring_on(ring_on),
        .spad_rst(spad_rst),
        .spad_sel(spad_sel),
        .mode(mode),
        .laser_freq(laser_freq),
        .laser_en(laser_en),
        .dsp_en(dsp_en),
        .dsp_rst(dsp_rst),
        .uart_rx(uart_rx),
        .uart_tx(uart_tx),
        .armed(armed),
        .interlock(interlock),
        .select_pins(!select_pins_n),
        .depth(depth),
        .algo_done(algo_done),
        // Left open: a logic analyser in the FPGA shows them.
        .sigma(),
        .status(),
        .valid(),
        .hist_valid(hist_valid),
        .hist_bin(hist_bin),
        .hist_count(hist_count),
        .frame_done(frame_done)
    );
endmodule
`endif
`endif
