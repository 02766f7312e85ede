`timescale 1ps / 1fs
`default_nettype none

// A double-data-rate output register: pulses of half cycles without glitches. With one bit its second input is low.
module ddr_output #(
    parameter integer Halves = 1
) (
    input wire clk_laser,
    input wire [Halves-1:0] d,  // levels for the first half of the coming cycle and for its second
    output wire q               // the output
);
    wire d_second = Halves > 1 && d[Halves-1];

`ifdef SYNTHESIS
`ifdef ECP5
    ODDRX1F oddr (
        .SCLK(clk_laser),
        .RST(1'b0),
        .D0(d[0]),
        .D1(d_second),
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
        .D1(d[0]),
        .D2(d_second),
        .R(1'b0),
        .S(1'b0),
        .Q(q)
    );
`endif
`else
    reg level;
    reg second;  // the output after the falling edge

    initial {level, second} = 2'b00;

    always @(posedge clk_laser or negedge clk_laser) level <= clk_laser ? d[0] : second;
    always @(posedge clk_laser) second <= d_second;

    assign q = level;
`endif
endmodule
