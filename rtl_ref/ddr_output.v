`timescale 1ps / 1fs
`default_nettype none

// A double-data-rate output register: pulses of half cycles without glitches. With one bit its second input is low.
module ddr_output #(
    parameter integer Halves = 1,
    parameter [0:0] Hosted = 1'b0  // looks at off and block
) (
    input wire clk_laser,
    // Levels for the first half of the coming cycle and for its second, which has none of its own
    input wire [Halves-1:0] d,
    // laser_guard
    // verilator lint_off UNUSEDSIGNAL
    input wire off,             // the output is low, asynchronous
    input wire [Halves-1:0] block,  // levels of d that do not pass
    // verilator lint_on UNUSEDSIGNAL
    output wire q               // the output
);
    wire d_first = d[0] && !(Hosted && block[0]);
    wire d_second = Halves > 1 && d_first && d[Halves-1] && !(Hosted && block[Halves-1]);
    wire is_off = Hosted && off;

`ifdef SYNTHESIS
`ifdef ECP5
    ODDRX1F oddr (
        .SCLK(clk_laser),
        .RST(is_off),
        .D0(d_first),
        .D1(d_second),
        .Q(q)
    );
`else
    ODDR #(
        .DDR_CLK_EDGE("SAME_EDGE"),
        .INIT(1'b0),
        .SRTYPE("ASYNC")
    ) oddr (
        .C(clk_laser),
        .CE(1'b1),
        .D1(d_first),
        .D2(d_second),
        .R(is_off),
        .S(1'b0),
        .Q(q)
    );
`endif
`else
    reg level;
    reg second;  // the output after the falling edge

    initial {level, second} = 2'b00;

    always @(posedge clk_laser or negedge clk_laser or posedge is_off) begin
        if (is_off) level <= 1'b0;
        else level <= clk_laser ? d_first : second;
    end
    always @(posedge clk_laser or posedge is_off) second <= !is_off && d_second;

    assign q = level;
`endif
endmodule
