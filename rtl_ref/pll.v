`timescale 1ps / 1fs
`default_nettype none

// The clocks: 125 and 250 MHz from the board's 200 MHz oscillator, by a PLLE2 of the 7 series with its VCO at
// 1 GHz (M = 5, D = 1, O = 8 and 4), or by an EHXPLLL of an ECP5 with its VCO at 500 MHz.
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
    output wire clk_sys,
    output wire clk_laser,
    output wire locked    // the outputs run
);
`ifdef SYNTHESIS
`ifdef ECP5
    // 200 MHz / 4 is compared with CLKOP / 5. Both outputs begin with the last count of their dividers,
    // so that each second edge of clk_laser is one of clk_sys.
    EHXPLLL #(
        .CLKI_DIV(4),
        .CLKFB_DIV(5),
        .FEEDBK_PATH("CLKOP"),
        .CLKOP_DIV(2),
        .CLKOP_CPHASE(1),
        .CLKOS_ENABLE("ENABLED"),
        .CLKOS_DIV(4),
        .CLKOS_CPHASE(3)
    ) ehxplll (
        .CLKI(clk_200),
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
        .CLKIN1_PERIOD(5),
        .DIVCLK_DIVIDE(1),
        .CLKFBOUT_MULT(5),
        .CLKOUT0_DIVIDE(8),
        .CLKOUT1_DIVIDE(4)
    ) plle2 (
        .CLKIN1(clk_200),
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
