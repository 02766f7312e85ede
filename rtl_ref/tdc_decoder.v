`timescale 1ps / 1fs
`default_nettype none

// Turns a hit into a code of 25 ps: counts its high taps, then looks up and subtracts their time.
module tdc_decoder #(
    parameter CalFile = "rtl_ref/tdc_cal.mem"  // age of a hit for each ones count [25/16 ps]
) (
    input wire clk_125,
    input wire rst,
    // tdc_latch
    input wire hit,               // a new hit is kept
    input wire [2:0] hit_coarse,  // its coarse count
    input wire [799:0] hit_taps,  // its taps
    // The code
    output reg tdc_valid,         // tdc_code is new; one cycle
    output reg [7:0] tdc_code     // time from the laser edge to the hit [25 ps]
);
    reg n_valid;         // n is new
    reg [9:0] n;         // taps the hit had run through
    reg [2:0] n_coarse;  // coarse count of n

    reg tdc_valid_next, n_valid_next;
    reg [7:0] tdc_code_next;
    reg [9:0] n_next;
    reg [2:0] n_coarse_next;

    reg [13:0] cal [0:800];
    initial $readmemh(CalFile, cal);

    initial begin
        {tdc_valid, n_valid} = 2'd0;
        tdc_code = 8'd0;
        n = 10'd0;
        n_coarse = 3'd0;
    end

    // Ones among the taps, as a balanced tree over bytes. All taps count, so bubbles do no harm.
    function [9:0] ones;
        input [799:0] taps;
        reg [1279:0] sums;
        reg [7:0] eight;
        integer i, width;
        begin
            sums = 1280'd0;
            for (i = 0; i < 100; i = i + 1) begin
                eight = taps[8*i +: 8];
                sums[10*i +: 10] = {9'd0, eight[0]} + {9'd0, eight[1]} + {9'd0, eight[2]}
                    + {9'd0, eight[3]} + {9'd0, eight[4]} + {9'd0, eight[5]} + {9'd0, eight[6]}
                    + {9'd0, eight[7]};
            end
            for (width = 64; width > 0; width = width / 2)
                for (i = 0; i < width; i = i + 1)
                    sums[10*i +: 10] = sums[20*i +: 10] + sums[20*i + 10 +: 10];
            ones = sums[9:0];
        end
    endfunction

    // A cycle is 5120 units of 25/16 ps.
    wire [3:0] cycles = {1'b0, n_coarse} + 4'd1;
    wire signed [16:0] edge_time = {1'b0, {2'd0, cycles} + {cycles, 2'd0}, 10'd0};
    wire signed [16:0] age = {3'd0, cal[n]};
    wire signed [16:0] t = edge_time - age;

    always @* begin
        n_valid_next = hit;
        n_next = n;
        n_coarse_next = n_coarse;
        if (hit) begin
            n_next = ones(hit_taps);
            n_coarse_next = hit_coarse;
        end
        tdc_valid_next = n_valid && t >= 17'sd0 && t < 17'sd4096;
        tdc_code_next = tdc_code;
        if (tdc_valid_next) tdc_code_next = t[11:4];
    end

    always @(posedge clk_125) begin
        if (rst) begin
            tdc_valid <= 1'b0;
            tdc_code <= 8'd0;
            n_valid <= 1'b0;
            n <= 10'd0;
            n_coarse <= 3'd0;
        end else begin
            tdc_valid <= tdc_valid_next;
            tdc_code <= tdc_code_next;
            n_valid <= n_valid_next;
            n <= n_next;
            n_coarse <= n_coarse_next;
        end
    end
endmodule
