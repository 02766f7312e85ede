`timescale 1ps / 1fs
`default_nettype none

// Sums over the bins of a fit: information and score of (mu, log S, log b), or how well the fit does.
//
// What a bin says goes on for nine beats of two cycles each; four multipliers work twice a beat.
module likelihood_sums #(
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter integer Targets = 1                // see likelihood_memory
) (
    input wire clk_sys,
    input wire pass,                             // begins a pass
    input wire check,                            // it is for the chi-square
    input wire phase,                            // second cycle of a beat
    // likelihood_terms
    input wire signed [CountBits+8:0] residual,  // v [2^-4 counts], 0 of what is no bin
    // A weight counts in 128ths.
    // verilator lint_off UNUSEDSIGNAL
    input wire [CountBits+17:0] predicted,        // R lambda [2^-12 counts]
    // verilator lint_on UNUSEDSIGNAL
    input wire [12:0] gain,                      // lambda / (exp(lambda) - 1) [2^-12]
    input wire [12:0] share,                     // s, the signal's in the hazard [2^-12]
    input wire signed [8:0] slope,               // z
    input wire single,                           // the residual is that of a single bin
    // Sums; w has 6 fraction bits
    output reg signed [CountBits+23:0] sum_11,   // of w s s z z [2^-9]
    output reg signed [CountBits+23:0] sum_12,   // of w s s z
    output reg signed [CountBits+23:0] sum_13,   // of w s (1 - s) z
    output reg signed [CountBits+18:0] sum_22,   // of w s s
    output reg signed [CountBits+18:0] sum_23,   // of w s (1 - s)
    output reg signed [CountBits+18:0] sum_33,   // of w (1 - s) (1 - s)
    output reg signed [CountBits+23:0] score_1,  // of v s z
    output reg signed [CountBits+18:0] score_2,  // of v s
    output reg signed [CountBits+18:0] score_3,  // of v (1 - s)
    output reg [BinBits+24:0] chi_square,        // of a check [2^-8]
    output reg far,                              // a bin is far from what the fit has
    output reg [(CountBits > 16 ? CountBits + 8 : 24)-1:0] weight_first  // w, one cycle ahead
);
    localparam integer WeightBits = CountBits + 8 > 24 ? CountBits + 8 : 24, ResidualBits = CountBits + 9;
    localparam integer SquareBits = 2 * CountBits, NearBits = CountBits + 2, SeenSlopeBits = ResidualBits + 9;
    localparam integer WeightSlopeBits = WeightBits + 9, WordBits = CountBits + 19;
    localparam integer FactorBits = NearBits > 14 ? NearBits : 14;
    localparam integer LastBits = (WordBits > BinBits + 25 ? WordBits : BinBits + 25) + 1;
    localparam [WordBits-1:0] Count = 64, Quarter = 16, Sixteenth = 4;
    localparam [NearBits-1:0] Nearest = {2'b01, {CountBits{1'b1}}};
    localparam signed [12:0] Half = 2048;   // of what is cut off a product, to round it
    localparam signed [9:0] Far = 25;       // squared deviations that are no chance

    reg changed;                   // the sums of each pair have changed places
    reg signed [LastBits-1:0] last_sum;  // of w (1 - s) (1 - s), or in a check the chi-square
    reg signed [ResidualBits-1:0] first_a;                                      // operands and products
    reg signed [13:0] first_b, third_b;
    reg signed [CountBits+22:0] first_product;
    reg signed [WeightBits:0] second_a, third_a, fourth_a;
    reg signed [FactorBits-1:0] second_b;
    reg signed [WeightBits+FactorBits:0] second_product;
    reg signed [WeightBits+14:0] third_product;
    reg signed [9:0] fourth_b;
    reg signed [WeightBits+9:0] fourth_product;
    reg [WeightBits-1:0] weight_0, weight_1;                                    // w
    reg signed [ResidualBits-1:0] seen_first, seen;                             // v s
    reg [SquareBits-1:0] square_first, square_0, square_1, square_2;            // the square of v
    reg signed [ResidualBits-1:0] residuals;
    reg signed [ResidualBits:0] unseen;                                         // v (1 - s)
    reg [12:0] shares_0, shares_1, shares_2;
    reg signed [8:0] z_0, z_1, z_2, z_3, z_4, z_5;
    reg singles_0, singles_1, singles_2, singles_3;
    reg [WeightBits-1:0] once_0, once_1, once_2;                      // w s
    reg signed [WeightBits:0] others;                                 // w (1 - s)
    reg signed [SeenSlopeBits-1:0] seen_z;                            // v s z
    reg [WeightBits:0] variances_0, variances_1;  // v's variance, with a quarter of a count more
    reg [5:0] bits;                // of it
    reg [SquareBits+8:0] square_over;  // the square after the longest shifts
    reg [5:0] aligned;             // the variance below its leading one
    reg [23:0] over;               // the square over its variance's leading one [2^-8]
    reg [9:0] reciprocal;          // of that variance's mantissa
    reg [WeightBits-1:0] twice_first, twice;                          // w s s, or a term of the chi-square
    reg signed [WeightBits:0] mixed;                                  // w s (1 - s)
    reg signed [WeightSlopeBits-1:0] tz_first, tz, oz;                // w s s z, w s (1 - s) z
    reg signed [WeightSlopeBits-1:0] tzz;                             // w s s z z, or the square that is not yet far

    reg [9:0] reciprocals [0:63];

    integer i;
    initial begin
        // 1024 over 1 + (i + 1/2) / 64, rounded
        // Places are integers.
        // verilator lint_off WIDTH
        for (i = 0; i < 64; i = i + 1) reciprocals[i] = (262144 + 129 + 2 * i) / (2 * (129 + 2 * i));
        // verilator lint_on WIDTH
        {sum_12, sum_13, sum_23, score_1, score_2, score_3, chi_square, far, changed} = 0;
        {sum_11, sum_22, sum_33} = 0;
        {first_a, first_b, first_product, second_a, second_b, second_product} = 0;
        {third_a, third_b, third_product, fourth_a, fourth_b, fourth_product} = 0;
        {weight_first, weight_0, weight_1, seen_first, seen} = 0;
        {square_first, square_0, square_1, square_2, residuals, unseen} = 0;
        {shares_0, shares_1, shares_2, z_0, z_1, z_2, z_3, z_4, z_5} = 0;
        {singles_0, singles_1, singles_2, singles_3} = 0;
        {once_0, once_1, once_2, others, seen_z, variances_0, variances_1, bits} = 0;
        {square_over, aligned, over, reciprocal} = 0;
        {twice_first, twice, mixed, last_sum, tz_first, tz, tzz, oz} = 0;
    end

    // Each multiplier has registers before and after the product, and one after what is added to it.
    // The first: a weight, then a share of the residual times its slope
    wire [CountBits+12:0] expected_cut = predicted[CountBits+17:5];
    wire [CountBits+7:0] expected_limited
        = |expected_cut[CountBits+12:CountBits+8] ? {CountBits + 8{1'b1}} : expected_cut[CountBits+7:0];
    // What is added is extended to the product.
    // verilator lint_off WIDTH
    wire signed [13:0] first_half = phase ? 14'sd0 : Half <<< 1;
    wire signed [CountBits+22:0] first = first_product + first_half;
    // verilator lint_on WIDTH

    // The second: a share of the residual or its square, then a share of the weight
    wire is_near = residual[ResidualBits-1:NearBits-1] == {ResidualBits - NearBits + 1{residual[ResidualBits-1]}}
        && !(residual[ResidualBits-1] && residual[NearBits-2:0] == {NearBits - 1{1'b0}});
    wire signed [NearBits-1:0] near
        = is_near ? residual[NearBits-1:0] : residual[ResidualBits-1] ? -$signed(Nearest) : $signed(Nearest);
    // What is added is extended to the product.
    // verilator lint_off WIDTH
    wire signed [12:0] second_half = check && !phase ? 13'sd0 : Half;
    wire signed [WeightBits+FactorBits:0] second = second_product + second_half;
    // verilator lint_on WIDTH

    // The third: a share of that share or a term of the chi-square, then the other share times its slope
    wire signed [WeightBits:0] difference = $signed({1'b0, once_2}) - $signed({1'b0, twice});
    // What is added is extended to the product.
    // verilator lint_off WIDTH
    wire signed [12:0] third_half = check || phase ? 13'sd0 : Half;
    wire signed [WeightBits+14:0] third = third_product + third_half;
    // verilator lint_on WIDTH

    // The fourth: a share of the share times its slope, and times it again, or how far a square may be
    wire signed [16:0] nearest = check ? Far * $signed(Count[7:0]) : 17'sd0;
    // A product is as long as its word, but for one of a check.
    // verilator lint_off UNUSEDSIGNAL
    // What is added is extended to the product.
    // verilator lint_off WIDTH
    wire signed [WeightBits+9:0] fourth = fourth_product + nearest;
    // verilator lint_on WIDTH
    // verilator lint_on UNUSEDSIGNAL

    // The square over its variance. Shifts go in steps, the longest first: the others have fewer bits to look at.
    reg [5:0] length;
    reg [SquareBits+8:0] square_over_next, square_cut;
    reg [WeightBits+7:0] aligned_next;
    always @* begin
        length = 6'd0;
        for (i = 0; i <= WeightBits; i = i + 1) if (variances_0[i]) length = i[5:0] + 6'd1;
        square_over_next = {square_2, 9'd0};
        square_cut = square_over;
        aligned_next = {variances_1, 7'd0};
        for (i = 5; i >= 3; i = i - 1) if (bits[i]) square_over_next = square_over_next >> (1 << i);
        for (i = 2; i >= 0; i = i - 1) if (bits[i]) square_cut = square_cut >> (1 << i);
        for (i = 5; i >= 0; i = i - 1) if (bits[i]) aligned_next = aligned_next >> (1 << i);
    end
    // One adder for the sums of a pair. It is written as a difference: of an addition synthesis may swap the operands,
    // and one that is selected takes a LUT a bit more where the carries have the other.
    function signed [CountBits+23:0] plus(input signed [CountBits+23:0] sum, input signed [CountBits+23:0] more);
        // The lowest bit is the carry that went in.
        // verilator lint_off UNUSEDSIGNAL
        reg signed [CountBits+24:0] doubled;
        // verilator lint_on UNUSEDSIGNAL
        begin
            doubled = {sum, 1'b0} - {~more, 1'b1};
            plus = doubled[CountBits+24:1];
        end
    endfunction

    // To the last sum w (1 - s) comes first, and then w s (1 - s) leaves it; in a check a term of the chi-square comes.
    // Terms are extended to the sum.
    // verilator lint_off WIDTH
    wire signed [LastBits-1:0] comes = check ? $signed({1'b0, twice}) : others;
    wire signed [LastBits-1:0] changes = phase ? comes : check ? {LastBits{1'b1}} : ~mixed;
    // verilator lint_on WIDTH
    // The lowest bit is the carry that went in.
    // verilator lint_off UNUSEDSIGNAL
    wire [LastBits:0] last_doubled = {last_sum, 1'b0} - {~changes, phase};
    // verilator lint_on UNUSEDSIGNAL

    // The shorter one is extended.
    // verilator lint_off WIDTH
    wire is_far = $signed({1'b0, square_2}) > tzz;
    // verilator lint_on WIDTH

    always @(posedge clk_sys) begin
        // Operands are extended to the multipliers, and products cut to their words.
        // verilator lint_off WIDTH
        first_a <= phase ? seen_first : $signed({1'b0, expected_limited});
        first_b <= phase ? {{5{z_0[8]}}, z_0} : $signed({1'b0, gain});
        second_a <= phase ? $signed({1'b0, weight_first}) : check ? near : residual;
        second_b <= phase ? $signed({1'b0, shares_0}) : check ? near : $signed({1'b0, share});
        third_a <= phase ? difference : check ? $signed({1'b0, over}) : $signed({1'b0, once_0});
        third_b <= phase ? {{5{z_4[8]}}, z_4}
            : check ? $signed({2'd0, reciprocal, 2'd0}) : $signed({1'b0, shares_2});
        fourth_a <= check ? $signed({1'b0, weight_0}) : phase ? tz_first >>> 9 : $signed({1'b0, twice});
        fourth_b <= check ? Far : phase ? z_5 : z_4;
        first_product <= first_a * first_b;
        second_product <= second_a * second_b;
        third_product <= third_a * third_b;
        fourth_product <= fourth_a * fourth_b;
        weight_first <= first >>> 13;
        seen_first <= second >>> 12;
        square_first <= second >>> 2;
        twice_first <= third >>> 12;
        tz_first <= fourth;
        // verilator lint_on WIDTH
        square_over <= square_over_next;
        aligned <= aligned_next[5:0];
        if (phase) begin
            {weight_1, weight_0} <= {weight_0, weight_first};
            seen <= seen_first;
            {square_2, square_1, square_0} <= {square_1, square_0, square_first};
            residuals <= residual;
            unseen <= residuals - seen_first;
            {shares_2, shares_1, shares_0} <= {shares_1, shares_0, share};
            {z_5, z_4, z_3, z_2, z_1, z_0} <= {z_4, z_3, z_2, z_1, z_0, slope};
            {singles_3, singles_2, singles_1, singles_0} <= {singles_2, singles_1, singles_0, single};
            {once_2, once_1, once_0} <= {once_1, once_0, second[WeightBits+11:12]};
            others <= $signed({1'b0, weight_1}) - $signed({1'b0, once_0});
            // Products are cut to their words.
            // verilator lint_off WIDTH
            seen_z <= first;
            {variances_1, variances_0} <= {variances_0, {1'b0, weight_0} + 5'd16};
            bits <= length;
            over <= |square_cut[SquareBits+8:24] ? 24'hffffff : square_cut[23:0];
            reciprocal <= reciprocals[aligned];
            twice <= twice_first;
            mixed <= difference;
            oz <= third;
            tzz <= fourth;
            // verilator lint_on WIDTH
            tz <= tz_first;
            if (check && singles_3 && is_far) far <= 1'b1;
        end
        // What is added goes to the one that stands second, and they change places.
        changed <= phase;
        if (phase || changed) begin
            // Terms are extended to the sums.
            // verilator lint_off WIDTH
            sum_13 <= sum_12;
            sum_12 <= plus(sum_13, phase ? oz : tz);
            sum_11 <= score_1;
            score_1 <= plus(sum_11, phase ? tzz : seen_z);
            sum_23 <= sum_22;
            sum_22 <= plus(sum_23, phase ? mixed : $signed({1'b0, twice}));
            score_3 <= score_2;
            score_2 <= plus(score_3, phase ? unseen : seen);
            // verilator lint_on WIDTH
            last_sum <= last_doubled[LastBits:1];
        end
        sum_33 <= last_sum[CountBits+18:0];
        if (check) chi_square <= last_sum[BinBits+24:0];
        if (pass) begin
            changed <= 1'b0;
            // Constants are extended to the sums.
            // verilator lint_off WIDTH
            sum_11 <= {Sixteenth, 1'b0};
            {sum_12, sum_13, sum_23, score_1, score_2, score_3} <= 0;
            sum_22 <= Sixteenth;
            last_sum <= check ? 0 : Quarter;
            // verilator lint_on WIDTH
            far <= 1'b0;
            // What is on the way from a pass that was no check is no square.
            {square_0, square_1, square_2, reciprocal, twice_first} <= 0;
            // What a check has left: no scan comes between it and the next fit.
            if (Targets != 1) tzz <= 0;
        end
    end
endmodule
