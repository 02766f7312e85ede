`timescale 1ps / 1fs
`default_nettype none

// The device on a KC705: tof_top with the board's differential oscillator; for synthesis only.
`ifdef SYNTHESIS
module kc705_top #(
    parameter [0:0] Hosted = 1'b1,               // see tof_top
    parameter [0:0] Calibrated = 1'b1,
    parameter [15:0] CalibrationFrames = 16'd64,
    // Of the scenario kc705 with tdc.recalibrate_frames=64
    parameter [63:0] ParametersHash = 64'h44280bd99df9bae2
) (
    // Board
    input wire sysclk_p,              // 200 MHz oscillator
    input wire sysclk_n,
    input wire cpu_reset,             // button, active high
    output wire locked,               // LED: the clocks run
    // Laser
    output wire laser_on_lvds_p,      // positive pin
    output wire laser_on_lvds_n,      // negative pin
    // Host, over the USB-UART
    input wire uart_rx,               // from it
    output wire uart_tx,              // to it
    output wire armed,                // LED: the laser may fire
    input wire interlock,             // low while the laser's interlock is closed
    input wire select_pins,           // switch: the acquisition computer's pins are in force, and not the host
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
    output wire [35:0] sigma,         // its standard deviation, from likelihood_estimator only [2^-29 m]
    output wire [6:0] status,         // why not to believe it; likewise
    output wire valid,                // the status says nothing against it; likewise
    output wire algo_done,            // the depth is ready; one cycle
    output wire hist_valid,           // a word of the histogram is being read
    output wire [7:0] hist_bin,       // which word
    output wire [15:0] hist_count,    // the word [hits]
    output wire frame_done            // the frame has ended; one cycle
);
    wire clk_in, ring_on, hit;

    IBUFDS ibufds (
        .I(sysclk_p),
        .IB(sysclk_n),
        .O(clk_in)
    );

    ring_oscillator ring_oscillator (
        .enable(ring_on),
        .tdc_stop(tdc_stop),
        .hit(hit)
    );

    tof_top #(
        .Hosted(Hosted),
        .ParametersHash(ParametersHash),
        .Calibrated(Calibrated),
        .CalibrationFrames(CalibrationFrames)
    ) tof_top (
        .clk_in(clk_in),
        .rst(cpu_reset),
        .locked(locked),
        .laser_on_lvds_p(laser_on_lvds_p),
        .laser_on_lvds_n(laser_on_lvds_n),
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
        .select_pins(select_pins),
        .depth(depth),
        .algo_done(algo_done),
        .sigma(sigma),
        .status(status),
        .valid(valid),
        .hist_valid(hist_valid),
        .hist_bin(hist_bin),
        .hist_count(hist_count),
        .frame_done(frame_done)
    );
endmodule
`endif
