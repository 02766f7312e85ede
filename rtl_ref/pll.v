`timescale 1ps / 1fs
`default_nettype none

// The clocks: 125 and 250 MHz from the board's 200 MHz oscillator (M = 5, D = 1, O = 8 and 4).
module pll #(
    // Not read by synthesis, nor by Verilator without --timing, which cannot run the model below.
    // verilator lint_off UNUSEDPARAM
    parameter [63:0] LockTime = 64'd1000000  // of the simulation model, from time 0 [ps]
    // verilator lint_on UNUSEDPARAM
) (
    // Not read by Verilator without --timing.
    // verilator lint_off UNUSEDSIGNAL
    input wire clk_200,   // oscillator of the board
    // verilator lint_on UNUSEDSIGNAL
    output wire clk_125,
    output wire clk_250,
    output wire locked    // the outputs run
);
`ifdef SYNTHESIS
    wire feedback_out, feedback_in, out_125, out_250;

    // Before lock the outputs already run, at some frequency; reset_sync waits for locked.
    PLLE2_BASE #(
        .CLKIN1_PERIOD(5),
        .DIVCLK_DIVIDE(1),
        .CLKFBOUT_MULT(5),
        .CLKOUT0_DIVIDE(8),
        .CLKOUT1_DIVIDE(4)
    ) plle2 (
        .CLKIN1(clk_200),
        .CLKFBIN(feedback_in),
        .CLKFBOUT(feedback_out),
        .CLKOUT0(out_125),
        .CLKOUT1(out_250),
        .CLKOUT2(),
        .CLKOUT3(),
        .CLKOUT4(),
        .CLKOUT5(),
        .LOCKED(locked),
        .PWRDWN(1'b0),
        .RST(1'b0)
    );

    BUFG bufg_feedback (
        .I(feedback_out),
        .O(feedback_in)
    );

    BUFG bufg_125 (
        .I(out_125),
        .O(clk_125)
    );

    BUFG bufg_250 (
        .I(out_250),
        .O(clk_250)
    );
`else
    // Edges of one instant are one assignment, so that no register of one clock sees what a
    // register of the other has just become.
    reg [1:0] clocks /* verilator public_flat_rw */;
    reg lock /* verilator public_flat_rw */;

    assign {clk_125, clk_250} = clocks;
    assign locked = lock;

    initial begin
        clocks = 2'b00;
        lock = 1'b0;
    end

    // There are no delays in Verilator without --timing: a harness sets clocks and lock by path.
`ifdef VERILATOR
`ifndef VERILATOR_TIMING
`define PLL_WITHOUT_DELAYS
`endif
`endif

`ifndef PLL_WITHOUT_DELAYS
    time first_edge;
    time vco;  // period of the VCO [ps]

    initial begin
        vco = 1000;
        @(posedge clk_200) first_edge = $time;
        @(posedge clk_200) vco = ($time - first_edge) / 5;
    end

    always begin
        // x at time 0, if this process comes before the initial one.
        if (lock !== 1'b1) begin
            #(LockTime) lock <= 1'b1;
            #(8 * vco);
        end
        clocks <= 2'b11;
        #(2 * vco) clocks <= 2'b10;
        #(2 * vco) clocks <= 2'b01;
        #(2 * vco) clocks <= 2'b00;
        #(2 * vco);
    end
`endif
`endif
endmodule
