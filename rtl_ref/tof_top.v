`timescale 1ps / 1fs
`default_nettype none

// The device: its modules and the wires between them.
module tof_top #(
    parameter integer BinBits = 8,               // see histogram_builder
    parameter integer CountBits = 16,
    parameter integer Rows = 1,                  // see frame_ctrl
    parameter integer Columns = 1,
    parameter integer Banks = 1,
    // Each column but the first loads files of its own, column 7 CalFile.07 and DelaysFile.07; 0: all load CalFile and DelaysFile.
    parameter [0:0] OwnChains = 1'b0,
    parameter integer SumBits = 36,              // see forward1
    // Word formats and table of depth_estimator, see forward1, tansig and forward2
    parameter integer W1Bits = 16,
    parameter integer W1Fraction = 23,
    parameter integer B1Bits = 16,
    parameter integer B1Fraction = 13,
    parameter integer AddressBits = 12,
    parameter integer RangeLog2 = 2,
    parameter integer ActivationBits = 16,
    parameter integer ActivationFraction = 15,
    parameter integer W2Bits = 16,
    parameter integer W2Fraction = 14,
    parameter integer B2Bits = 16,
    parameter integer B2Fraction = 17,
    parameter [23:0] ShotsPerFrame = 24'd30000,  // [shots]
    parameter [16:0] DrainCycles = 17'd16,       // see frame_ctrl
    // See vcsel_driver; RateBits is the width of laser_freq, PeriodBits that of a period less one
    parameter [16*8-1:0] LaserPeriods = {{5{16'd6}}, 16'd8, 16'd13, 16'd25},
    parameter integer RateBits = 2,
    parameter integer PeriodBits = 5,
    parameter integer PulseHalfCycles = 1,
    parameter integer Taps = 800,                // see tdc
    parameter integer CoarseBits = 3,
    parameter integer Cycle = 5120,              // see tdc_decoder
    parameter integer Digits = 4,
    parameter integer AgeBits = 14,
    parameter [0:0] Calibrated = 1'b0,           // the TDC's ages are those of tdc_calibration
    parameter integer HitsLog2 = 13,             // see tdc_calibration
    parameter [15:0] CalibrationFrames = 16'd1,
    parameter [63:0] YoungestAge = 64'd365363,
    parameter [63:0] EdgeAge = 64'd1310720,
    parameter [0:0] CodeSource = 1'b0,           // 0: tdc, 1: code_preload
    parameter [0:0] HistogramSource = 1'b0,      // 0: histogram_builder, 1: histogram_preload
    parameter [1:0] Estimator = 2'd0,            // 0: depth_estimator, 1: centroid_estimator, 2: likelihood_estimator
    parameter integer Neurons = 8,              // hidden neurons of depth_estimator, 1 to 32
    // See centroid_estimator
    parameter [4:0] HalfWidth = 5'd23,
    parameter [0:0] Background = 1'b1,
    parameter [16:0] Slope = 17'd62871,
    parameter signed [29:0] Offset = 30'sd0,
    // See likelihood_estimator
    parameter [23:0] LikelihoodShots = 24'd30000,
    parameter integer BoxBins = 15,
    parameter integer BinsBefore = 26,
    parameter integer BinsAfter = 26,
    parameter [31:0] Kappa = 32'd30751,
    parameter integer StepLog2 = 1,
    parameter [31:0] PulseSigma = 32'd351,
    parameter [31:0] WindowEnd = 32'd262328,
    parameter [31:0] Metres = 32'd16094985,
    parameter integer MetresShift = 13,
    parameter [31:0] LaserDelay = 32'd0,
    parameter integer GlassBins = 0,
    parameter [23:0] GlassLight = 24'd0,
    parameter GlassFile = "",
    parameter integer Targets = 1,
    parameter [0:0] Strongest = 1'b0,
    parameter integer InputHz = 200000000,       // see pll
    parameter integer Multiply = 5,
    parameter integer Divide = 1,
    parameter integer OutputDivide = 8,
    parameter [63:0] LockTime = 64'd1000000,
    // A host controls the firmware through registers, and laser_guard guards the laser; 0: the pins control it
    parameter [0:0] Hosted = 1'b0,
    parameter [63:0] Baud = 64'd921600,          // of uart_bridge [1/s]
    parameter [63:0] ParametersHash = 64'd0,     // see registers
    // See laser_guard
    parameter [31:0] HostTimeout = 32'd62500000,
    parameter [3:0] LongestPulse = 4'd1,
    parameter [15:0] ShortestPeriod = 16'd12,
    parameter integer Codes = 27756,             // words in CodeFile
    // Contents of ROMs, and the simulated chain's delays
    parameter W1File = "rtl_ref/w1.mem",
    parameter B1File = "rtl_ref/b1.mem",
    parameter W2File = "rtl_ref/w2.mem",
    parameter B2File = "rtl_ref/b2.mem",
    parameter TansigFile = "rtl_ref/tansig.mem",
    parameter CalFile = "rtl_ref/tdc_cal.mem",
    parameter DelaysFile = "rtl_ref/tap_delays.mem",
    parameter [1:0] CountStages = 2'd3,
    parameter [1:0] Decoder = 2'd0,              // see tdc_decoder
    parameter [16*Taps-1:0] Order = 0,
    parameter EdgesFile = "rtl_ref/edges.mem",
    parameter PulseFile = "rtl_ref/pulse.mem",
    parameter HazardFile = "rtl_ref/hazard.mem",
    parameter LogFile = "rtl_ref/log2.mem",
    parameter ProgramFile = "rtl_ref/solver.mem",
    parameter CodeFile = "rtl_ref/codes.mem",
    parameter HistogramFile = "rtl_ref/histogram.mem",
    // Highest number of column_stop, which has a bit more than it needs in a design of one column.
    parameter integer LastStop = Columns > 1 ? Columns - 1 : 1
) (
    // Board
    input wire clk_in,                // oscillator
    input wire rst,                   // reset button, asynchronous
    // It sets a register of laser_guard, and others take it at an edge.
    // verilator lint_off SYNCASYNCNET
    output wire locked,               // the clocks run
    // verilator lint_on SYNCASYNCNET
    // Laser
    output wire laser_on_lvds_p,      // positive pin
    output wire laser_on_lvds_n,      // negative pin
    // SPAD array
    input wire tdc_stop,              // output of the selected row's SPAD in column 0, asynchronous
    // verilator lint_off UNUSEDSIGNAL
    input wire [LastStop:1] column_stop,  // outputs of the others, by column, asynchronous
    // verilator lint_on UNUSEDSIGNAL
    output wire ring_on,              // tdc_stop is to come from a ring oscillator, for a calibration
    output wire spad_rst,             // recharges the SPAD and keeps it off
    output wire [39:0] spad_sel,      // row, one-hot
    // Acquisition computer
    input wire mode,                  // SPAD quench mode, asynchronous
    input wire [RateBits-1:0] laser_freq,  // laser repetition rate, asynchronous
    input wire laser_en,              // lets the laser fire, asynchronous
    input wire dsp_en,                // lets the estimator start, asynchronous
    input wire dsp_rst,               // abandons the frame, asynchronous
    // Host
    input wire uart_rx,               // from it, asynchronous
    output wire uart_tx,              // to it
    output wire armed,                // the laser may fire
    input wire interlock,             // the laser's interlock is open, asynchronous
    input wire select_pins,           // the control pins are in force, and not the registers, asynchronous
    output wire signed [35:0] depth,  // from algo_done until the next one [2^-29 m]
    output wire [35:0] sigma,         // its standard deviation, from likelihood_estimator only [2^-29 m]
    output wire [6:0] status,         // why not to believe it; likewise
    output wire valid,                // the status says nothing against it; likewise
    output wire algo_done,            // the depth is ready; one cycle
    output wire signed [35:0] second_depth,  // of the second target, 0 without one [2^-29 m]
    output wire [35:0] second_sigma,  // its standard deviation [2^-29 m]
    output wire [23:0] second_strength,  // its signal, photons a shot [2^-14]
    output wire [6:0] second_status,  // why not to believe it
    output wire second_valid,         // there is one, and its status says nothing against it
    output wire hist_valid,           // a word of the histogram is being read
    output wire [BinBits-1:0] hist_bin,  // which word
    output wire [CountBits-1:0] hist_count,  // the word [hits]
    output wire frame_done,           // the frame has ended; one cycle
    output wire [5:0] depth_row,      // row of the depth, while algo_done is high
    output wire [5:0] depth_column    // its column
);
    wire clk_sys, clk_laser;
    wire rst_sys, rst_laser;
    wire mode_sync, laser_en_sync, dsp_en_sync, dsp_rst_sync;
    wire [RateBits-1:0] laser_freq_sync;
    wire clear;
    wire [BinBits-1:0] clear_addr;
    wire acquire, algo_start;
    wire pre_start, start, laser_on;
    wire read_en;
    wire [BinBits-1:0] read_addr;

    // Modules that a source leaves out stay in place, with constant inputs: a generate block would
    // put its own scope into their paths. Synthesis removes them, but for the carry chain.
    wire [BinBits-1:0] tdc_code, measured_code, preloaded_code;
    wire tdc_valid, measured_valid, preloaded_valid;
    wire [CountBits-1:0] count, built_count, preloaded_count;

    assign tdc_code = CodeSource ? preloaded_code : measured_code;
    assign tdc_valid = CodeSource ? preloaded_valid : measured_valid;
    assign count = HistogramSource ? preloaded_count : built_count;

    // Each histogram shows zero but for the one that is read.
    wire bank;
    wire [5:0] row;
    wire [2*CountBits*Columns-1:0] shown;
    reg [CountBits-1:0] any_shown;
    integer k;
    always @* begin
        any_shown = {CountBits{1'b0}};
        for (k = 0; k < 2 * Columns; k = k + 1) any_shown = any_shown | shown[k*CountBits+:CountBits];
    end
    assign built_count = any_shown;

    wire signed [35:0] network_depth, centroid_depth, likelihood_depth;
    wire network_done, network_read_en, centroid_done, centroid_read_en, likelihood_done, likelihood_read_en;
    wire [35:0] likelihood_sigma;
    wire [6:0] likelihood_status;
    wire [3:0] likelihood_code;
    wire likelihood_valid, likelihood_second_valid;
    wire signed [35:0] likelihood_second_depth;
    wire [35:0] likelihood_second_sigma;
    wire [23:0] likelihood_second_strength;
    wire [6:0] likelihood_second_status;
    wire [BinBits-1:0] network_read_addr, centroid_read_addr, likelihood_read_addr;
    localparam [0:0] Centroid = Estimator == 2'd1, Likelihood = Estimator == 2'd2;

    assign read_en = Likelihood ? likelihood_read_en : Centroid ? centroid_read_en : network_read_en;
    assign read_addr = Likelihood ? likelihood_read_addr : Centroid ? centroid_read_addr : network_read_addr;
    assign depth = Likelihood ? likelihood_depth : Centroid ? centroid_depth : network_depth;
    assign algo_done = Likelihood ? likelihood_done : Centroid ? centroid_done : network_done;
    // 0 with the others, so that synthesis removes a likelihood estimator that is not in use.
    assign sigma = Likelihood ? likelihood_sigma : 36'd0;
    assign status = Likelihood ? likelihood_status : 7'd0;
    assign valid = Likelihood && likelihood_valid;
    wire [3:0] code = Likelihood ? likelihood_code : 4'd0;
    assign second_depth = Likelihood ? likelihood_second_depth : 36'sd0;
    assign second_sigma = Likelihood ? likelihood_second_sigma : 36'd0;
    assign second_strength = Likelihood ? likelihood_second_strength : 24'd0;
    assign second_status = Likelihood ? likelihood_second_status : 7'd0;
    assign second_valid = Likelihood && likelihood_second_valid;

    // Nothing of it stays where the TDC has its ages from a ROM.
    wire calibrating, rings, n_valid;
    wire [$clog2(Taps+1)-1:0] n;
    wire [AgeBits-1:0] calibrated_age;
    assign ring_on = Calibrated && rings || Hosted && host_ring_on;

    // Nothing of them stays without a host.
    localparam integer Halves = PulseHalfCycles > 1 ? 2 : 1;
    localparam [63:0] SystemHz = 64'd1 * InputHz * Multiply / (64'd1 * Divide * OutputDivide);
    localparam [63:0] BitCycles = (SystemHz + Baud / 64'd2) / Baud;
    localparam [63:0] TimeoutCycles = SystemHz / 64'd10;
    wire [31:0] address, write_data, read_data;
    wire write_en, heard, arm, disarm;
    wire pins_selected, interlock_sync;
    wire host_silent, unlocked, interlocked, pulse_too_long, rate_too_high;
    wire host_mode, host_laser_en, host_dsp_en, host_dsp_rst, host_ring_on;
    wire [RateBits-1:0] host_laser_freq;
    wire [Halves-1:0] laser_pulse, laser_block;
    wire laser_off;
    wire by_host = Hosted && !pins_selected;
    wire clk_host = clk_sys && Hosted, clk_host_laser = clk_laser && Hosted;

    // The acquisition computer's reset leaves the laser and the synchronisers alone.
    wire rst_dsp = rst_sys || dsp_rst_sync;

    assign hist_valid = read_en;
    assign hist_bin = read_addr;
    assign hist_count = count;

    pll #(
        .InputHz(InputHz),
        .Multiply(Multiply),
        .Divide(Divide),
        .OutputDivide(OutputDivide),
        .LockTime(LockTime)
    ) pll (
        .clk_in(clk_in),
        .clk_sys(clk_sys),
        .clk_laser(clk_laser),
        .locked(locked)
    );

    reset_sync reset_sync_sys (
        .clk(clk_sys),
        .rst(rst),
        .locked(locked),
        .rst_sync(rst_sys)
    );

    reset_sync reset_sync_laser (
        .clk(clk_laser),
        .rst(rst),
        .locked(locked),
        .rst_sync(rst_laser)
    );

    control_sync #(
        .RateBits(RateBits),
        .Hosted(Hosted)
    ) control_sync (
        .clk_sys(clk_sys),
        .mode(by_host ? host_mode : mode),
        .laser_freq(by_host ? host_laser_freq : laser_freq),
        .laser_en((by_host ? host_laser_en : laser_en) && (armed || !Hosted)),
        .dsp_en(by_host ? host_dsp_en : dsp_en),
        .dsp_rst(by_host ? host_dsp_rst : dsp_rst),
        .mode_sync(mode_sync),
        .laser_freq_sync(laser_freq_sync),
        .laser_en_sync(laser_en_sync),
        .dsp_en_sync(dsp_en_sync),
        .dsp_rst_sync(dsp_rst_sync)
    );

    frame_ctrl #(
        .BinBits(BinBits),
        .CountBits(CountBits),
        .ShotsPerFrame(ShotsPerFrame),
        .Preloaded(HistogramSource),
        .DrainCycles(DrainCycles),
        .Calibrated(Calibrated),
        .Rows(Rows),
        .Columns(Columns),
        .Banks(Banks)
    ) frame_ctrl (
        .clk_sys(clk_sys),
        .rst(rst_sys),
        .start(start),
        .acquire(acquire),
        .dsp_rst(dsp_rst_sync),
        .dsp_en(dsp_en_sync),
        .frame_done(frame_done),
        .calibrating(calibrating),
        .clear(clear),
        .clear_addr(clear_addr),
        .bank(bank),
        .depth_column(depth_column),
        .row(row),
        .depth_row(depth_row),
        .algo_start(algo_start),
        .algo_done(algo_done)
    );

    vcsel_driver #(
        .LaserPeriods(LaserPeriods),
        .RateBits(RateBits),
        .PeriodBits(PeriodBits),
        .PulseHalfCycles(PulseHalfCycles),
        .Hosted(Hosted)
    ) vcsel_driver (
        .clk_sys(clk_sys),
        .clk_laser(clk_laser),
        .rst(rst_sys),
        .rst_laser(rst_laser),
        .acquire(acquire),
        .laser_en(laser_en_sync),
        .laser_freq(laser_freq_sync),
        .laser_off(laser_off),
        .laser_block(laser_block),
        .laser_pulse(laser_pulse),
        .pre_start(pre_start),
        .start(start),
        .laser_on(laser_on)
    );

    lvds_output lvds_output (
        .i(laser_on),
        .o(laser_on_lvds_p),
        .ob(laser_on_lvds_n)
    );

    spad_control #(
        .Rows(Rows)
    ) spad_control (
        .clk_sys(clk_sys),
        .rst(rst_sys),
        .mode(mode_sync),
        .pre_start(pre_start),
        .row(row),
        .spad_rst(spad_rst),
        .spad_sel(spad_sel)
    );

    tdc #(
        .Taps(Taps),
        .CoarseBits(CoarseBits),
        .BinBits(BinBits),
        .Cycle(Cycle),
        .Digits(Digits),
        .AgeBits(AgeBits),
        .DelaysFile(DelaysFile),
        .CountStages(CountStages),
        .Decoder(Decoder),
        .Calibrated(Calibrated),
        .Hosted(Hosted),
        .Order(Order),
        .CalFile(CalFile)
    ) tdc (
        .clk_sys(clk_sys),
        .rst(rst_dsp),
        .start(start && !CodeSource),
        .tdc_stop(tdc_stop && !CodeSource),
        .free(rings || Hosted && host_ring_on),
        .calibrated_age(calibrated_age),
        .n_valid(n_valid),
        .n(n),
        .tdc_code(measured_code),
        .tdc_valid(measured_valid)
    );

    tdc_calibration #(
        .Taps(Taps),
        .AgeBits(AgeBits),
        .Cycle(Cycle),
        .HitsLog2(HitsLog2),
        .CalibrationFrames(CalibrationFrames),
        .YoungestAge(YoungestAge),
        .EdgeAge(EdgeAge)
    ) tdc_calibration (
        .clk_sys(clk_sys),
        .rst(rst_dsp),
        .clear(clear && Calibrated),
        .frame_done(frame_done && Calibrated),
        .calibrating(calibrating),
        .ring_on(rings),
        .n_valid(n_valid && Calibrated),
        .n(n),
        .calibrated_age(calibrated_age)
    );

    code_preload #(
        .BinBits(BinBits),
        .Codes(Codes),
        .CodeFile(CodeFile)
    ) code_preload (
        .clk_sys(clk_sys),
        .rst(rst_dsp),
        .start(start && CodeSource),
        .tdc_valid(preloaded_valid),
        .tdc_code(preloaded_code)
    );

    histogram_builder #(
        .BinBits(BinBits),
        .CountBits(CountBits),
        .Columns(Columns),
        .Banks(Banks)
    ) histogram_builder (
        .clk_sys(clk_sys),
        .clear(clear && !HistogramSource),
        .clear_addr(clear_addr),
        .bank(bank),
        .depth_column(depth_column),
        .tdc_valid(tdc_valid && !HistogramSource),
        .tdc_code(tdc_code),
        .read_en(read_en && !HistogramSource),
        .read_addr(read_addr),
        .count(shown[0+:CountBits])
    );

    // Nothing of it stays in a design of one bank.
    localparam [0:0] Banked = Banks > 1;
    histogram_builder #(
        .BinBits(BinBits),
        .CountBits(CountBits),
        .Columns(Columns),
        .Banks(Banks),
        .Bank(1'b1)
    ) second_bank (
        .clk_sys(clk_sys),
        .clear(clear && Banked),
        .clear_addr(clear_addr),
        .bank(bank),
        .depth_column(depth_column),
        .tdc_valid(tdc_valid && Banked),
        .tdc_code(tdc_code),
        .read_en(read_en && Banked),
        .read_addr(read_addr),
        .count(shown[CountBits+:CountBits])
    );

    // The other columns of the array, each with a TDC of its own.
    genvar c, b;
    generate
        for (c = 1; c < Columns; c = c + 1) begin : channel
            wire code_valid;
            // Of the column's TDC; the top's is that of the status.
            // verilator lint_off VARHIDDEN
            wire [BinBits-1:0] code;
            // verilator lint_on VARHIDDEN
            localparam [7:0] Tens = 8'd48 + c / 10, Units = 8'd48 + c % 10;
            localparam [23:0] Number = {8'd46, Tens, Units};
            if (Banks == 1) assign shown[(2*c+1)*CountBits+:CountBits] = {CountBits{1'b0}};

            tdc #(
                .Taps(Taps),
                .CoarseBits(CoarseBits),
                .BinBits(BinBits),
                .Cycle(Cycle),
                .Digits(Digits),
                .AgeBits(AgeBits),
                .DelaysFile(OwnChains ? {DelaysFile, Number} : {24'd0, DelaysFile}),
                .CountStages(CountStages),
                .Decoder(Decoder),
                .Order(Order),
                .CalFile(OwnChains ? {CalFile, Number} : {24'd0, CalFile})
            ) tdc (
                .clk_sys(clk_sys),
                .rst(rst_dsp),
                .start(start),
                .tdc_stop(column_stop[c]),
                .free(1'b0),
                .calibrated_age({AgeBits{1'b0}}),
                // Only a calibration looks at it.
                // verilator lint_off PINCONNECTEMPTY
                .n_valid(),
                .n(),
                // verilator lint_on PINCONNECTEMPTY
                .tdc_code(code),
                .tdc_valid(code_valid)
            );

            for (b = 0; b < Banks; b = b + 1) begin : banks
                histogram_builder #(
                    .BinBits(BinBits),
                    .CountBits(CountBits),
                    .Columns(Columns),
                    .Banks(Banks),
                    .Column(c),
                    .Bank(b)
                ) histogram_builder (
                    .clk_sys(clk_sys),
                    .clear(clear),
                    .clear_addr(clear_addr),
                    .bank(bank),
                    .depth_column(depth_column),
                    .tdc_valid(code_valid),
                    .tdc_code(code),
                    .read_en(read_en),
                    .read_addr(read_addr),
                    .count(shown[(2*c+b)*CountBits+:CountBits])
                );
            end
        end
    endgenerate

    histogram_preload #(
        .BinBits(BinBits),
        .CountBits(CountBits),
        .HistogramFile(HistogramFile)
    ) histogram_preload (
        .read_addr(read_addr),
        .count(preloaded_count)
    );

    depth_estimator #(
        .BinBits(BinBits),
        .CountBits(CountBits),
        .SumBits(SumBits),
        .W1Bits(W1Bits),
        .W1Fraction(W1Fraction),
        .B1Bits(B1Bits),
        .B1Fraction(B1Fraction),
        .AddressBits(AddressBits),
        .RangeLog2(RangeLog2),
        .ActivationBits(ActivationBits),
        .ActivationFraction(ActivationFraction),
        .W2Bits(W2Bits),
        .W2Fraction(W2Fraction),
        .B2Bits(B2Bits),
        .B2Fraction(B2Fraction),
        .Neurons(Neurons),
        .W1File(W1File),
        .B1File(B1File),
        .W2File(W2File),
        .B2File(B2File),
        .TansigFile(TansigFile)
    ) depth_estimator (
        .clk_sys(clk_sys),
        .rst(rst_dsp),
        .algo_start(algo_start && !Centroid && !Likelihood),
        .read_en(network_read_en),
        .read_addr(network_read_addr),
        .count(count),
        .depth(network_depth),
        .algo_done(network_done)
    );

    centroid_estimator #(
        .BinBits(BinBits),
        .CountBits(CountBits),
        .HalfWidth(HalfWidth),
        .Background(Background),
        .Slope(Slope),
        .Offset(Offset)
    ) centroid_estimator (
        .clk_sys(clk_sys),
        .rst(rst_dsp),
        .algo_start(algo_start && Centroid),
        .read_en(centroid_read_en),
        .read_addr(centroid_read_addr),
        .count(count),
        .depth(centroid_depth),
        .algo_done(centroid_done)
    );

    likelihood_estimator #(
        .Used(Likelihood),
        .BinBits(BinBits),
        .CountBits(CountBits),
        .LikelihoodShots(LikelihoodShots),
        .BoxBins(BoxBins),
        .BinsBefore(BinsBefore),
        .BinsAfter(BinsAfter),
        .Kappa(Kappa),
        .StepLog2(StepLog2),
        .PulseSigma(PulseSigma),
        .WindowEnd(WindowEnd),
        .Metres(Metres),
        .MetresShift(MetresShift),
        .LaserDelay(LaserDelay),
        .Columns(Columns),
        .OwnChains(OwnChains),
        .GlassBins(GlassBins),
        .GlassLight(GlassLight),
        .GlassFile(GlassFile),
        .Targets(Targets),
        .Strongest(Strongest),
        .EdgesFile(EdgesFile),
        .PulseFile(PulseFile),
        .HazardFile(HazardFile),
        .LogFile(LogFile),
        .ProgramFile(ProgramFile)
    ) likelihood_estimator (
        .clk_sys(clk_sys),
        .rst(rst_dsp),
        .algo_start(algo_start && Likelihood),
        .mode(mode_sync),
        .depth_column(OwnChains ? depth_column : 6'd0),
        .read_en(likelihood_read_en),
        .read_addr(likelihood_read_addr),
        .count(count),
        .depth(likelihood_depth),
        .sigma(likelihood_sigma),
        .status(likelihood_status),
        // verilator lint_off PINCONNECTEMPTY
        .chi_square(),
        // verilator lint_on PINCONNECTEMPTY
        .valid(likelihood_valid),
        .code(likelihood_code),
        .algo_done(likelihood_done),
        .second_depth(likelihood_second_depth),
        .second_sigma(likelihood_second_sigma),
        .second_strength(likelihood_second_strength),
        .second_status(likelihood_second_status),
        .second_valid(likelihood_second_valid)
    );

    uart_bridge #(
        .BitCycles(BitCycles[15:0]),
        .TimeoutCycles(TimeoutCycles[31:0])
    ) uart_bridge (
        .clk_sys(clk_host),
        .rst(rst_sys),
        .uart_rx(uart_rx),
        .uart_tx(uart_tx),
        .read_data(read_data),
        .address(address),
        .write_en(write_en),
        .write_data(write_data),
        .heard(heard)
    );

    registers #(
        .ParametersHash(ParametersHash),
        .SystemHz(SystemHz[31:0]),
        .HostTimeout(HostTimeout),
        .BinBits(BinBits),
        .CountBits(CountBits),
        .RateBits(RateBits),
        .Taps(Taps)
    ) registers (
        .clk_sys(clk_host),
        .rst(rst_sys),
        .address(address),
        .write_en(write_en),
        .write_data(write_data),
        .read_data(read_data),
        .pins_selected(pins_selected),
        .armed(armed),
        .interlock_sync(interlock_sync),
        .host_silent(host_silent),
        .unlocked(unlocked),
        .interlocked(interlocked),
        .pulse_too_long(pulse_too_long),
        .rate_too_high(rate_too_high),
        .arm(arm),
        .disarm(disarm),
        .start(start),
        .tdc_valid(tdc_valid),
        .n_valid(n_valid),
        .n(n),
        .calibrating(calibrating),
        .acquire(acquire),
        .hist_valid(read_en),
        .hist_bin(read_addr),
        .hist_count(count),
        .frame_done(frame_done),
        .depth(depth),
        .sigma(sigma),
        .status(status),
        .valid(valid),
        .code(code),
        .host_mode(host_mode),
        .host_laser_freq(host_laser_freq),
        .host_laser_en(host_laser_en),
        .host_dsp_en(host_dsp_en),
        .host_dsp_rst(host_dsp_rst),
        .host_ring_on(host_ring_on)
    );

    laser_guard #(
        .Halves(Halves),
        .HostTimeout(HostTimeout),
        .LongestPulse(LongestPulse),
        .ShortestPeriod(ShortestPeriod)
    ) laser_guard (
        .clk_sys(clk_host),
        .clk_laser(clk_host_laser),
        .rst(rst_sys),
        .rst_laser(rst_laser),
        .locked(locked),
        .interlock(interlock && Hosted),
        .select_pins(select_pins),
        .laser_en(laser_en),
        .heard(heard),
        .arm(arm),
        .disarm(disarm),
        .laser_pulse(laser_pulse),
        .laser_block(laser_block),
        .laser_off(laser_off),
        .armed(armed),
        .pins_selected(pins_selected),
        .interlock_sync(interlock_sync),
        .host_silent(host_silent),
        .unlocked(unlocked),
        .interlocked(interlocked),
        .pulse_too_long(pulse_too_long),
        .rate_too_high(rate_too_high)
    );
endmodule
