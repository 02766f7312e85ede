`timescale 1ps / 1fs
`default_nettype none

// Sums over the bins of a fit: information and score of (mu, log S, log b), or how well the fit does.
//
// What a bin says goes through five registers, a beat of two cycles each; four multipliers work twice a beat.
// Words are extended and cut as what they are assigned to is wide; some bits are not needed.
// verilator lint_off WIDTH
// verilator lint_off UNUSEDSIGNAL
module likelihood_sums #(
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16             // of a word of the histogram, 8 to 24
) (
    input wire clk_sys,
    input wire pass,                             // begins a pass
    input wire check,                            // it is for the chi-square
    input wire phase,                            // second cycle of a beat
    // likelihood_terms
    input wire signed [CountBits+8:0] residual,  // v [2^-4 counts], 0 of what is no bin
    input wire [CountBits+17:0] predicted,        // R lambda [2^-12 counts]
    input wire [12:0] gain,                      // lambda / (exp(lambda) - 1) [2^-12]
    input wire [12:0] share,                     // s, the signal's in the hazard [2^-12]
    input wire signed [8:0] slope,               // z
    input wire single,                           // the residual is that of a single bin
    // Sums; w has 6 fraction bits
    output reg signed [CountBits+19:0] sum_11,   // of w s s z z [2^-9]
    output reg signed [CountBits+23:0] sum_12,   // of w s s z
    output reg signed [CountBits+23:0] sum_13,   // of w s (1 - s) z
    output reg signed [CountBits+18:0] sum_22,   // of w s s
    output reg signed [CountBits+18:0] sum_23,   // of w s (1 - s)
    output reg signed [CountBits+18:0] sum_33,   // of w (1 - s) (1 - s)
    output reg signed [CountBits+23:0] score_1,  // of v s z
    output reg signed [CountBits+18:0] score_2,  // of v s
    output reg signed [CountBits+18:0] score_3,  // of v (1 - s)
    output reg [BinBits+24:0] chi_square,        // [2^-8]
    output reg far                               // a bin is far from what the fit has
);
    localparam integer WeightBits = CountBits + 8 > 24 ? CountBits + 8 : 24, ResidualBits = CountBits + 9;
    localparam integer SeenBits = 2 * CountBits + 3, NearBits = CountBits + 2, SeenSlopeBits = ResidualBits + 9;
    localparam integer WeightSlopeBits = WeightBits + 9, WordBits = CountBits + 19;
    localparam integer FactorBits = NearBits > 14 ? NearBits : 14;
    localparam [WordBits-1:0] Count = 64, Sixteenth = 4;
    localparam [NearBits-1:0] Nearest = {2'b01, {CountBits{1'b1}}};

    reg [WeightBits-1:0] weight_first, weight_0, weight_1, weight_2, weight_3;  // w
    reg signed [SeenBits-1:0] seen_first, seen_0, seen_1, seen_2, seen_3;       // v s, or the square of v
    reg signed [ResidualBits-1:0] residuals_0, residuals_1, residuals_2, residuals_3;
    reg [12:0] shares_0, shares_1;
    reg signed [8:0] z_0, z_1, z_2;
    reg singles;
    reg [WeightBits-1:0] once_0, once_1, once_2;                      // w s
    reg signed [SeenSlopeBits-1:0] seen_z_0, seen_z_1, seen_z_2;      // v s z
    reg [23:0] over;               // the square over its variance's leading one [2^-8]
    reg [9:0] reciprocal;          // of that variance's mantissa
    reg [WeightBits-1:0] twice_first, twice_0, twice_1;               // w s s, or a term of the chi-square
    reg signed [WeightSlopeBits-1:0] tz_first, tz, tzz, oz;           // w s s z, w s s z z, w s (1 - s) z

    reg [9:0] reciprocals [0:63];

    integer i;
    initial begin
        // 1024 over 1 + (i + 1/2) / 64, rounded
        for (i = 0; i < 64; i = i + 1) reciprocals[i] = (262144 + 129 + 2 * i) / (2 * (129 + 2 * i));
        {sum_12, sum_13, sum_23, score_1, score_2, score_3, chi_square, far} = 0;
        {sum_11, sum_22, sum_33} = 0;
        {weight_first, weight_0, weight_1, weight_2, weight_3} = 0;
        {seen_first, seen_0, seen_1, seen_2, seen_3} = 0;
        {residuals_0, residuals_1, residuals_2, residuals_3, shares_0, shares_1, z_0, z_1, z_2, singles} = 0;
        {once_0, once_1, once_2, seen_z_0, seen_z_1, seen_z_2, over, reciprocal} = 0;
        {twice_first, twice_0, twice_1, tz_first, tz, tzz, oz} = 0;
    end

    // The first multiplier: a weight, then a share of the residual times its slope
    wire [CountBits+12:0] expected_cut = predicted[CountBits+17:5];
    wire [CountBits+7:0] expected_limited
        = |expected_cut[CountBits+12:CountBits+8] ? {CountBits + 8{1'b1}} : expected_cut[CountBits+7:0];
    wire signed [CountBits+8:0] first_a = phase ? $signed(seen_0[ResidualBits-1:0]) : $signed({1'b0, expected_limited});
    wire signed [13:0] first_b = phase ? {{5{z_0[8]}}, z_0} : $signed({1'b0, gain});
    wire signed [CountBits+22:0] first = first_a * first_b;

    // The second: a share of the residual or its square, then a share of the weight
    wire is_near = residual <= $signed(Nearest) && residual >= -$signed(Nearest);
    wire signed [NearBits-1:0] near
        = is_near ? residual[NearBits-1:0] : residual[ResidualBits-1] ? -$signed(Nearest) : $signed(Nearest);
    wire signed [WeightBits:0] second_a
        = phase ? $signed({1'b0, weight_0}) : check ? near : residual;
    wire signed [FactorBits-1:0] second_b = phase ? $signed({1'b0, shares_0}) : check ? near : $signed({1'b0, share});
    wire signed [WeightBits+FactorBits:0] second = second_a * second_b;

    // The third: a share of that share or a term of the chi-square, then the other share times its slope
    wire signed [WeightBits:0] difference = $signed({1'b0, once_1}) - $signed({1'b0, twice_0});
    wire signed [WeightBits:0] third_a = phase ? difference : check ? $signed({1'b0, over}) : $signed({1'b0, once_0});
    wire signed [13:0] third_b = phase ? {{5{z_2[8]}}, z_2}
        : check ? $signed({4'd0, reciprocal}) : $signed({1'b0, shares_1});
    wire signed [WeightBits+14:0] third = third_a * third_b;

    // The fourth: a share of the share times its slope, and times it again
    wire signed [WeightBits:0] fourth_a = phase ? tz_first >>> 9 : $signed({1'b0, twice_0});
    wire signed [WeightBits+9:0] fourth = fourth_a * z_2;

    // The square over its variance
    wire [WeightBits:0] variance = weight_0 + 16;
    reg [5:0] bits;
    always @* begin
        bits = 6'd0;
        for (i = 0; i <= WeightBits; i = i + 1) if (variance[i]) bits = i[5:0] + 6'd1;
    end
    wire [SeenBits-1:0] square = check ? seen_0 : 0;
    wire [SeenBits+8:0] square_over = {square, 9'd0} >> bits;
    wire [WeightBits+7:0] aligned = {variance, 7'd0} >> bits;
    wire [WeightBits+5:0] counted = weight_0 + 64;
    wire is_far = square > (counted << 4) + (counted << 3) + counted;

    always @(posedge clk_sys) begin
        if (!phase) begin
            weight_first <= (first >>> 13) + $signed({1'b0, first[12]});
            seen_first <= check ? second >>> 2 : (second >>> 12) + $signed({1'b0, second[11]});
            twice_first <= check ? third >>> 10 : (third >>> 12) + $signed({1'b0, third[11]});
            tz_first <= fourth;
        end else begin
            {weight_3, weight_2, weight_1, weight_0} <= {weight_2, weight_1, weight_0, weight_first};
            {seen_3, seen_2, seen_1, seen_0} <= {seen_2, seen_1, seen_0, seen_first};
            {residuals_3, residuals_2, residuals_1, residuals_0}
                <= {residuals_2, residuals_1, residuals_0, residual};
            {shares_1, shares_0} <= {shares_0, share};
            {z_2, z_1, z_0} <= {z_1, z_0, slope};
            singles <= single;
            once_0 <= (second >>> 12) + $signed({1'b0, second[11]});
            {once_2, once_1} <= {once_1, once_0};
            seen_z_0 <= check ? 0 : first;
            {seen_z_2, seen_z_1} <= {seen_z_1, seen_z_0};
            over <= |square_over[SeenBits+8:24] ? 24'hffffff : square_over[23:0];
            reciprocal <= reciprocals[aligned[5:0]];
            {twice_1, twice_0} <= {twice_0, twice_first};
            oz <= third;
            tzz <= fourth;
            tz <= tz_first;
            if (check) begin
                chi_square <= chi_square + twice_1;
                if (singles && is_far) far <= 1'b1;
            end else begin
                sum_11 <= sum_11 + tzz;
                sum_12 <= sum_12 + tz;
                sum_13 <= sum_13 + oz;
                sum_22 <= sum_22 + $signed({1'b0, twice_1});
                sum_23 <= sum_23 + $signed({1'b0, once_2}) - $signed({1'b0, twice_1});
                sum_33 <= sum_33 + $signed({1'b0, weight_3}) - $signed({1'b0, once_2, 1'b0}) + $signed({1'b0, twice_1});
                score_1 <= score_1 + seen_z_2;
                score_2 <= score_2 + seen_3;
                score_3 <= score_3 + residuals_3 - seen_3;
            end
        end
        if (pass) begin
            sum_11 <= {Sixteenth, 1'b0};
            {sum_12, sum_13, sum_23, score_1, score_2, score_3} <= 0;
            sum_22 <= Sixteenth;
            sum_33 <= Count;
            chi_square <= 0;
            far <= 1'b0;
        end
    end
endmodule
// verilator lint_on UNUSEDSIGNAL
// verilator lint_on WIDTH
