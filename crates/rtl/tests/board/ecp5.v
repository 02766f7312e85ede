`timescale 1ps / 1fs
`default_nettype none

// The primitives of an ECP5 that rtl_ref instantiates, as FPGA-TN-02200 and FPGA-TN-02035 describe them, no further
// than rtl_ref uses them. The PLL's clocks are those of vendor_pll.

// The loop is closed over CLKOP: the VCO runs at CLKI / CLKI_DIV * CLKFB_DIV * CLKOP_DIV. An output rises with count
// CPHASE + 1 of its divider.
module EHXPLLL #(
    parameter integer CLKI_DIV = 1,
    parameter integer CLKFB_DIV = 1,
    parameter FEEDBK_PATH = "CLKOP",
    parameter integer CLKOP_DIV = 8,
    parameter integer CLKOP_CPHASE = 0,
    parameter CLKOS_ENABLE = "DISABLED",
    parameter integer CLKOS_DIV = 8,
    parameter integer CLKOS_CPHASE = 0
) (
    input wire CLKI,
    input wire CLKFB,
    output wire CLKOP,
    output wire CLKOS,
    output wire CLKOS2,
    output wire CLKOS3,
    output wire LOCK,
    output wire INTLOCK,
    output wire REFCLK,
    output wire CLKINTFB,
    input wire PHASESEL1,
    input wire PHASESEL0,
    input wire PHASEDIR,
    input wire PHASESTEP,
    input wire PHASELOADREG,
    input wire STDBY,
    input wire PLLWAKESYNC,
    input wire RST,
    input wire ENCLKOP,
    input wire ENCLKOS,
    input wire ENCLKOS2,
    input wire ENCLKOS3
);
    wire runs, second;

    initial
        if (FEEDBK_PATH != "CLKOP") begin
            $display("EHXPLLL: a loop over %s is not modelled", FEEDBK_PATH);
            $finish;
        end

    vendor_pll #(
        .LeastVcoMhz(400.0),
        .MostVcoMhz(800.0),
        .Multiply(CLKFB_DIV * CLKOP_DIV),
        .Divide(CLKI_DIV),
        .Divide0(CLKOP_DIV),
        .Divide1(CLKOS_DIV),
        .Phase0((CLKOP_CPHASE + 1) % CLKOP_DIV),
        .Phase1((CLKOS_CPHASE + 1) % CLKOS_DIV)
    ) vendor_pll (
        .clk_in(CLKI),
        .feedback_in(CLKFB),
        .feedback_out(),
        .clk_0(CLKOP),
        .clk_1(second),
        .locked(runs)
    );
    assign CLKOS = CLKOS_ENABLE == "ENABLED" && second;
    assign LOCK = runs && !STDBY && !RST;
    assign {CLKOS2, CLKOS3, INTLOCK, REFCLK, CLKINTFB} = 5'd0;
endmodule

// Two bits of carry logic, a tap's delay each.
module CCU2C #(
    parameter [15:0] INIT0 = 16'h0000,
    parameter [15:0] INIT1 = 16'h0000,
    parameter INJECT1_0 = "YES",
    parameter INJECT1_1 = "YES"
) (
    input wire CIN,
    input wire A0,
    input wire B0,
    input wire C0,
    input wire D0,
    input wire A1,
    input wire B1,
    input wire C1,
    input wire D1,
    output wire S0,
    output wire S1,
    output reg COUT
);
    reg middle;  // from the first bit to the second

    wire lut_0 = INIT0[{D0, C0, B0, A0}];
    wire lut_1 = INIT1[{D1, C1, B1, A1}];
    wire kept_0 = INJECT1_0 != "YES" && INIT0[{2'b00, B0, A0}];
    wire kept_1 = INJECT1_1 != "YES" && INIT1[{2'b00, B1, A1}];
    wire next_0 = lut_0 ? CIN : kept_0;
    wire next_1 = lut_1 ? middle : kept_1;

    initial {middle, COUT} = 2'b00;
    always @(next_0) middle <= #(`TAP_PS) next_0;
    always @(next_1) COUT <= #(`TAP_PS) next_1;

    assign S0 = lut_0 ^ (INJECT1_0 != "YES" && CIN);
    assign S1 = lut_1 ^ (INJECT1_1 != "YES" && middle);
endmodule

// Both inputs are taken at the rising edge.
module ODDRX1F (
    input wire SCLK,
    input wire RST,
    input wire D0,
    input wire D1,
    output reg Q
);
    reg second;

    initial {Q, second} = 2'b00;
    // The reset is asynchronous (FPGA-TN-02035).
    always @(posedge SCLK or posedge RST)
        if (RST) {Q, second} <= 2'b00;
        else {Q, second} <= {D0, D1};
    always @(negedge SCLK) if (!RST) Q <= second;
endmodule

module LUT4 #(
    parameter [15:0] INIT = 16'h0000
) (
    input wire A,
    input wire B,
    input wire C,
    input wire D,
    output wire Z
);
    // An input that decides nothing may be unknown, as at the start of a loop.
    wire [1:0] left = {INIT[{D, C, B, 1'b1}], INIT[{D, C, B, 1'b0}]};
    assign #500 Z = left[0] == left[1] ? left[0] : left[A];
endmodule
