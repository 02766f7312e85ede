`timescale 1ps / 1fs
`default_nettype none

// Fires the laser at one of four rates. A pulse passes through three registers of clk_250 on its way
// across the device, so that each leg has a cycle; once fire has asked for it, only rst_250 stops it.
//
//   clk_125      __/^^\__/^^\__/^^\__
//   edge          s-2   s-1    s         s: the laser edge
//   pre_start    __/^^^^^\___________
//   fire         __/^^^^^\___________
//   pulse_0      _____/^^\___________    clk_250
//   pulse_1      ________/^^\________
//   laser_pulse  ___________/^^\_____
//   start        ______________/^^^^^
//   laser_on     ______________/^\___    2 ns
module vcsel_driver (
    input wire clk_125,
    input wire clk_250,
    input wire rst,               // of clk_125
    input wire rst_250,           // of clk_250
    // frame_ctrl and the acquisition computer
    input wire acquire,           // lets the counter run
    input wire laser_en,          // lets the laser fire
    input wire [1:0] laser_freq,  // repetition rate
    // The shot
    output reg pre_start,         // two cycles before the laser edge; one cycle
    output reg start,             // from the laser edge on; one cycle
    output wire laser_on          // the output
);
    reg fire;          // asks clk_250 for a pulse; two cycles before the laser edge
    reg [4:0] count;   // place in the period
    reg [4:0] last;    // the period in force, less one [cycles of clk_125]
    reg enable;        // the laser_en in force
    reg pulse_0;       // laser_pulse on its way
    reg pulse_1;
    reg laser_pulse;   // enable of the output register; the cycle of clk_250 before the laser edge

    reg pre_start_next, start_next, fire_next, enable_next, pulse_0_next;
    reg [4:0] count_next, last_next;
    reg [4:0] last_of_freq;

    initial begin
        {pre_start, start, fire, enable} = 4'd0;
        {pulse_0, pulse_1, laser_pulse} = 3'd0;
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
        // fire lasts two cycles of clk_250; only the first edge in it makes a pulse.
        pulse_0_next = fire && !pulse_0;
    end

    always @(posedge clk_125) begin
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

    always @(posedge clk_250) begin
        if (rst_250) begin
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
        .clk_250(clk_250),
        .d(laser_pulse),
        .q(laser_on)
    );
endmodule
