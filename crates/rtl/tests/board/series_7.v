`timescale 1ps / 1fs
`default_nettype none

// The primitives of the 7 series that rtl_ref instantiates, as UG471, UG472 and UG474 describe them, no further than
// rtl_ref uses them. The PLL's clocks are those of vendor_pll.

// A VCO at CLKIN1 * CLKFBOUT_MULT / DIVCLK_DIVIDE, and outputs that divide it and rise together.
module PLLE2_BASE #(
    parameter real CLKIN1_PERIOD = 0.0,  // [ns]
    parameter integer DIVCLK_DIVIDE = 1,
    parameter integer CLKFBOUT_MULT = 5,
    parameter integer CLKOUT0_DIVIDE = 1,
    parameter integer CLKOUT1_DIVIDE = 1
) (
    input wire CLKIN1,
    input wire CLKFBIN,
    output wire CLKFBOUT,
    output wire CLKOUT0,
    output wire CLKOUT1,
    output wire CLKOUT2,
    output wire CLKOUT3,
    output wire CLKOUT4,
    output wire CLKOUT5,
    output wire LOCKED,
    input wire PWRDWN,
    input wire RST
);
    wire runs;

    // Speed grade -2.
    vendor_pll #(
        .LeastVcoMhz(800.0),
        .MostVcoMhz(1866.0),
        .PeriodNs(CLKIN1_PERIOD),
        .Multiply(CLKFBOUT_MULT),
        .Divide(DIVCLK_DIVIDE),
        .Divide0(CLKOUT0_DIVIDE),
        .Divide1(CLKOUT1_DIVIDE),
        .FeedbackDivide(CLKFBOUT_MULT)
    ) vendor_pll (
        .clk_in(CLKIN1),
        .feedback_in(CLKFBIN),
        .feedback_out(CLKFBOUT),
        .clk_0(CLKOUT0),
        .clk_1(CLKOUT1),
        .locked(runs)
    );
    assign LOCKED = runs && !PWRDWN && !RST;
    assign {CLKOUT2, CLKOUT3, CLKOUT4, CLKOUT5} = 4'd0;
endmodule

module BUFG (
    input wire I,
    output wire O
);
    assign O = I;
endmodule

// One of a pair that does not differ changes nothing.
module IBUFDS (
    input wire I,
    input wire IB,
    output reg O
);
    always @* if (I === !IB) O = I;
endmodule

module OBUFDS (
    input wire I,
    output wire O,
    output wire OB
);
    assign O = I;
    assign OB = !I;
endmodule

// Four bits of carry logic, a tap's delay each.
module CARRY4 (
    input wire CI,
    input wire CYINIT,
    input wire [3:0] DI,
    input wire [3:0] S,
    output reg [3:0] CO,
    output wire [3:0] O
);
    wire [4:0] carry = {CO, CI | CYINIT};

    initial CO = 4'd0;
    genvar k;
    generate
        for (k = 0; k < 4; k = k + 1) begin : bits
            wire next = S[k] ? carry[k] : DI[k];
            always @(next) CO[k] <= #(`TAP_PS) next;
        end
    endgenerate
    assign O = S ^ carry[3:0];
endmodule

// SAME_EDGE: both inputs are taken at the rising edge.
module ODDR #(
    parameter DDR_CLK_EDGE = "OPPOSITE_EDGE",
    parameter [0:0] INIT = 1'b0,
    parameter SRTYPE = "SYNC"
) (
    input wire C,
    input wire CE,
    input wire D1,
    input wire D2,
    input wire R,
    input wire S,
    output reg Q
);
    reg second;

    initial begin
        {Q, second} = {2{INIT}};
        if (DDR_CLK_EDGE != "SAME_EDGE" || SRTYPE != "ASYNC") begin
            $display("ODDR: %s, %s are not modelled", DDR_CLK_EDGE, SRTYPE);
            $finish;
        end
    end

    always @(posedge C or posedge R or posedge S)
        if (R) {Q, second} <= 2'b00;
        else if (S) {Q, second} <= 2'b11;
        else if (CE) {Q, second} <= {D1, D2};
    always @(negedge C) if (!R && !S) Q <= second;
endmodule

module LUT2 #(
    parameter [3:0] INIT = 4'h0
) (
    input wire I0,
    input wire I1,
    output wire O
);
    // An input that decides nothing may be unknown, as at the start of a loop.
    wire [1:0] left = I1 ? INIT[3:2] : INIT[1:0];
    assign #500 O = left[0] == left[1] ? left[0] : left[I0];
endmodule
