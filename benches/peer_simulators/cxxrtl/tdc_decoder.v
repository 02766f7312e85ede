`default_nettype none

// Counts the taps of a hit in C++ (driver.cpp).
(* cxxrtl_blackbox *)
module ones (
    (* cxxrtl_edge = "p" *) input wire clk_125,
    input wire rst,
    input wire hit,
    input wire [799:0] hit_taps,
    (* cxxrtl_sync *) output wire [9:0] n
);
endmodule

// As in rtl_ref, but for the count.
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
    wire [9:0] n;
    reg [2:0] n_coarse;

    reg [13:0] cal [0:800];
    initial $readmemh(CalFile, cal);

    initial begin
        {tdc_valid, n_valid} = 2'd0;
        tdc_code = 8'd0;
        n_coarse = 3'd0;
    end

    ones ones (
        .clk_125(clk_125),
        .rst(rst),
        .hit(hit),
        .hit_taps(hit_taps),
        .n(n)
    );

    // A cycle is 5120 units of 25/16 ps; a negative time shows in the sign.
    wire [16:0] t = 17'd5120 * ({14'd0, n_coarse} + 17'd1) - {3'd0, cal[n]};
    wire fits = n_valid && t[16:12] == 5'd0;

    always @(posedge clk_125) begin
        if (rst) begin
            {tdc_valid, n_valid} <= 2'd0;
            tdc_code <= 8'd0;
            n_coarse <= 3'd0;
        end else begin
            tdc_valid <= fits;
            n_valid <= hit;
            if (fits) tdc_code <= t[11:4];
            if (hit) n_coarse <= hit_coarse;
        end
    end
endmodule
