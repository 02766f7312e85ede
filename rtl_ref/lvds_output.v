`timescale 1ps / 1fs
`default_nettype none

// The differential output buffer of the laser pulse.
module lvds_output (
    input wire i,    // single-ended pulse
    output wire o,   // positive pin
    output wire ob   // negative pin
);
`ifdef SYNTHESIS
    OBUFDS obufds (
        .I(i),
        .O(o),
        .OB(ob)
    );
`else
    assign o = i;
    assign ob = !i;
`endif
endmodule
