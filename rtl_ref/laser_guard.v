`timescale 1ps / 1fs
`default_nettype none

// Keeps the laser off until it is armed, and switches it off for good
//
//   host_silent     when the host in control has completed no command for HostTimeout
//   unlocked        when the PLL loses its lock: at once, without a clock
//   interlocked     when the interlock is open: likewise
//   pulse_too_long  when a pulse would be longer than LongestPulse; its rest is not emitted
//   rate_too_high   when a pulse would come sooner than ShortestPeriod after the one before; it is not emitted
//
// until it is armed again. The host arms it through the registers; with the switch at the control pins, a rise of
// laser_en does. What comes of laser_block and laser_off is in ddr_output, the laser's last register.
module laser_guard #(
    parameter integer Halves = 1,                   // see ddr_output
    parameter [31:0] HostTimeout = 32'd62500000,    // [cycles of clk_sys]
    parameter [3:0] LongestPulse = 4'd1,            // 1 to 8 [half cycles of clk_laser]
    parameter [15:0] ShortestPeriod = 16'd12        // from a begin to the next [cycles of clk_laser]
) (
    input wire clk_sys,
    input wire clk_laser,
    input wire rst,                 // of clk_sys
    input wire rst_laser,           // of clk_laser
    // Board, asynchronous
    input wire locked,              // the PLL has locked
    // It sets a register, and its level is shown too.
    // verilator lint_off SYNCASYNCNET
    input wire interlock,           // the interlock is open
    // verilator lint_on SYNCASYNCNET
    input wire select_pins,         // the switch selects the control pins
    input wire laser_en,            // of the pins
    // Host
    input wire heard,               // a command is complete; one cycle
    input wire arm,                 // arms the laser; one cycle
    input wire disarm,              // disarms it; one cycle
    // vcsel_driver
    input wire [Halves-1:0] laser_pulse,  // enables of the output register, in clk_laser
    output reg [Halves-1:0] laser_block,  // those that do not pass
    output reg laser_off,           // the output is low, whatever the clocks do
    // registers
    output reg armed,
    output reg pins_selected,       // select_pins in clk_sys
    output reg interlock_sync,      // interlock in clk_sys
    output reg host_silent,         // why the laser went off
    output reg unlocked,
    output reg interlocked,
    output reg pulse_too_long,
    output reg rate_too_high
);
    // Arming takes so many cycles: by then it is known whether the PLL or the interlock still prevents it.
    localparam [2:0] Arming = 3'd4;

    (* ASYNC_REG = "TRUE" *) reg select_pins_meta;
    (* ASYNC_REG = "TRUE" *) reg laser_en_meta;
    (* ASYNC_REG = "TRUE" *) reg laser_en_sync;
    (* ASYNC_REG = "TRUE" *) reg interlock_meta;
    (* ASYNC_REG = "TRUE" *) reg cut_meta;
    (* ASYNC_REG = "TRUE" *) reg cut_sync;     // unlocked or interlocked
    reg laser_en_last;
    reg [2:0] arming;           // cycles until the laser is armed
    reg [31:0] silence;         // since the last command [cycles of clk_sys]
    // Of clk_laser
    reg armed_last;             // armed at the edge before
    reg checks;                 // pulses are checked: laser_block has had time to open
    reg [3:0] run;              // how long the output has been high without a break [half cycles]
    reg [15:0] gap;             // until a pulse may begin [cycles of clk_laser]
    reg gap_lasts;              // it is above 1
    reg too_long;               // a pulse would have been too long
    reg too_soon;               // it would have come too soon

    wire arms = pins_selected ? laser_en_sync && !laser_en_last : arm;
    wire disarms = pins_selected ? !laser_en_sync : disarm;
    wire is_silent = !pins_selected && armed && silence >= HostTimeout;
    wire trips = cut_sync || is_silent || too_long || too_soon;
    wire cut = !locked || interlock;

    // What passes, and what stands in the way of it in the next cycle.
    wire first = laser_pulse[0], second = Halves > 1 && laser_pulse[Halves-1];
    wire first_blocked = laser_block[0], second_blocked = laser_block[Halves-1];
    wire first_passes = first && !first_blocked, second_passes = second && !second_blocked && first_passes;
    wire begins = first_passes && run == 4'd0;
    reg [3:0] run_next;
    reg [15:0] gap_next;
    reg gap_lasts_next;
    reg blocks_first, blocks_second;

    always @* begin
        run_next = 4'd0;
        if (second_passes) run_next = run + 4'd2;
        gap_next = gap == 16'd0 ? 16'd0 : gap - 16'd1;
        gap_lasts_next = gap > 16'd2;
        if (begins) begin
            gap_next = ShortestPeriod - 16'd1;
            gap_lasts_next = ShortestPeriod > 16'd2;
        end
        blocks_first = !armed || !armed_last || run_next >= LongestPulse;
        if (run_next == 4'd0 && (begins ? ShortestPeriod > 16'd1 : gap_lasts)) blocks_first = 1'b1;
        blocks_second = blocks_first || run_next + 4'd1 >= LongestPulse;
    end

    initial begin
        {armed, pins_selected, interlock_sync, host_silent, pulse_too_long, rate_too_high} = 6'd0;
        // Registers of an ECP5 begin with what sets them.
        {unlocked, interlocked, laser_off} = 3'b111;
        {select_pins_meta, laser_en_meta, laser_en_sync, interlock_meta, cut_meta, cut_sync} = 6'd0;
        laser_en_last = 1'b1;
        {arming, silence} = 35'd0;
        laser_block = {Halves{1'b1}};
        {armed_last, checks, too_long, too_soon} = 4'd0;
        {run, gap, gap_lasts} = 21'd0;
    end

    always @(posedge clk_sys or posedge cut) begin
        if (cut) laser_off <= 1'b1;
        else laser_off <= !armed || trips || unlocked || interlocked;
    end

    always @(posedge clk_sys or negedge locked) begin
        if (!locked) unlocked <= 1'b1;
        else if (arms) unlocked <= 1'b0;
    end

    always @(posedge clk_sys or posedge interlock) begin
        if (interlock) interlocked <= 1'b1;
        else if (arms) interlocked <= 1'b0;
    end

    always @(posedge clk_sys) begin
        select_pins_meta <= select_pins;
        pins_selected <= select_pins_meta;
        laser_en_meta <= laser_en;
        laser_en_sync <= laser_en_meta;
        laser_en_last <= laser_en_sync;
        interlock_meta <= interlock;
        interlock_sync <= interlock_meta;
        cut_meta <= unlocked || interlocked;
        cut_sync <= cut_meta;
        silence <= heard || arms ? 32'd0 : silence + {31'd0, silence != 32'hffffffff};
        if (arms) {host_silent, pulse_too_long, rate_too_high} <= 3'd0;
        if (armed) begin
            if (is_silent) host_silent <= 1'b1;
            if (too_long) pulse_too_long <= 1'b1;
            if (too_soon) rate_too_high <= 1'b1;
        end
        arming <= arming == 3'd0 ? 3'd0 : arming - 3'd1;
        if (arming == 3'd1) armed <= !cut_sync;
        if (arms) {armed, arming} <= {1'b0, Arming};
        if (armed && trips) armed <= 1'b0;
        if (disarms) {armed, arming} <= 4'd0;
        // A laser_en that is high already does not arm.
        if (rst) {armed, arming, laser_en_last} <= 5'd1;
    end

    always @(posedge clk_laser) begin
        armed_last <= armed;
        checks <= armed_last && armed;
        laser_block[0] <= blocks_first;
        laser_block[Halves-1] <= Halves > 1 ? blocks_second : blocks_first;
        run <= run_next;
        gap <= gap_next;
        gap_lasts <= gap_lasts_next;
        if (!checks) {too_long, too_soon} <= 2'b00;
        else if (too_long || too_soon) ;  // the first of them is the reason
        else if (first && first_blocked) begin
            too_long <= run != 4'd0;
            too_soon <= run == 4'd0;
        end else if (second && !second_passes) begin
            too_long <= first;
            too_soon <= !first;
        end
        if (rst_laser) begin
            {armed_last, checks, too_long, too_soon} <= 4'd0;
            laser_block <= {Halves{1'b1}};
        end
    end
endmodule
