`timescale 1ps / 1fs
`default_nettype none

// The differential output buffer of the laser pulse.
module lvds_output (
    input wire i,    // single-ended pulse
    output wire o,   // positive pin
    output wire ob   // negative pin
);
`ifdef SYNTHESIS
`ifdef ECP5
    // The pin's I/O cell is differential by its IO_TYPE, and drives the other pin of the pair too.
    assign o = i;
    assign ob = 1'b0;
`else
    OBUFDS obufds (
        .I(i),
        .O(o),
        .OB(ob)
    );
`endif
`else
    assign o = i;
    assign ob = !i;
`endif
endmodule
