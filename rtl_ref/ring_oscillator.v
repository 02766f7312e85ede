`timescale 1ps / 1fs
`default_nettype none

// A ring oscillator, for hits uncorrelated with the clock: a loop of look-up tables, one of which inverts, and behind it
// a divider, so that pulses are two cycles of clk_sys or more apart and as long as the pauses between them. A loop of 15
// with 0.3 to 1 ns each, and a division by 8, gives periods of 72 to 240 ns; what it is on a board, the host finds out.
//
// While it runs, its pulses take the place of tdc_stop. The choice is a register of its own clock, so that no path through
// the carry chain begins at a register of clk_sys. For synthesis only: in a simulation the source of photons does what it
// does.
`ifdef SYNTHESIS
module ring_oscillator #(
    parameter integer Stages = 15,      // of the loop
    parameter integer DivideLog2 = 3    // each bit halves the frequency
) (
    input wire enable,                  // it oscillates
    input wire tdc_stop,                // of the SPAD array
    output wire hit                     // for the carry chain
);
    (* keep = "true", DONT_TOUCH = "TRUE", ALLOW_COMBINATORIAL_LOOPS = "TRUE" *) wire [Stages-1:0] link;
    reg [DivideLog2-1:0] divided;
    wire [DivideLog2:0] clocks = {divided, link[Stages-1]};
    reg runs;  // hits come from the loop

    initial divided = {DivideLog2{1'b0}};
    initial runs = 1'b0;

    always @(posedge clocks[DivideLog2] or negedge enable)
        if (!enable) runs <= 1'b0;
        else runs <= 1'b1;

    genvar k;
    generate
        for (k = 0; k < Stages; k = k + 1) begin : stage
            // The first one inverts while enable is high, the others do not.
            wire before = k == 0 ? link[Stages-1] : link[k == 0 ? 0 : k - 1];
`ifdef ECP5
            (* keep *) LUT4 #(
                .INIT(k == 0 ? 16'h7777 : 16'haaaa)
            ) lut (
                .A(before),
                .B(enable),
                .C(1'b0),
                .D(1'b0),
                .Z(link[k])
            );
`else
            (* DONT_TOUCH = "TRUE" *) LUT2 #(
                .INIT(k == 0 ? 4'h7 : 4'ha)
            ) lut (
                .I0(before),
                .I1(enable),
                .O(link[k])
            );
`endif
        end
        for (k = 0; k < DivideLog2; k = k + 1) begin : divider
            always @(posedge clocks[k]) divided[k] <= !divided[k];
        end
    endgenerate

    assign hit = runs ? clocks[DivideLog2] : tdc_stop;
endmodule
`endif
