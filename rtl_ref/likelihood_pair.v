`timescale 1ps / 1fs
`default_nettype none

// Another echo beside the one that is fitted, in the likelihood estimator: its light, the share r of what counts as
// ambient light then, which is neither of both, and the sums of a fit that log b has with that share.
//
// The pulse is that of likelihood_terms at another arrival. Four multipliers work twice a beat of two cycles, but for
// the last.
module likelihood_pair #(
    parameter [0:0] Used = 1'b1,                 // 0: nothing starts it, and it has no ROM
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter integer GlassBins = 0,             // see likelihood_memory
    parameter integer Targets = 2,               // see likelihood_memory; with 1, nothing is left of it
    parameter integer StepLog2 = 1,              // step of the pulse is 2 to the power of this [units]
    parameter PulseFile = "rtl_ref/pulse.mem"    // part before, slope of the pulse, slope of the part, by time
) (
    input wire clk_sys,
    input wire pass,                             // begins the sums of a pass
    input wire phase,                            // second cycle of a beat
    input wire paired,                           // the other echo has light
    input wire [BinBits+10:0] other_arrival,     // of it [units / 16]
    input wire [23:0] other_strength,            // photons a shot [2^-14]
    // likelihood_memory
    input wire word_bin,                         // the word is a bin
    input wire word_edge,                        // it is an edge alone
    input wire word_first,                       // of bin 0
    input wire [BinBits+7:0] word_end,           // where it ends [half units]
    // verilator lint_off UNUSEDSIGNAL
    input wire [25:0] glass_light,               // hazard of a glass's light [2^-22]
    // verilator lint_on UNUSEDSIGNAL
    // likelihood_terms
    input wire [25:0] ambient_light,             // hazard of ambient light, in the beat after that of a glass [2^-22]
    input wire [4:0] hazard_bits,                // bits of the bin's hazard
    input wire [9:0] hazard_reciprocal,          // of its mantissa [2^-10]
    input wire signed [CountBits+8:0] residual,  // v [2^-4 counts], 0 of what is no bin
    input wire [(CountBits > 16 ? CountBits + 8 : 24)-1:0] weight_first,  // w, in the second cycle of the next beat
    input wire [12:0] share,                     // s, the signal's in the hazard [2^-12]
    input wire signed [8:0] slope,               // z
    output reg [25:0] other_light,               // hazard of the other echo in the second cycle of a beat [2^-22]
    output reg [12:0] still_share,               // r, as likelihood_glass needs it [2^-12]
    // Sums; w has 6 fraction bits
    output reg signed [CountBits+23:0] still_13,    // of w s r z
    output reg signed [CountBits+18:0] still_23,    // of w s r
    output reg signed [CountBits+18:0] still_33,    // of w r r
    output reg signed [CountBits+18:0] still_score  // of v r
);
    localparam integer WeightBits = CountBits + 8 > 24 ? CountBits + 8 : 24, ResidualBits = CountBits + 9;
    localparam integer WordBits = CountBits + 19, TimeBits = BinBits + 12;
    localparam [25:0] MostHazard = 26'h3ffffff;
    localparam [0:0] Glass = GlassBins != 0, HasSecond = Targets != 1;
    localparam [WordBits-1:0] Quarter = 16;
    localparam signed [12:0] Half = 2048;        // of what is cut off a product, to round it

    reg bin_0, bin_1, bin_2, edge_alone_0, edge_alone_1, edge_alone_2, first_0, first_1, first_2;  // words on the way
    reg signed [TimeBits-1:0] from_arrival;      // where a word ends [units / 16]
    reg [10:0] place;                            // of a word of the pulse around that time
    reg [16:0] fetched_part, low_part_0, low_part_1;  // of these words
    reg [3:0] sixteenths_0, sixteenths_1;        // how far the time is from one to the other
    reg [16:0] rise;                             // from the one part to the other
    // What is below a part of the pulse is cut off.
    // verilator lint_off UNUSEDSIGNAL
    reg [20:0] risen;                            // up to the time [1 / 16]
    // verilator lint_on UNUSEDSIGNAL
    reg [16:0] pulse_part, last_part, part;      // part of the pulse before the word's end, before its begin, in it
    reg [23:0] level;                            // of the light, and the hazard as it is shifted
    reg [16:0] amount;                           // the part, and the reciprocal
    reg [40:0] level_product;                    // their product
    // What is below a hazard or a share is cut off.
    // verilator lint_off UNUSEDSIGNAL
    reg [41:0] level_times;                      // and half of what is cut off it
    // verilator lint_on UNUSEDSIGNAL
    reg [25:0] lit;                              // the other echo's hazard, one cycle ahead
    reg [25:0] last_glass;                       // of a glass in the beat before
    reg [25:0] still_light_0, still_light_1, still_light_2;   // of ambient light and the glass together
    reg [13:0] aligned;                          // that hazard, shifted as the bin's mantissa is
    reg [12:0] share_first, shares_0, shares_1, shares_2, shares_3, shares_4;  // r
    reg [12:0] echo_shares_0, echo_shares_1, echo_shares_2;   // s
    reg signed [8:0] z_0, z_1, z_2, z_3;
    reg signed [WeightBits:0] first_a;           // v and w in turn
    reg signed [13:0] first_b, second_b;         // r; s and r in turn
    reg signed [WeightBits+14:0] first_product, second_product;
    reg signed [ResidualBits-1:0] seen;          // v r
    reg [WeightBits-1:0] once, second_a;         // w r
    reg [WeightBits-1:0] both, square, third_a;  // w s r, w r r
    reg signed [8:0] third_b;
    reg signed [WeightBits+8:0] third_product, both_z;        // w s r z

