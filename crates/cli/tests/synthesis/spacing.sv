`default_nettype none

// No hit comes in the `Gap cycles after another, whatever acquire, rate and avalanches do, from the
// TDC with any calibration or from its stand-in with any codes (`SOURCE).
module spacing (
    input wire clk_sys,
    input wire rst,
    input wire acquire,
    input wire [1:0] laser_freq,
    input wire tdc_stop
);
    wire start, tdc_valid;

    vcsel_driver vcsel_driver (
        .clk_sys(clk_sys),
        .clk_laser(1'b0),
        .rst(rst),
        .rst_laser(1'b0),
        .acquire(acquire),
        .laser_en(1'b0),
        .laser_freq(laser_freq),
        .start(start)
    );

    `SOURCE source (
        .clk_sys(clk_sys),
        .rst(rst),
        .start(start),
`ifdef HAS_STOP
        .tdc_stop(tdc_stop),
`endif
        .tdc_valid(tdc_valid)
    );

    reg first = 1'b1;                // the first cycle
    reg [`Gap-1:0] before = `Gap'd0; // tdc_valid in the last cycles

    always @(posedge clk_sys) begin
        first <= 1'b0;
        before <= {before, tdc_valid};
    end

    always @* begin
        if (first) assume (rst);
        assert (!(tdc_valid && |before));
    end
endmodule
