`timescale 1ps / 1fs
`default_nettype none

// A double-data-rate output register with its second input low: half-cycle pulses without glitches.
module ddr_output (
    input wire clk_laser,
    input wire d,  // level for the first half of the coming cycle
    output wire q  // the output
);
`ifdef SYNTHESIS
`ifdef ECP5
    ODDRX1F oddr (
        .SCLK(clk_laser),
        .RST(1'b0),
        .D0(d),
        .D1(1'b0),
        .Q(q)
    );
`else
    ODDR #(
        .DDR_CLK_EDGE("SAME_EDGE"),
        .INIT(1'b0),
        .SRTYPE("SYNC")
    ) oddr (
        .C(clk_laser),
        .CE(1'b1),
        .D1(d),
        .D2(1'b0),
        .R(1'b0),
        .S(1'b0),
        .Q(q)
    );
`endif
`else
    reg level;

    initial level = 1'b0;

    always @(posedge clk_laser or negedge clk_laser) level <= clk_laser && d;

    assign q = level;
`endif
endmodule