`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg [34:0] pulse [0:2047];

    initial begin
        if (Used && HasSecond) $readmemh(PulseFile, pulse);
        {other_light, still_share, still_13, still_23, still_33, still_score} = 0;
        {bin_0, bin_1, bin_2, edge_alone_0, edge_alone_1, edge_alone_2, first_0, first_1, first_2} = 0;
        {from_arrival, place, fetched_part, low_part_0, low_part_1, sixteenths_0, sixteenths_1, rise, risen} = 0;
        {pulse_part, last_part, part, level, amount, level_product, level_times, lit} = 0;
        {last_glass, still_light_0, still_light_1, still_light_2, aligned, share_first} = 0;
        {shares_0, shares_1, shares_2, shares_3, shares_4, echo_shares_0, echo_shares_1, echo_shares_2} = 0;
        {z_0, z_1, z_2, z_3, first_a, first_b, first_product, second_a, second_b, second_product} = 0;
        {third_a, third_b, third_product, seen, once, both, square, both_z} = 0;
    end

    // The pulse at the word's end
    wire signed [TimeBits-1:0] steps = from_arrival >>> (StepLog2 + 4);
    wire below = steps[TimeBits-1] && !(&steps[TimeBits-2:10]);
    wire above = !steps[TimeBits-1] && (|steps[TimeBits-2:10] || &steps[9:0]);
    wire [10:0] low_place = below ? 11'd0 : above ? 11'd2046 : {!steps[10], steps[9:0]};
    // Only the sixteenths of a step are used.
    // verilator lint_off UNUSEDSIGNAL
    wire signed [TimeBits-1:0] fine_steps = from_arrival >>> StepLog2;
    // verilator lint_on UNUSEDSIGNAL

    // In fabric, two bits of a factor at a time
    // Both are extended to the sum.
    // verilator lint_off WIDTH
    wire [18:0] thrice_rise = rise + {rise, 1'b0};
    // verilator lint_on WIDTH
    wire [18:0] rise_low = row(sixteenths_1[1:0], rise, thrice_rise);
    wire [18:0] rise_high = (rise_low >> 2) + row(sixteenths_1[3:2], rise, thrice_rise);
    function [18:0] row(input [1:0] two, input [16:0] once_more, input [18:0] thrice);
        // Each is extended to the row.
        // verilator lint_off WIDTH
        row = !two[1] ? (two[0] ? once_more : 19'd0) : two[0] ? thrice : {once_more, 1'b0};
        // verilator lint_on WIDTH
    endfunction

    // Of ambient light and of a glass
    wire [26:0] stills = {1'b0, ambient_light} + {1'b0, last_glass};

    // The hazard as it is shifted, the longest way first: the others have fewer bits to look at.
    reg [51:0] shifted;
    integer i;
    always @* begin
        shifted = {still_light_2, 26'd0};
        for (i = 4; i >= 0; i = i - 1) if (hazard_bits[i]) shifted = shifted >> (1 << i);
    end
    wire [30:0] share_whole = level_times[41:11];

    // What is added is extended to the products.
    // verilator lint_off WIDTH
    // A product is cut to its words.
    // verilator lint_off UNUSEDSIGNAL
    wire signed [WeightBits+14:0] first = first_product + Half, second = second_product + Half;
    // The parts and slopes of the pulse's words are those of likelihood_terms.
    wire [34:0] pulse_word = pulse[place];
    // verilator lint_on UNUSEDSIGNAL
    wire [41:0] times = level_product + (phase ? 11'd1024 : 11'd256);
    // verilator lint_on WIDTH

    always @(posedge clk_sys) if (HasSecond) begin
        // What the first cycle of a beat comes to is taken over in the second.
        from_arrival <= $signed({1'b0, word_end, 3'd0}) - $signed({1'b0, other_arrival});
        place <= low_place + {10'd0, !phase};
        fetched_part <= pulse_word[34:18];
        rise <= fetched_part - low_part_0;
        risen <= {rise_high, rise_low[1:0]};
        pulse_part <= low_part_1 + risen[20:4];
        level <= phase ? {10'd0, aligned} : paired ? other_strength : 24'd0;
        amount <= phase ? {7'd0, hazard_reciprocal} : part;
        level_product <= level * amount;
        level_times <= times;
        lit <= |level_times[41:35] ? MostHazard : level_times[34:9];
        other_light <= lit;
        share_first <= share_whole > 31'd4096 ? 13'd4096 : share_whole[12:0];
        // Operands are extended to the multipliers.
        // verilator lint_off WIDTH
        first_a <= phase ? $signed({1'b0, weight_first}) : residual;
        // verilator lint_on WIDTH
        first_b <= $signed({1'b0, phase ? shares_3 : shares_2});
        first_product <= first_a * first_b;
        second_a <= once;
        second_b <= $signed({1'b0, phase ? still_share : echo_shares_2});
        second_product <= $signed({1'b0, second_a}) * second_b;
        if (!phase) begin
            seen <= first[ResidualBits+11:12];
            both <= second[WeightBits+11:12];
            // The sign bit of a weight is none.
            // verilator lint_off WIDTH
            third_product <= $signed({1'b0, third_a}) * third_b;
            // verilator lint_on WIDTH
        end else begin
            {sixteenths_1, sixteenths_0} <= {sixteenths_0, fine_steps[3:0]};
            {low_part_1, low_part_0} <= {low_part_0, fetched_part};
            {bin_2, bin_1, bin_0} <= {bin_1, bin_0, word_bin};
            {edge_alone_2, edge_alone_1, edge_alone_0} <= {edge_alone_1, edge_alone_0, word_edge};
            {first_2, first_1, first_0} <= {first_1, first_0, word_first};
            last_part <= edge_alone_2 && first_2 ? 17'd0 : pulse_part;
            part <= bin_2 ? pulse_part - last_part : 17'd0;
            if (Glass) last_glass <= glass_light;
            {still_light_2, still_light_1} <= {still_light_1, still_light_0};
            still_light_0 <= stills[26] ? MostHazard : stills[25:0];
            aligned <= shifted[25:12];
            {still_share, shares_4, shares_3, shares_2, shares_1, shares_0}
                <= {shares_4, shares_3, shares_2, shares_1, shares_0, share_first};
            {echo_shares_2, echo_shares_1, echo_shares_0} <= {echo_shares_1, echo_shares_0, share};
            {z_3, z_2, z_1, z_0} <= {z_2, z_1, z_0, slope};
            once <= first[WeightBits+11:12];
            square <= second[WeightBits+11:12];
            {third_a, third_b} <= {both, z_3};
            both_z <= third_product;
            // Terms are extended to the sums.
            // verilator lint_off WIDTH
            still_score <= still_score + seen;
            still_23 <= still_23 + $signed({1'b0, both});
            still_33 <= still_33 + $signed({1'b0, square});
            still_13 <= still_13 + both_z;
            // verilator lint_on WIDTH
        end
        if (pass) begin
            // The ridge is extended to the sum.
            {still_13, still_23, still_score} <= 0;
            still_33 <= Quarter;
        end
    end
endmodule
