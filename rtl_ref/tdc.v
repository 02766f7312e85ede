`timescale 1ps / 1fs
`default_nettype none

// The time-to-digital converter: wires its four blocks.
//
//   tdc_stop -> carry_chain -> tdc_latch -> tdc_decoder -> tdc_code, tdc_valid
//   start ----> coarse_counter --^
//   edge             e             e+1        e+2 .. e+7
module tdc #(
    parameter DelaysFile = "rtl_ref/tap_delays.mem",  // for simulation, see carry_chain
    parameter CalFile = "rtl_ref/tdc_cal.mem",        // see tdc_decoder
    parameter integer Taps = 800,
    parameter integer CoarseBits = 3,
    parameter integer BinBits = 8,
    parameter integer Cycle = 5120,  // [units]
    parameter integer Digits = 4,
    parameter integer AgeBits = 14,
    parameter [1:0] CountStages = 2'd3,
    parameter [1:0] Decoder = 2'd0,
    parameter [0:0] Calibrated = 1'b0,
    parameter [0:0] Hosted = 1'b0,              // see tdc_latch
    parameter [16*Taps-1:0] Order = 0
) (
    input wire clk_sys,
    input wire rst,
    input wire start,                    // a shot begins
    input wire tdc_stop,                 // output of the SPAD, asynchronous
    input wire free,                     // every hit counts, whatever the shot: those of a calibration
    input wire [AgeBits-1:0] calibrated_age,  // for the last hit's n by the last calibration [units]
    output wire n_valid,                 // n is new; one cycle
    output wire [$clog2(Taps+1)-1:0] n,  // taps that the hit had run through, by the decoder
    output wire [BinBits-1:0] tdc_code,  // time of the hit [bins]
    output wire tdc_valid                // tdc_code is new; one cycle
);
    wire [Taps-1:0] taps;
    wire [CoarseBits-1:0] coarse;
    wire window;
    wire hit;
    wire [CoarseBits-1:0] hit_coarse;
    wire [Taps-1:0] hit_taps;

    carry_chain #(
        .Taps(Taps),
        .DelaysFile(DelaysFile)
    ) carry_chain (
        .clk_sys(clk_sys),
        .tdc_stop(tdc_stop),
        .taps(taps)
    );

    coarse_counter #(
        .CoarseBits(CoarseBits)
    ) coarse_counter (
        .clk_sys(clk_sys),
        .rst(rst),
        .start(start),
        .coarse(coarse),
        .window(window)
    );

    tdc_latch #(
        .Taps(Taps),
        .CoarseBits(CoarseBits),
        .Calibrated(Calibrated),
        .Hosted(Hosted)
    ) tdc_latch (
        .clk_sys(clk_sys),
        .rst(rst),
        .start(start),
        .window(window),
        .free(free),
        .coarse(coarse),
        .taps(taps),
        .hit(hit),
        .hit_coarse(hit_coarse),
        .hit_taps(hit_taps)
    );

    tdc_decoder #(
        .Taps(Taps),
        .CoarseBits(CoarseBits),
        .BinBits(BinBits),
        .Cycle(Cycle),
        .Digits(Digits),
        .AgeBits(AgeBits),
        .CalFile(CalFile),
        .CountStages(CountStages),
        .Decoder(Decoder),
        .Calibrated(Calibrated),
        .Order(Order)
    ) tdc_decoder (
        .clk_sys(clk_sys),
        .rst(rst),
        .hit(hit),
        .hit_coarse(hit_coarse),
        .hit_taps(hit_taps),
        .calibrated_age(calibrated_age),
        .n_valid(n_valid),
        .n(n),
        .tdc_valid(tdc_valid),
        .tdc_code(tdc_code)
    );
endmodule
