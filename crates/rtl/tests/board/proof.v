`default_nettype none

// What laser_guard promises, for a prover: whatever its inputs do, and when. A step is half a cycle of clk_laser, and both
// clocks rise together every fourth one.
module proof #(
    parameter integer Halves = 2,
    parameter [31:0] HostTimeout = 32'd5,
    parameter [3:0] LongestPulse = 4'd3,
    parameter [15:0] ShortestPeriod = 16'd6
) (
    input wire rst,
    input wire rst_laser,
    input wire locked,
    input wire interlock,
    input wire select_pins,
    input wire laser_en,
    input wire heard,
    input wire arm,
    input wire disarm,
    input wire [Halves-1:0] laser_pulse
);
    (* gclk *) wire step;
    reg [1:0] phase;
    initial phase = 2'd3;  // both clocks low
    always @(posedge step) phase <= phase + 2'd1;
    wire clk_laser = !phase[0], clk_sys = !phase[1];
    wire [Halves-1:0] laser_block;
    wire laser_off, armed, pins_selected, interlock_sync;
    wire host_silent, unlocked, interlocked, pulse_too_long, rate_too_high;

    // Registers inside.
    (* hierconn, init = 1'b0 *) wire \guard.laser_en_sync , \guard.armed_last ;
    (* hierconn, init = 16'd0 *) wire [15:0] \guard.gap ;
    (* hierconn, init = 32'd0 *) wire [31:0] \guard.silence ;

    laser_guard #(
        .Halves(Halves),
        .HostTimeout(HostTimeout),
        .LongestPulse(LongestPulse),
        .ShortestPeriod(ShortestPeriod)
    ) guard (
        .clk_sys(clk_sys),
        .clk_laser(clk_laser),
        .rst(rst),
        .rst_laser(rst_laser),
        .locked(locked),
        .interlock(interlock),
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

    // The output register, as ddr_output has it.
    reg [1:0] taken;
    initial taken = 2'b00;
    wire [Halves-1:0] unblocked = laser_pulse & ~laser_block;
    wire [1:0] passes = {Halves > 1 && unblocked[Halves-1] && unblocked[0], unblocked[0]};
    always @(posedge clk_laser or posedge laser_off)
        if (laser_off) taken <= 2'b00;
        else taken <= passes;
    wire laser = !laser_off && (clk_laser ? taken[0] : taken[1]);

    // Of the output: steps that it has been high, and from its last rise on.
    localparam [7:0] Many = 8'd200;
    reg laser_last;
    reg [7:0] high, since_rise;
    initial {laser_last, high, since_rise} = {9'd0, Many};
    wire rises = laser && !laser_last;
    always @(posedge step) begin
        laser_last <= laser;
        high <= laser ? high + 8'd1 : 8'd0;
        since_rise <= rises ? 8'd1 : since_rise == Many ? Many : since_rise + 8'd1;
    end

    // The PLL or the interlock has cut it, and it has not been armed since; the arming under way.
    reg cut, armed_last;
    initial {cut, armed_last} = 2'b10;
    wire cuts = !locked || interlock;
    always @(posedge step) begin
        armed_last <= armed;
        cut <= cuts || cut && !(armed && !armed_last);
    end

    // Whether somebody armed it at each of the last edges of clk_sys, and edges since the host was last heard.
    reg [4:0] arms_before;
    reg [31:0] since_heard;
    reg laser_en_last, pins_selected_last;
    initial pins_selected_last = 1'b0;
    initial {arms_before, since_heard, laser_en_last} = {5'd0, 32'd0, 1'b1};
    wire arms = pins_selected ? \guard.laser_en_sync  && !laser_en_last : arm;
    always @(posedge clk_sys) begin
        pins_selected_last <= pins_selected;
        laser_en_last <= \guard.laser_en_sync  || rst;
        arms_before <= {arms_before[3:0], arms};
        since_heard <= heard || arms ? 32'd0 : since_heard == 32'hffffffff ? since_heard : since_heard + 32'd1;
    end
    reg armed_then;  // armed when the output was taken
    initial armed_then = 1'b0;
    always @(posedge clk_laser) armed_then <= \guard.armed_last ;

    always @* begin
        if (`RULE == 0) begin
            assert (!(laser && cuts));
            assert (!(laser && cut));
            // By induction.
            assert (!cut || laser_off);
            assert (!(cut && armed && armed_last) || unlocked || interlocked);
        end
        if (`RULE == 1) begin
            assert (!laser || armed_then);
            assert (!(armed && !armed_last) || arms_before[4]);
        end
        if (`RULE == 2) begin
            assert (since_heard == \guard.silence );
            assert (!laser || pins_selected || pins_selected_last || since_heard <= HostTimeout);
        end
        if (`RULE == 3) begin
            assert (high + laser <= LongestPulse);
        end
        if (`RULE == 4) begin
            assert (!rises || since_rise >= 2 * ShortestPeriod);
            // By induction.
            assert (since_rise + 2 * \guard.gap >= 2 * ShortestPeriod - (clk_laser ? 2 : 1));
        end
    end
endmodule
