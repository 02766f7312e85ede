`timescale 1ps / 1ps
`default_nettype none

// As in rtl_ref, but the taps are counted at once with $countones, and each stage works only when it
// has something new.
module tdc_decoder #(
    parameter CalFile = "rtl_ref/tdc_cal.mem",
    parameter [1:0] CountStages = 2'd3
) (
    input wire clk_sys,
    input wire rst,
    input wire hit,
    input wire [2:0] hit_coarse,
    input wire [799:0] hit_taps,
    output reg tdc_valid,
    output reg [7:0] tdc_code
);
    reg first_valid, second_valid, n_valid, age_valid, t_valid;
    reg [9:0] first, second, n;
    reg [2:0] first_coarse, second_coarse, n_coarse, age_coarse;
    reg [13:0] age;
    // Its lowest bits are for the borrow.
    // verilator lint_off UNUSEDSIGNAL
    reg signed [16:0] t;
    // verilator lint_on UNUSEDSIGNAL

    reg [13:0] cal [0:1023];
    initial $readmemh(CalFile, cal, 0, 800);

    initial begin
        {tdc_valid, first_valid, second_valid, n_valid, age_valid, t_valid} = 6'd0;
        tdc_code = 8'd0;
        {first, second, n} = 30'd0;
        {first_coarse, second_coarse, n_coarse, age_coarse} = 12'd0;
        age = 14'd0;
        t = 17'sd0;
    end

    wire two = CountStages == 2'd2;

    always @(posedge clk_sys) begin
        if (hit) {first, first_coarse} <= {10'($countones(hit_taps)), hit_coarse};
        if (first_valid) {second, second_coarse} <= {first, first_coarse};
        if (two ? first_valid : second_valid)
            {n, n_coarse} <= two ? {first, first_coarse} : {second, second_coarse};
        if (n_valid) {age, age_coarse} <= {cal[n], n_coarse};
        // A cycle is 5120 units of 25/16 ps; a negative time shows in the sign.
        if (age_valid) t <= 17'd5120 * ({14'd0, age_coarse} + 17'd1) - {3'd0, age};
        if (rst) begin
            {tdc_valid, first_valid, second_valid, n_valid, age_valid, t_valid} <= 6'd0;
            tdc_code <= 8'd0;
        end else begin
            first_valid <= hit;
            second_valid <= first_valid;
            n_valid <= two ? first_valid : second_valid;
            age_valid <= n_valid;
            t_valid <= age_valid;
            tdc_valid <= t_valid && t[16:12] == 5'd0;
            if (t_valid && t[16:12] == 5'd0) tdc_code <= t[11:4];
        end
    end
endmodule
