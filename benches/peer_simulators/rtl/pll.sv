`timescale 1ps / 1ps
`default_nettype none

// The clocks of a simulator without delays. Plain, the harness sets them by path. SELF_CLOCKED,
// they run by themselves within one evaluation until bench.stop, and leave out the edges at which
// no register can change: of clk_250 all but those around the laser pulse.
module pll #(
    // verilator lint_off UNUSEDPARAM
    parameter [63:0] LockTime = 64'd1000000
    // verilator lint_on UNUSEDPARAM
) (
    // verilator lint_off UNUSEDSIGNAL
    input wire clk_200,
    // verilator lint_on UNUSEDSIGNAL
`ifndef SELF_CLOCKED
    output wire clk_125,
    output wire clk_250,
    output wire locked
);
    // verilator tracing_off
    reg [1:0] clocks /* verilator public_flat_rw */;
    reg lock /* verilator public_flat_rw */;
    // verilator tracing_on
    initial {clocks, lock} = 3'd0;

    assign {clk_125, clk_250} = clocks;
    assign locked = lock;
`else
    output reg clk_125,
    output reg clk_250 /* verilator public_flat_rw */,
    output wire locked
);
    // The edges of a cycle.
    localparam [1:0] Rise = 2'd0, Fall = 2'd1, Middle = 2'd2, LastFall = 2'd3;

    reg [1:0] phase;     // the edge at hand
    reg rises;           // clk_250 rises at it
    reg clk_awake;       // see edge.svh
    reg [63:0] edge_at;  // the rising edge of clk_125 at hand, or else the last one [fs]
    reg [3:0] cycles;    // since power-up, up to 8; in these no edge is left out

    initial begin
        {clk_125, clk_250, clk_awake, rises} = 4'd0;
        phase = LastFall;
        edge_at = 64'd1000000000;
        cycles = 4'd0;
    end

    assign locked = 1'b1;  // it is, long before the first edge
    wire all = !cycles[3];

    always @(edge clk_125 or edge clk_250) begin : run
        reg [1:0] next;
        // pre_start, fire and laser_pulse are those before the edge.
        case (phase)
            Rise: next = all || tof_top.vcsel_driver.laser_pulse ? Fall
                : tof_top.vcsel_driver.pre_start ? Middle : Rise;
            Fall: next = all || tof_top.vcsel_driver.fire ? Middle : Rise;
            Middle: next = all || tof_top.vcsel_driver.laser_pulse ? LastFall : Rise;
            default: next = Rise;
        endcase
        if (next != Rise) begin
            phase <= next;
            rises <= next == Middle;
            clk_250 <= !clk_250;
        end else if (!bench.stop) begin
            phase <= Rise;
            rises <= 1'b1;
            clk_125 <= !clk_125;
            edge_at <= edge_at + 64'd8000000;
            // laser_pulse is high, or becomes so at this edge.
            if (phase[1]) clk_250 <= !clk_250;
            if (all) cycles <= cycles + 4'd1;
            if (all || !tof_top.frame_ctrl.acquire) clk_awake <= !clk_awake;
        end
    end
`endif
endmodule
