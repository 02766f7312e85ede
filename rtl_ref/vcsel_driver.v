`timescale 1ps / 1fs
`default_nettype none

// Fires the laser at one of a few rates. A pulse passes through three registers of clk_laser on its way
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
//   laser_on     ______________/^\___    half a cycle of clk_laser, or longer
module vcsel_driver #(
    // For each laser_freq [cycles of clk_sys]
    parameter [16*8-1:0] LaserPeriods = {{5{16'd6}}, 16'd8, 16'd13, 16'd25},
    parameter integer RateBits = 2,
    parameter integer PeriodBits = 5,
    parameter integer PulseHalfCycles = 1, // length of the pulse [half cycles of clk_laser], 1 to 8
    parameter [0:0] Hosted = 1'b0          // see ddr_output
) (
    input wire clk_sys,
    input wire clk_laser,
    input wire rst,               // of clk_sys
    input wire rst_laser,           // of clk_laser
    // frame_ctrl and the acquisition computer
    input wire acquire,           // lets the counter run
    input wire laser_en,          // lets the laser fire
    input wire [RateBits-1:0] laser_freq,  // repetition rate
    // laser_guard, see ddr_output
    input wire laser_off,
    input wire [(PulseHalfCycles > 1 ? 2 : 1)-1:0] laser_block,
    // Enables of the output register, for either half of its cycle; from the cycle of clk_laser before the
    // laser edge on
    output reg [(PulseHalfCycles > 1 ? 2 : 1)-1:0] laser_pulse,
    // The shot
    output reg pre_start,         // two cycles before the laser edge; one cycle
    output reg start,             // from the laser edge on; one cycle
    output wire laser_on          // the output
);
    // Of the pulse: whether it is odd, cycles of clk_laser that it goes on for, enables in each.
    localparam [0:0] Odd = PulseHalfCycles % 2 == 1;
    localparam integer Longer = (PulseHalfCycles - 1) / 2, Kept = Longer > 0 ? Longer : 1;
    // A period has four cycles or more, so its last count two bits.
    localparam [PeriodBits-1:0] Two = {{PeriodBits - 1{1'b0}}, 1'b1} << 1;
    localparam integer Halves = PulseHalfCycles > 1 ? 2 : 1;

    reg fire;          // asks clk_laser for a pulse; two cycles before the laser edge
    reg [PeriodBits-1:0] count;  // place in the period
    reg [PeriodBits-1:0] last;   // the period in force, less one [cycles of clk_sys]
    reg enable;        // the laser_en in force
    reg fire_last;     // fire at the edge before
    reg pulse_0;       // laser_pulse on its way
    reg pulse_1;
    reg [Kept-1:0] stretch;  // pulse_1 in the cycles before

    reg pre_start_next, start_next, fire_next, enable_next, pulse_0_next;
    reg [PeriodBits-1:0] count_next, last_next;
    reg [PeriodBits-1:0] last_of_freq;

    initial begin
        {pre_start, start, fire, enable} = 4'd0;
        {fire_last, pulse_0, pulse_1} = 3'd0;
        laser_pulse = {Halves{1'b0}};
        stretch = {Kept{1'b0}};
        {count, last} = {2 * PeriodBits{1'b0}};
    end

    integer rate;
    always @* begin
        last_of_freq = LaserPeriods[0 +: PeriodBits] - 1'b1;
        for (rate = 1; rate < 1 << RateBits; rate = rate + 1)
            if (laser_freq == rate[RateBits-1:0]) last_of_freq = LaserPeriods[16*rate +: PeriodBits] - 1'b1;
        pre_start_next = acquire && count + Two == last;
        fire_next = pre_start_next && enable;
        start_next = acquire && count == last;
        count_next = count + 1'b1;
        last_next = last;
        enable_next = enable;
        if (!acquire || count == last) begin
            count_next = {PeriodBits{1'b0}};
            last_next = last_of_freq;
            enable_next = laser_en;
        end
        // fire lasts two cycles of clk_laser; only the first edge in it makes a pulse.
        pulse_0_next = fire && !fire_last;
    end

    // Past pulse_1 go as many cycles as the pulse has more than one; an odd length has no second half in
    // the last.
    wire [Kept:0] cycles = {stretch, pulse_1};
    wire drives = |cycles;
    wire [Kept-1:0] stretch_next = Longer > 0 ? cycles[Kept-1:0] : {Kept{1'b0}};
    wire [Halves-1:0] laser_pulse_next;
    generate
        if (Halves == 1) begin : half_a_cycle
            assign laser_pulse_next = drives;
        end else begin : longer
            assign laser_pulse_next = {drives && !(Odd && cycles[Kept]), drives};
        end
    endgenerate

    always @(posedge clk_sys) begin
        if (rst) begin
            pre_start <= 1'b0;
            start <= 1'b0;
            fire <= 1'b0;
            count <= {PeriodBits{1'b0}};
            last <= {PeriodBits{1'b0}};
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
            laser_pulse <= {Halves{1'b0}};
            stretch <= {Kept{1'b0}};
        end else begin
            pulse_0 <= pulse_0_next;
            pulse_1 <= pulse_0;
            laser_pulse <= laser_pulse_next;
            stretch <= stretch_next;
        end
    end

    ddr_output #(
        .Halves(Halves),
        .Hosted(Hosted)
    ) ddr_output (
        .clk_laser(clk_laser),
        .d(laser_pulse),
        .off(laser_off),
        .block(laser_block),
        .q(laser_on)
    );
endmodule
