`timescale 1ps / 1fs
`default_nettype none

// The clocks: clk_sys, and clk_laser twice as fast, by a PLLE2 of the 7 series or an EHXPLLL of an ECP5. Its own
// oscillator, the VCO, runs at InputHz * Multiply / Divide. On the KC705 that is 1 GHz, from 200 MHz.
module pll #(
    // Not read by Verilator without --timing, which cannot run the model below, nor each of them by synthesis.
    // verilator lint_off UNUSEDPARAM
    parameter integer InputHz = 200000000,   // oscillator of the board [Hz]
    parameter integer Multiply = 5,          // of the VCO, M
    parameter integer Divide = 1,            // of the input, D
    parameter integer OutputDivide = 8,      // of clk_sys, O, an even number; clk_laser has half of it
    parameter [63:0] LockTime = 64'd1000000  // of the model, from time 0 [ps]
    // verilator lint_on UNUSEDPARAM
) (
    // Not read by the model.
    // verilator lint_off UNUSEDSIGNAL
    input wire clk_in,    // oscillator of the board
    // verilator lint_on UNUSEDSIGNAL
    output wire clk_sys,
    output wire clk_laser,
    output wire locked    // the outputs run
);
`ifdef SYNTHESIS
`ifdef ECP5
    function integer greatest_common_divisor;
        input integer a, b;
        integer rest;
        begin
            while (b != 0) begin
                rest = a % b;
                a = b;
                b = rest;
            end
            greatest_common_divisor = a;
        end
    endfunction

    // The loop is closed over clk_laser: the input by CLKI_DIV is compared with clk_laser by CLKFB_DIV.
    localparam integer Common = greatest_common_divisor(2 * Multiply, Divide * OutputDivide);

    // Both outputs begin with the last count of their dividers, so that each second edge of clk_laser is one
    // of clk_sys.
    EHXPLLL #(
        .CLKI_DIV(Divide * OutputDivide / Common),
        .CLKFB_DIV(2 * Multiply / Common),
        .FEEDBK_PATH("CLKOP"),
        .CLKOP_DIV(OutputDivide / 2),
        .CLKOP_CPHASE(OutputDivide / 2 - 1),
        .CLKOS_ENABLE("ENABLED"),
        .CLKOS_DIV(OutputDivide),
        .CLKOS_CPHASE(OutputDivide - 1)
    ) ehxplll (
        .CLKI(clk_in),
        .CLKFB(clk_laser),
        .CLKOP(clk_laser),
        .CLKOS(clk_sys),
        .CLKOS2(),
        .CLKOS3(),
        .LOCK(locked),
        .INTLOCK(),
        .REFCLK(),
        .CLKINTFB(),
        .PHASESEL1(1'b0),
        .PHASESEL0(1'b0),
        .PHASEDIR(1'b0),
        .PHASESTEP(1'b0),
        .PHASELOADREG(1'b0),
        .STDBY(1'b0),
        .PLLWAKESYNC(1'b0),
        .RST(1'b0),
        .ENCLKOP(1'b0),
        .ENCLKOS(1'b0),
        .ENCLKOS2(1'b0),
        .ENCLKOS3(1'b0)
    );
`else
    wire feedback_out, feedback_in, out_sys, out_laser;

    // Before lock the outputs already run, at some frequency; reset_sync waits for locked.
    PLLE2_BASE #(
        .CLKIN1_PERIOD(1.0e9 / InputHz),
        .DIVCLK_DIVIDE(Divide),
        .CLKFBOUT_MULT(Multiply),
        .CLKOUT0_DIVIDE(OutputDivide),
        .CLKOUT1_DIVIDE(OutputDivide / 2)
    ) plle2 (
        .CLKIN1(clk_in),
        .CLKFBIN(feedback_in),
        .CLKFBOUT(feedback_out),
        .CLKOUT0(out_sys),
        .CLKOUT1(out_laser),
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

    BUFG bufg_sys (
        .I(out_sys),
        .O(clk_sys)
    );

    BUFG bufg_laser (
        .I(out_laser),
        .O(clk_laser)
    );
`endif
`else
    // Edges of one instant are one assignment, so that no register of one clock sees what a
    // register of the other has just become.
    reg [1:0] clocks /* verilator public_flat_rw */;
    reg lock /* verilator public_flat_rw */;

    assign {clk_sys, clk_laser} = clocks;
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
    // A quarter of clk_sys's period, rounded to a whole number [fs].
    localparam [63:0] Multiplied = 64'd1 * InputHz * Multiply;
    localparam [63:0] Divided = 64'd250000000000000 * Divide * OutputDivide;
    localparam [63:0] Quarter = (Divided + Multiplied / 64'd2) / Multiplied;
    // With a fifth of a femtosecond a simulator that cuts a delay off and one that rounds it agree [ps].
    localparam real QuarterDelay = (Quarter + 0.2) / 1000.0;
    localparam real CycleDelay = (64'd4 * Quarter + 0.2) / 1000.0;

    always begin
        // x at time 0, if this process comes before the initial one.
        if (lock !== 1'b1) begin
            #(LockTime) lock <= 1'b1;
            #(CycleDelay);
        end
        clocks <= 2'b11;
        #(QuarterDelay) clocks <= 2'b10;
        #(QuarterDelay) clocks <= 2'b01;
        #(QuarterDelay) clocks <= 2'b00;
        #(QuarterDelay);
    end
`endif
`endif
endmodule
