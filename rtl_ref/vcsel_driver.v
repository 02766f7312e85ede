`timescale 1ps / 1fs
`default_nettype none

// Fires the laser at one of four rates. A pulse passes through three registers of clk_laser on its way
// across the device, so that each leg has a cycle; once fire has asked for it, only rst_laser stops it,
// and never moves it.
//
//   clk_sys      __/^^\__/^^\__/^^\__
//   edge          s-2   s-1    s         s: the laser edge
//   pre_start    __/^^^^^\___________
//   fire         __/^^^^^\___________
//   pulse_0      _____/^^\___________    clk_laser
//   pulse_1      ________/^^\________
//   laser_pulse  ___________/^^\_____
//   start        ______________/^^^^^
//   laser_on     ______________/^\___    2 ns
module vcsel_driver (
    input wire clk_sys,
    input wire clk_laser,
    input wire rst,               // of clk_sys
    input wire rst_laser,           // of clk_laser
    // frame_ctrl and the acquisition computer
    input wire acquire,           // lets the counter run
    input wire laser_en,          // lets the laser fire
    input wire [1:0] laser_freq,  // repetition rate
    // The shot
    output reg pre_start,         // two cycles before the laser edge; one cycle
    output reg start,             // from the laser edge on; one cycle
    output wire laser_on          // the output
);
    reg fire;          // asks clk_laser for a pulse; two cycles before the laser edge
    reg [4:0] count;   // place in the period
    reg [4:0] last;    // the period in force, less one [cycles of clk_sys]
    reg enable;        // the laser_en in force
    reg fire_last;     // fire at the edge before
    reg pulse_0;       // laser_pulse on its way
    reg pulse_1;
    reg laser_pulse;   // enable of the output register; the cycle of clk_laser before the laser edge

    reg pre_start_next, start_next, fire_next, enable_next, pulse_0_next;
    reg [4:0] count_next, last_next;
    reg [4:0] last_of_freq;

    initial begin
        {pre_start, start, fire, enable} = 4'd0;
        {fire_last, pulse_0, pulse_1, laser_pulse} = 4'd0;
        {count, last} = 10'd0;
    end

    always @* begin
        case (laser_freq)
            2'd0: last_of_freq = 5'd24;
            2'd1: last_of_freq = 5'd12;
            2'd2: last_of_freq = 5'd7;
            default: last_of_freq = 5'd5;
        endcase
        pre_start_next = acquire && count + 5'd2 == last;
        fire_next = pre_start_next && enable;
        start_next = acquire && count == last;
        count_next = count + 5'd1;
        last_next = last;
        enable_next = enable;
        if (!acquire || count == last) begin
            count_next = 5'd0;
            last_next = last_of_freq;
            enable_next = laser_en;
        end
        // fire lasts two cycles of clk_laser; only the first edge in it makes a pulse.
        pulse_0_next = fire && !fire_last;
    end

    always @(posedge clk_sys) begin
        if (rst) begin
            pre_start <= 1'b0;
            start <= 1'b0;
            fire <= 1'b0;
            count <= 5'd0;
            last <= 5'd0;
            enable <= 1'b0;
        end else begin
            pre_start <= pre_start_next;
            start <= start_next;
            fire <= fire_next;
            count <= count_next;
            last <= last_next;
            enable <= enable_next;
        end
    end

    always @(posedge clk_laser) begin
        fire_last <= fire;
        if (rst_laser) begin
            pulse_0 <= 1'b0;
            pulse_1 <= 1'b0;
            laser_pulse <= 1'b0;
        end else begin
            pulse_0 <= pulse_0_next;
            pulse_1 <= pulse_0;
            laser_pulse <= pulse_1;
        end
    end

    ddr_output ddr_output (
        .clk_laser(clk_laser),
        .d(laser_pulse),
        .q(laser_on)
    );
endmodule
