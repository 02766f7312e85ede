`timescale 1ps / 1fs
`default_nettype none

// A board's top compiled for synthesis (macro KC705 or ECP5, and SYNTHESIS), or tof_top as it is simulated, under random
// control and photons. It prints each change of an output: the tops have to print the same.
module bench;
    // From the first edge of the clocks on [ps], a quarter of a cycle apart.
    localparam integer Begin = 1008000, Quarter = 2000, Cycles = 5000;

    reg clk_in, rst, tdc_stop, mode, laser_en, dsp_en, dsp_rst, uart_rx, interlock;
    reg [1:0] laser_freq;
    wire locked, laser_on_lvds_p, laser_on_lvds_n, spad_rst, algo_done, hist_valid, frame_done;
    wire [39:0] spad_sel;
    wire [35:0] depth, sigma;
    wire [6:0] status;
    wire valid, uart_tx, armed;
    wire [7:0] hist_bin;
    wire [15:0] hist_count;

`ifdef KC705
    kc705_top top (
        .sysclk_p(clk_in),
        .sysclk_n(!clk_in),
        .cpu_reset(rst),
        .locked(locked),
        .armed(armed),
        .select_pins(1'b1),
        .laser_on_lvds_n(laser_on_lvds_n),
        .sigma(sigma),
        .status(status),
        .valid(valid),
`elsif ECP5
    wire locked_n, clk_in_en, armed_n;

    // It has no pins for them. They belong to an estimator that this design does not have.
    assign {sigma, status, valid} = 44'd0;
    assign locked = !locked_n;
    assign armed = !armed_n;
    assign laser_on_lvds_n = !laser_on_lvds_p;
    ecp5_top top (
        .clk_in(clk_in && clk_in_en),
        .clk_in_en(clk_in_en),
        .reset_n(!rst),
        .locked_n(locked_n),
        .armed_n(armed_n),
        .select_pins_n(1'b0),
`else
    tof_top #(
        .DelaysFile("delays.mem"),
        .CalFile("cal.mem"),
        .Taps(64),
        .Hosted(1'b1),
        .Baud(64'd15625000),
        .ShotsPerFrame(24'd8)
    ) top (
        .clk_in(clk_in),
        .rst(rst),
        .locked(locked),
        .armed(armed),
        .select_pins(1'b1),
        .laser_on_lvds_n(laser_on_lvds_n),
        .sigma(sigma),
        .status(status),
        .valid(valid),
`endif
        .uart_rx(uart_rx),
        .uart_tx(uart_tx),
        .interlock(interlock),
        .laser_on_lvds_p(laser_on_lvds_p),
        .tdc_stop(tdc_stop),
        .spad_rst(spad_rst),
        .spad_sel(spad_sel),
        .mode(mode),
        .laser_freq(laser_freq),
        .laser_en(laser_en),
        .dsp_en(dsp_en),
        .dsp_rst(dsp_rst),
        .depth(depth),
        .algo_done(algo_done),
        .hist_valid(hist_valid),
        .hist_bin(hist_bin),
        .hist_count(hist_count),
        .frame_done(frame_done)
    );
`ifdef SYNTHESIS
    // A calibration would wait for the ring.
    defparam top.Calibrated = 1'b0;
    defparam top.tof_top.Baud = 64'd15625000;
    // A short chain of long taps: Icarus copies all of it when one tap changes.
    defparam top.tof_top.CalFile = "cal.mem";
    defparam top.tof_top.Taps = 64;
    defparam top.tof_top.ShotsPerFrame = 24'd8;
`endif

    // The oscillator rises with the clocks every 40 ns.
    initial begin
        clk_in = 1'b0;
        #5000;
        forever begin
            clk_in = 1'b1;
            #2500 clk_in = 1'b0;
            #2500;
        end
    end

    // Control changes a quarter of a nanosecond past a quarter of a cycle.
    integer seed, pause;
    initial begin
        seed = 1;
        {mode, dsp_rst, interlock} = 3'd0;
        {laser_en, dsp_en, laser_freq} = 4'b1111;
        // The clocks of a board run before they have locked: from here on both do the same.
        rst = 1'b1;
        #(Begin + 4 * 20 * Quarter + 250) rst = 1'b0;
        #(4 * 1380 * Quarter);
        forever begin
            pause = 1 + $unsigned($random(seed)) % 1500;
            #(pause * Quarter);
            case ($unsigned($random(seed)) % 12)
                0: laser_en = !laser_en;
                1, 2: dsp_en = !dsp_en;
                3: mode = !mode;
                4: dsp_rst = 1'b1;
                5: rst = 1'b1;
                6: interlock = 1'b1;
                7: laser_en = 1'b0;
                default: laser_freq = $random(seed);
            endcase
            #(9 * Quarter);
            {rst, dsp_rst, interlock} = 3'b000;
            if ($unsigned($random(seed)) % 3 == 0) {laser_en, dsp_en} = 2'b11;
            if (!armed) begin
                laser_en = 1'b0;
                #(12 * Quarter) laser_en = 1'b1;
            end
        end
    end

    // A host reads the identity and the scratch register, again and again, at eight cycles a bit.
    localparam [95:0] Commands = 96'h020100000000_020100000006;
    integer bit_place;
    initial begin
        uart_rx = 1'b1;
        #(Begin + 4 * 40 * Quarter + 250);
        forever begin
            for (bit_place = 0; bit_place < 240; bit_place = bit_place + 1) begin
                // Twelve bytes of ten bits, and a pause as long for the answers.
                uart_rx = bit_place >= 120 || bit_place % 10 == 9 ||
                    bit_place % 10 != 0 && Commands[95 - 8 * (bit_place / 10) - 8 + bit_place % 10];
                #(8 * 4 * Quarter);
            end
        end
    end

    // Photons never come such that a tap is reached at an edge.
    integer photons, wait_ps;
    initial begin
        photons = 2;
        tdc_stop = 1'b0;
        #0.1;
        forever begin
            wait_ps = 500 + $unsigned($random(photons)) % (tdc_stop ? 9000 : 40000);
            #(wait_ps);
            tdc_stop = !tdc_stop;
        end
    end

    integer quarter;
    reg [153:0] now, before;
    initial begin
        before = {154{1'bx}};
        #(Begin - 1);
        for (quarter = 0; quarter < 4 * Cycles; quarter = quarter + 1) begin
            now = {locked, laser_on_lvds_p, laser_on_lvds_n, spad_rst, spad_sel, depth, sigma, status, valid, algo_done,
                   hist_valid, hist_bin, hist_count, frame_done, uart_tx, armed};
            if (now !== before) $display("quarter %0d: locked %b laser %b%b spad %b %h depth %h %h %h %b %b hist %b %h %h done %b uart %b armed %b",
                quarter, locked, laser_on_lvds_p, laser_on_lvds_n, spad_rst, spad_sel, depth, sigma, status, valid,
                algo_done, hist_valid, hist_bin, hist_count, frame_done, uart_tx, armed);
            before = now;
            #(Quarter);
        end
        $finish;
    end
endmodule
