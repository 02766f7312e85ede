`timescale 1ps / 1ps
`default_nettype none

// As in rtl_ref, but the taps are counted with $countones, and each stage works only when it has
// something new.
module tdc_decoder #(
    parameter CalFile = "rtl_ref/tdc_cal.mem"
) (
    input wire clk_125,
    input wire rst,
    input wire hit,
    input wire [2:0] hit_coarse,
    input wire [799:0] hit_taps,
    output reg tdc_valid,
    output reg [7:0] tdc_code
);
    reg n_valid;
    reg [9:0] n;
    reg [2:0] n_coarse;

    reg [13:0] cal [0:1023];
    initial $readmemh(CalFile, cal, 0, 800);

    initial begin
        {tdc_valid, n_valid} = 2'd0;
        tdc_code = 8'd0;
        n = 10'd0;
        n_coarse = 3'd0;
    end

    always @(posedge clk_125) begin : decode
        reg [16:0] t;
        if (rst) begin
            {tdc_valid, n_valid} <= 2'd0;
            tdc_code <= 8'd0;
            n <= 10'd0;
            n_coarse <= 3'd0;
        end else begin
            tdc_valid <= 1'b0;
            n_valid <= hit;
            if (hit) begin
                n <= 10'($countones(hit_taps));
                n_coarse <= hit_coarse;
            end
            if (n_valid) begin
                // A cycle is 5120 units of 25/16 ps; a negative time shows in the sign.
                t = 17'd5120 * ({14'd0, n_coarse} + 17'd1) - {3'd0, cal[n]};
                if (t[16:12] == 5'd0) begin
                    tdc_valid <= 1'b1;
                    tdc_code <= t[11:4];
                end
            end
        end
    end
endmodule
