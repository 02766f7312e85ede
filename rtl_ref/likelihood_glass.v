`timescale 1ps / 1fs
`default_nettype none

// Cover glass in the likelihood estimator: the hazard of its light, its share g of a bin's hazard, and what the sums of
// a fit have more for the logarithm of this light.
//
// Four multipliers work twice a beat of two cycles, but for the last.
module likelihood_glass #(
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter integer Targets = 1                // see likelihood_memory
) (
    input wire clk_sys,
    input wire pass,                             // begins the sums of a pass
    input wire phase,                            // second cycle of a beat
    input wire [23:0] glass,                     // light of the glass, photons a shot [2^-14]
    input wire [16:0] word_glass,                // the part of it in a bin [2^-17]
    // likelihood_terms
    input wire [4:0] hazard_bits,                // bits of the bin's hazard
    input wire [9:0] hazard_reciprocal,          // of its mantissa [2^-10]
    input wire signed [CountBits+8:0] residual,  // v [2^-4 counts], 0 of what is no bin
    input wire [(CountBits > 16 ? CountBits + 8 : 24)-1:0] weight_first,  // w, in the second cycle of the next beat
    input wire [12:0] share,                     // s, the signal's in the hazard [2^-12]
    input wire signed [8:0] slope,               // z
    // verilator lint_off UNUSEDSIGNAL
    input wire paired,                           // another echo has light: ambient light has a share of its own
    input wire [12:0] still_share,               // r, that one [2^-12]
    // verilator lint_on UNUSEDSIGNAL
    output reg [25:0] glass_light,               // hazard of the light in the second cycle of a beat [2^-22]
    // Sums; w has 6 fraction bits
    output reg signed [CountBits+23:0] sum_14,   // of w s g z
    output reg signed [CountBits+18:0] sum_24,   // of w s g
    output reg signed [CountBits+18:0] sum_34,   // of w (1 - s) g
    output reg signed [CountBits+18:0] sum_44,   // of w g g
    output reg signed [CountBits+18:0] score_4   // of v g
);
    localparam integer WeightBits = CountBits + 8 > 24 ? CountBits + 8 : 24, ResidualBits = CountBits + 9;
    localparam integer WordBits = CountBits + 19;
    localparam [0:0] HasSecond = Targets != 1;
    localparam integer FactorBits = HasSecond ? 14 : 9, ProductBits = WeightBits + FactorBits;
    localparam [25:0] MostHazard = 26'h3ffffff;
    localparam [WordBits-1:0] Sixteenth = 4;
    localparam signed [12:0] Half = 2048;        // of what is cut off a product, to round it

    reg [16:0] parts_0, parts_1, parts_2, parts_3;            // of the light on the way
    reg [23:0] level;                                         // of the light, and the hazard as it is shifted
    reg [16:0] amount;                                        // the part, and the reciprocal
    reg [40:0] level_product;                                 // their product
    // What is below a hazard or a share is cut off.
    // verilator lint_off UNUSEDSIGNAL
    reg [41:0] level_times;                                   // and half of what is cut off it
    // verilator lint_on UNUSEDSIGNAL
    reg [25:0] light;                                         // the hazard, one cycle ahead
    reg [25:0] hazards_0, hazards_1, hazards_2, hazards_3;    // on the way
    reg [13:0] aligned;                                       // the hazard, shifted as the bin's mantissa is
    reg [12:0] share_first, shares_0, shares_1, shares_2, shares_3, shares_4, shares_5;  // g
    reg [12:0] echo_shares_0, echo_shares_1, echo_shares_2;   // s
    reg signed [8:0] z_0, z_1, z_2, z_3;
    reg signed [WeightBits:0] first_a;                        // v and w in turn
    reg signed [13:0] first_b, second_b;                      // g; s and g in turn
    reg signed [WeightBits+14:0] first_product, second_product;
    reg signed [ResidualBits-1:0] seen;                       // v g
    reg [WeightBits-1:0] once_0, once_1, second_a;            // w g
    reg [WeightBits-1:0] both, square, third_a;               // w s g, w g g
    reg signed [FactorBits-1:0] third_b;
    reg signed [ProductBits-1:0] third_product;
    reg signed [WeightBits+8:0] both_z;                       // w s g z
    reg [WeightBits-1:0] still;                               // w g r

    initial begin
        {glass_light, sum_14, sum_24, sum_34, sum_44, score_4} = 0;
        {parts_0, parts_1, parts_2, parts_3, level, amount, level_product, level_times, light} = 0;
        {hazards_0, hazards_1, hazards_2, hazards_3, aligned, share_first} = 0;
        {shares_0, shares_1, shares_2, shares_3, shares_4, shares_5} = 0;
        {echo_shares_0, echo_shares_1, echo_shares_2, z_0, z_1, z_2, z_3} = 0;
        {first_a, first_b, first_product, second_a, second_b, second_product, third_a, third_b, third_product} = 0;
        {seen, once_0, once_1, both, square, both_z, still} = 0;
    end

    // The hazard as it is shifted, the longest way first: the others have fewer bits to look at.
    reg [51:0] shifted;
    integer i;
    always @* begin
        shifted = {hazards_3, 26'd0};
        for (i = 4; i >= 0; i = i - 1) if (hazard_bits[i]) shifted = shifted >> (1 << i);
    end
    wire [30:0] share_whole = level_times[41:11];

    // What is added is extended to the products.
    // verilator lint_off WIDTH
    // A product is cut to its words.
    // verilator lint_off UNUSEDSIGNAL
    wire signed [WeightBits+14:0] first = first_product + Half, second = second_product + Half;
    wire signed [WeightBits+14:0] third = third_product + Half;
    // verilator lint_on UNUSEDSIGNAL
    wire [41:0] times = level_product + (phase ? 11'd1024 : 11'd256);
    // verilator lint_on WIDTH

    always @(posedge clk_sys) begin
        level <= phase ? {10'd0, aligned} : glass;
        amount <= phase ? {7'd0, hazard_reciprocal} : parts_3;
        level_product <= level * amount;
        level_times <= times;
        light <= |level_times[41:35] ? MostHazard : level_times[34:9];
        glass_light <= light;
        share_first <= share_whole > 31'd4096 ? 13'd4096 : share_whole[12:0];
        // Operands are extended to the multipliers.
        // verilator lint_off WIDTH
        first_a <= phase ? $signed({1'b0, weight_first}) : residual;
        // verilator lint_on WIDTH
        first_b <= $signed({1'b0, phase ? shares_3 : shares_2});
        first_product <= first_a * first_b;
        second_a <= once_0;
        second_b <= $signed({1'b0, phase ? shares_5 : echo_shares_2});
        second_product <= $signed({1'b0, second_a}) * second_b;
        if (!phase) begin
            seen <= first[ResidualBits+11:12];
            both <= second[WeightBits+11:12];
            // The sign bit of a weight is none.
            // verilator lint_off WIDTH
            third_product <= $signed({1'b0, third_a}) * third_b;
            if (HasSecond) begin
                {third_a, third_b} <= {once_0, 1'b0, still_share};
                still <= third[WeightBits+11:12];
            end
            // verilator lint_on WIDTH
        end else begin
            {parts_3, parts_2, parts_1, parts_0} <= {parts_2, parts_1, parts_0, word_glass};
            {hazards_3, hazards_2, hazards_1, hazards_0} <= {hazards_2, hazards_1, hazards_0, glass_light};
            aligned <= shifted[25:12];
            {shares_5, shares_4, shares_3, shares_2, shares_1, shares_0}
                <= {shares_4, shares_3, shares_2, shares_1, shares_0, share_first};
            {echo_shares_2, echo_shares_1, echo_shares_0} <= {echo_shares_1, echo_shares_0, share};
            {z_3, z_2, z_1, z_0} <= {z_2, z_1, z_0, slope};
            {once_1, once_0} <= {once_0, first[WeightBits+11:12]};
            square <= second[WeightBits+11:12];
            third_a <= both;
            // Words are extended to the multiplier, and products cut to words.
            // verilator lint_off WIDTH
            third_b <= z_3;
            both_z <= third_product;
            if (HasSecond) third_product <= $signed({1'b0, third_a}) * third_b;
            // verilator lint_on WIDTH
            // Terms are extended to the sums.
            // verilator lint_off WIDTH
            score_4 <= score_4 + seen;
            sum_24 <= sum_24 + $signed({1'b0, both});
            sum_34 <= sum_34 + (HasSecond && paired ? $signed({1'b0, still})
                : $signed({1'b0, once_1}) - $signed({1'b0, both}));
            sum_44 <= sum_44 + $signed({1'b0, square});
            sum_14 <= sum_14 + both_z;
            // verilator lint_on WIDTH
        end
        if (pass) begin
            // The ridge is extended to the sum.
            {sum_14, sum_24, sum_34, score_4} <= 0;
            sum_44 <= Sixteenth;
        end
    end
endmodule
