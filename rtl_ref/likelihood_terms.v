`timescale 1ps / 1fs
`default_nettype none

// What a bin says of a point, in the likelihood estimator: residual, what is expected, and the signal's share.
//
// A bin goes on for sixteen beats of two cycles each; two multipliers work twice a beat.
module likelihood_terms #(
    parameter [0:0] Used = 1'b1,                 // 0: nothing starts it, and it has no ROMs
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter integer GlassBins = 0,             // see likelihood_memory
    parameter integer Targets = 1,               // see likelihood_memory
    parameter integer StepLog2 = 1,              // step of the pulse is 2 to the power of this [units]
    parameter PulseFile = "rtl_ref/pulse.mem",   // part before, slope of the pulse, slope of the part, by time
    parameter HazardFile = "rtl_ref/hazard.mem"  // lambda / (1 - exp(-lambda)) each quarter, and what it grows by
) (
    input wire clk_sys,
    input wire phase,                            // second cycle of a beat
    input wire scan,                             // without signal, unless there is a glass or a second target
    // verilator lint_off UNUSEDSIGNAL
    input wire dark,                             // without signal, if there is one
    input wire [25:0] glass_light,               // hazard of its light [2^-22]
    input wire [25:0] other_light,               // of the other echo [2^-22]
    // verilator lint_on UNUSEDSIGNAL
    input wire [BinBits+10:0] arrival,           // of the echo [units / 16]
    input wire [23:0] strength,                  // photons a shot [2^-14]
    input wire [23:0] ambient,                   // hazard of ambient light [2^-30 / unit]
    input wire word_bin,                         // the word is a bin
    input wire word_rest,                        // it stands for all other bins
    input wire word_edge,                        // it is an edge alone
    input wire word_slide,                       // a box goes on with it
    input wire word_first,                       // of bin 0
    input wire [CountBits+BinBits-1:0] word_ended,    // shots that end in it
    input wire [CountBits+BinBits-1:0] word_waiting,  // shots that wait when it begins
    input wire [9:0] word_width,                 // its width [units]
    input wire [BinBits+7:0] word_end,           // where it ends [half units]
    output reg signed [CountBits+8:0] residual,  // v [2^-4 counts], 0 of what is no bin
    output reg [CountBits+17:0] predicted,        // R lambda [2^-12 counts]
    output reg [12:0] gain,                      // lambda / (exp(lambda) - 1) [2^-12]
    output reg [12:0] share,                     // the signal's in the hazard [2^-12]
    output reg signed [8:0] slope,               // of the pulse's logarithm
    output reg [CountBits:0] middle,             // twice the shots that wait in the middle of a bin
    output reg waits,                            // shots wait at it
    output reg single,                           // the residual is that of a single bin
    output reg slide,                            // a box goes on with it
    output reg [4:0] hazard_bits,                // bits of the hazard
    output reg [9:0] hazard_reciprocal,          // of its mantissa [2^-10]
    output reg [25:0] ambient_light              // hazard of ambient light [2^-22]
);
    localparam integer RestBits = CountBits + BinBits, TimeBits = BinBits + 12;
    localparam integer EndedBits = RestBits + 17, WaitingProductBits = RestBits + 14;
    localparam integer ExpectedBits = CountBits + 18, ResidualBits = CountBits + 9;
    localparam [25:0] MostHazard = 26'h3ffffff;
    localparam [0:0] Glass = GlassBins != 0, HasSecond = Targets != 1, MoreLight = Glass || HasSecond;
    localparam integer HazardSumBits = MoreLight ? 28 : 27;

    // Words on the way
    reg bin_0, bin_1, bin_2, bin_3, bin_4, bin_5, bin_6, bin_7, bin_8, bin_9, bin_10, bin_11, bin_12, bin_13,
        bin_14;
    reg rest_0, rest_1, rest_2, rest_3, rest_4, rest_5, rest_6, rest_7, rest_8, rest_9, rest_10, rest_11,
        rest_12, rest_13, rest_14;
    reg slides_0, slides_1, slides_2, slides_3, slides_4, slides_5, slides_6, slides_7, slides_8, slides_9,
        slides_10, slides_11, slides_12, slides_13, slides_14;
    reg edge_alone_0, edge_alone_1, edge_alone_2, first_0, first_1, first_2;
    reg [RestBits-1:0] ended_0, ended_1, ended_2, ended_3, ended_4, ended_5, ended_6, ended_7, ended_8, ended_9,
        ended_10, ended_11;
    reg [RestBits-1:0] waiting_0, waiting_1, waiting_2, waiting_3, waiting_4, waiting_5, waiting_6, waiting_7,
        waiting_8, waiting_9, waiting_10, waiting_11;
    reg [9:0] width_0, width_1, width_2, width_3;
    reg [CountBits:0] middles_0, middles_1, middles_2;
    reg awaited_0, awaited_1, awaited_2;
    reg signed [TimeBits-1:0] from_arrival;      // where a word ends [units / 16]
    reg [10:0] place;                            // of a word of the pulse around that time
    reg [16:0] fetched_part, low_part_0, low_part_1;  // of these words
    reg signed [8:0] fetched_slope, fetched_first, low_slope_0, low_slope_1, low_first_0, low_first_1;
    reg [3:0] sixteenths_0, sixteenths_1;        // how far the time is from one to the other
    reg [16:0] rise;                             // from the one part to the other
    // What is below a part of the pulse is cut off.
    // verilator lint_off UNUSEDSIGNAL
    reg [20:0] risen;                            // up to the time [1 / 16]
    // verilator lint_on UNUSEDSIGNAL
    reg [16:0] pulse_part;                       // part of the pulse before the word's end
    reg signed [8:0] pulse_slope, pulse_first;   // slope there, and that of the part
    reg [16:0] last_part;                        // the same at the end of the bin before
    reg signed [8:0] last_slope;
    reg [16:0] part;                             // part of the pulse in the bin
    reg signed [8:0] z_0, z_1, z_2, z_3, z_4, z_5, z_6, z_7, z_8, z_9, z_10, z_11;
    reg [23:0] level;                            // of the signal and of ambient light in turn
    reg [16:0] amount;                           // of it in the bin
    reg [40:0] level_product;                    // their product
    // What is below a hazard is cut off.
    // verilator lint_off UNUSEDSIGNAL
    reg [41:0] level_times;                      // and half of what is cut off it
    // verilator lint_on UNUSEDSIGNAL
    reg [25:0] light, lit_first, lit;            // hazards of both in turn, and of the signal
    reg [HazardSumBits-1:0] sum;                 // of both
    // Of the last one only what k is less by is used.
    // verilator lint_off UNUSEDSIGNAL
    reg [25:0] hazard_0, hazard_1, hazard_2, hazard_3, hazard_4;  // within its limits
    // verilator lint_on UNUSEDSIGNAL
    reg [25:0] signal_hazard_0, signal_hazard_1;
    reg [4:0] bits_0, bits_1, bits_2, bits_3, bits_4;  // of the hazard
    reg [13:0] mantissa_first, mantissa_0, mantissa_1, mantissa_2;  // the hazard's
    reg [13:0] aligned;                          // the signal's hazard, as it is shifted
    reg [9:0] few;                               // factors of what k grows by and of the share in turn
    reg [16:0] many;
    reg [18:0] triple;                           // three times the second
    reg [22:0] begun;                            // product with the low six bits of the first
    reg [3:0] few_left;                          // the others
    reg [16:0] many_left;
    reg [18:0] triple_left;
    // What is below k is cut off.
    // verilator lint_off UNUSEDSIGNAL
    reg [23:0] grown;                            // what k grows by within a quarter, and then the share
    // verilator lint_on UNUSEDSIGNAL
    reg [16:0] k_before, k;                      // lambda / (1 - exp(-lambda)) [2^-12], and at the quarter before
    reg [12:0] gains_0, gains_1, gains_2;
    reg [12:0] share_first, shares_0, shares_1, shares_2;
    reg [RestBits-1:0] shots;                    // that end and that wait in turn
    reg [16:0] factor;                           // k and the mantissa in turn
    reg [EndedBits-1:0] shots_product;           // their product
    reg [23:0] half;                             // half of what is cut off it
    reg [EndedBits-1:0] ended_k_first, ended_k_0, ended_k_1;  // n k, and half of what is cut off
    reg [WaitingProductBits-1:0] product;        // R times the mantissa, and half of what is cut off
    reg [4:0] down;                              // by how much that is shifted
    reg [WaitingProductBits+1:0] expected_first; // the product after the longest shifts
    reg [ExpectedBits-1:0] product_shifted;      // R lambda
    reg signed [EndedBits:0] surplus;            // n k less that

`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg [34:0] pulse [0:2047];
    reg [27:0] hazards [0:63];
    reg [9:0] reciprocals [0:63];

    integer i;
    initial begin
        if (Used) $readmemh(PulseFile, pulse);
        if (Used) $readmemh(HazardFile, hazards);
        // 1024 over 1 + (i + 1/2) / 64, rounded
        // A reciprocal is computed as an integer.
        // verilator lint_off WIDTH
        for (i = 0; i < 64; i = i + 1) reciprocals[i] = (262144 + 129 + 2 * i) / (2 * (129 + 2 * i));
        // verilator lint_on WIDTH
    end

    initial begin
        {residual, predicted, gain, share, slope, middle, waits, single, slide, hazard_bits, hazard_reciprocal} = 0;
        ambient_light = 26'd0;
        {bin_0, bin_1, bin_2, bin_3, bin_4, bin_5, bin_6, bin_7, bin_8, bin_9, bin_10, bin_11, bin_12, bin_13, bin_14}
            = 0;
        {rest_0, rest_1, rest_2, rest_3, rest_4, rest_5, rest_6, rest_7, rest_8, rest_9, rest_10, rest_11, rest_12,
            rest_13, rest_14} = 0;
        {slides_0, slides_1, slides_2, slides_3, slides_4, slides_5, slides_6, slides_7, slides_8, slides_9,
            slides_10, slides_11, slides_12, slides_13, slides_14} = 0;
        {edge_alone_0, edge_alone_1, edge_alone_2, first_0, first_1, first_2, width_0, width_1, width_2, width_3,
            middles_0, middles_1, middles_2, awaited_0, awaited_1, awaited_2} = 0;
        {ended_0, ended_1, ended_2, ended_3, ended_4, ended_5, ended_6, ended_7, ended_8, ended_9, ended_10, ended_11}
            = 0;
        {waiting_0, waiting_1, waiting_2, waiting_3, waiting_4, waiting_5, waiting_6, waiting_7, waiting_8, waiting_9,
            waiting_10, waiting_11} = 0;
        {from_arrival, place, fetched_part, low_part_0, low_part_1, fetched_slope, fetched_first, low_slope_0,
            low_slope_1, low_first_0, low_first_1, sixteenths_0, sixteenths_1, rise, risen} = 0;
        {pulse_part, pulse_slope, pulse_first, last_part, last_slope, part} = 0;
        {z_0, z_1, z_2, z_3, z_4, z_5, z_6, z_7, z_8, z_9, z_10, z_11} = 0;
        {level, amount, level_product, level_times, light, lit_first, lit, sum, hazard_0, hazard_1, hazard_2,
            hazard_3, hazard_4, signal_hazard_0, signal_hazard_1} = 0;
        {bits_0, bits_1, bits_2, bits_3, bits_4, mantissa_first, mantissa_0, mantissa_1, mantissa_2, aligned, few,
            many, triple, begun, few_left, many_left, triple_left} = 0;
        {grown, k_before, k, gains_0, gains_1, gains_2, share_first, shares_0, shares_1, shares_2} = 0;
        {shots, factor, shots_product, half, ended_k_first, ended_k_0, ended_k_1, product, down, expected_first,
            product_shifted, surplus} = 0;
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

    // What of it is in the bin, and the slope between its ends
    wire none = edge_alone_2 && first_2;
    // Half of the sum is used.
    // verilator lint_off UNUSEDSIGNAL
    wire signed [9:0] slopes = {pulse_slope[8], pulse_slope} + {last_slope[8], last_slope};
    // verilator lint_on UNUSEDSIGNAL

    // The hazard
    wire [25:0] light_limited = |level_times[41:35] ? MostHazard : level_times[34:9];
    wire too_low = sum[HazardSumBits-1:2] == 0;  // below 4, the least that it may be
    wire [25:0] limited = |sum[HazardSumBits-1:26] ? MostHazard : {sum[25:3], too_low || sum[2], too_low ? 2'd0 : sum[1:0]};

    // Its mantissa, then the signal's part as it is shifted. Shifts go in steps, the longest first: the others have
    // fewer bits to look at.
    reg [4:0] length;
    reg [51:0] shifted;
    always @* begin
        length = 5'd0;
        for (i = 0; i < 26; i = i + 1) if (hazard_0[i]) length = i[4:0] + 5'd1;
        shifted = {phase ? signal_hazard_1 : hazard_1, 26'd0};
        for (i = 4; i >= 0; i = i - 1) if (bits_0[i]) shifted = shifted >> (1 << i);
    end

    // In fabric, where multipliers are needed elsewhere: what k grows by, then the share. Two bits of a factor are
    // taken at a time, and the lowest bits of the sum are done with; three such rows come before a register.
    wire [27:0] hazard_word = hazards[hazard_2[25:20]];
    wire [9:0] reciprocal = reciprocals[mantissa_0[12:7]];
    wire [16:0] many_next = phase ? {3'd0, aligned} : {6'd0, hazard_word[10:0]};
    reg [18:0] sums_low, sums_high;
    reg [22:0] begun_next;
    // No product and no share is so large.
    // verilator lint_off UNUSEDSIGNAL
    reg [26:0] grown_next;
    // verilator lint_on UNUSEDSIGNAL
    always @* begin
        sums_low = 19'd0;
        begun_next = 23'd0;
        for (i = 0; i < 6; i = i + 2) begin
            sums_low = (sums_low >> 2) + row(few[i +: 2], many, triple);
            begun_next[i +: 2] = sums_low[1:0];
        end
        begun_next[22:6] = sums_low[18:2];
        // It is extended to the rows.
        // verilator lint_off WIDTH
        sums_high = begun[22:6] + row(few_left[1:0], many_left, triple_left);
        // verilator lint_on WIDTH
        grown_next[7:0] = {sums_high[1:0], begun[5:0]};
        sums_high = (sums_high >> 2) + row(few_left[3:2], many_left, triple_left);
        grown_next[26:8] = sums_high;
    end
    function [18:0] row(input [1:0] two, input [16:0] once, input [18:0] thrice);
        // Each is extended to the row.
        // verilator lint_off WIDTH
        row = !two[1] ? (two[0] ? once : 19'd0) : two[0] ? thrice : {once, 1'b0};
        // verilator lint_on WIDTH
    endfunction
    wire [13:0] share_rounded = {1'b0, grown[23:11]} + {13'd0, grown[10]};

    // Shots times k or the mantissa
    // The half is extended to the product.
    // verilator lint_off WIDTH
    wire [EndedBits-1:0] times = shots_product + half;
    // verilator lint_on WIDTH

    // R lambda from its mantissa
    reg [WaitingProductBits+1:0] expected_next, expected;
    always @* begin
        expected_next = {product, 2'd0};
        for (i = 4; i >= 3; i = i - 1) if (down[i]) expected_next = expected_next >> (1 << i);
        expected = expected_first;
        for (i = 2; i >= 0; i = i - 1) if (down[i]) expected = expected >> (1 << i);
    end

    // The residual
    wire any = bin_14 || rest_14;
    wire surplus_fits = surplus[EndedBits:ResidualBits+7] == {EndedBits - 6 - ResidualBits{surplus[EndedBits]}};
    wire [ResidualBits-1:0] surplus_limited = surplus_fits ? surplus[ResidualBits+7:8]
        : {surplus[EndedBits], {ResidualBits - 1{!surplus[EndedBits]}}};
    wire [CountBits:0] twice = {waiting_11[CountBits-1:0], 1'b0};
    // Twice the other has a bit more.
    // verilator lint_off WIDTH
    wire [CountBits:0] once = ended_11[CountBits-1:0];
    // verilator lint_on WIDTH
    wire [CountBits+1:0] between = {1'b0, twice} - {1'b0, once};

    always @(posedge clk_sys) begin
        // What the first cycle of a beat comes to is taken over in the second.
        from_arrival <= $signed({1'b0, word_end, 3'd0}) - $signed({1'b0, arrival});
        place <= low_place + {10'd0, !phase};
        {fetched_part, fetched_slope, fetched_first} <= pulse[place];
        rise <= fetched_part - low_part_0;
        risen <= {rise_high, rise_low[1:0]};
        pulse_part <= low_part_1 + risen[20:4];
        {pulse_slope, pulse_first} <= {low_slope_1, low_first_1};
        level <= phase ? ambient : strength;
        amount <= phase ? {6'd0, width_3, 1'b0} : part;
        level_product <= level * amount;
        // Both are extended to the sum.
        // verilator lint_off WIDTH
        level_times <= level_product + 9'd256;
        // verilator lint_on WIDTH
        light <= light_limited;
        lit_first <= light;
        mantissa_first <= shifted[25:12];
        few <= phase ? reciprocal : hazard_2[19:10];
        many <= many_next;
        // Both are extended to the sum.
        // verilator lint_off WIDTH
        triple <= many_next + {many_next, 1'b0};
        // verilator lint_on WIDTH
        begun <= begun_next;
        few_left <= few[9:6];
        {many_left, triple_left} <= {many, triple};
        grown <= grown_next[23:0];
        share_first <= share_rounded > 14'd4096 ? 13'd4096 : share_rounded[12:0];
        shots <= phase ? waiting_11 : ended_11;
        factor <= phase ? {3'd0, mantissa_2} : k;
        shots_product <= shots * factor;
        half <= phase ? 24'd128 : 24'd1 << (5'd23 - bits_4);
        ended_k_first <= times;
        expected_first <= expected_next;
        surplus <= $signed({1'b0, ended_k_1}) - $signed({{EndedBits - ExpectedBits + 1{1'b0}}, product_shifted});
        if (phase) begin
            {sixteenths_1, sixteenths_0} <= {sixteenths_0, fine_steps[3:0]};
            {low_part_1, low_slope_1, low_first_1} <= {low_part_0, low_slope_0, low_first_0};
            {low_part_0, low_slope_0, low_first_0} <= {fetched_part, fetched_slope, fetched_first};
            {bin_14, bin_13, bin_12, bin_11, bin_10, bin_9, bin_8, bin_7, bin_6, bin_5, bin_4, bin_3, bin_2, bin_1,
                    bin_0}
                <= {bin_13, bin_12, bin_11, bin_10, bin_9, bin_8, bin_7, bin_6, bin_5, bin_4, bin_3, bin_2, bin_1,
                    bin_0, word_bin};
            {rest_14, rest_13, rest_12, rest_11, rest_10, rest_9, rest_8, rest_7, rest_6, rest_5, rest_4, rest_3,
                    rest_2, rest_1, rest_0}
                <= {rest_13, rest_12, rest_11, rest_10, rest_9, rest_8, rest_7, rest_6, rest_5, rest_4, rest_3, rest_2,
                    rest_1, rest_0, word_rest};
            {slides_14, slides_13, slides_12, slides_11, slides_10, slides_9, slides_8, slides_7, slides_6, slides_5,
                    slides_4, slides_3, slides_2, slides_1, slides_0}
                <= {slides_13, slides_12, slides_11, slides_10, slides_9, slides_8, slides_7, slides_6, slides_5,
                    slides_4, slides_3, slides_2, slides_1, slides_0, word_slide};
            {ended_11, ended_10, ended_9, ended_8, ended_7, ended_6, ended_5, ended_4, ended_3, ended_2, ended_1,
                    ended_0}
                <= {ended_10, ended_9, ended_8, ended_7, ended_6, ended_5, ended_4, ended_3, ended_2, ended_1, ended_0,
                    word_ended};
            {waiting_11, waiting_10, waiting_9, waiting_8, waiting_7, waiting_6, waiting_5, waiting_4, waiting_3,
                    waiting_2, waiting_1, waiting_0}
                <= {waiting_10, waiting_9, waiting_8, waiting_7, waiting_6, waiting_5, waiting_4, waiting_3, waiting_2,
                    waiting_1, waiting_0, word_waiting};
            {width_3, width_2, width_1, width_0} <= {width_2, width_1, width_0, word_width};
            {edge_alone_2, edge_alone_1, edge_alone_0} <= {edge_alone_1, edge_alone_0, word_edge};
            {first_2, first_1, first_0} <= {first_1, first_0, word_first};

            last_part <= none ? 17'd0 : pulse_part;
            last_slope <= pulse_slope;
            part <= bin_2 && !(MoreLight ? dark : scan) ? pulse_part - last_part : 17'd0;
            z_0 <= rest_2 ? 9'sd0 : first_2 ? pulse_first : slopes[9:1];
            {z_11, z_10, z_9, z_8, z_7, z_6, z_5, z_4, z_3, z_2, z_1}
                <= {z_10, z_9, z_8, z_7, z_6, z_5, z_4, z_3, z_2, z_1, z_0};

            lit <= lit_first;
            // Hazards are extended to the sum.
            // verilator lint_off WIDTH
            sum <= {1'b0, lit_first} + {1'b0, light} + (Glass ? glass_light : 26'd0)
                + (HasSecond ? other_light : 26'd0);
            // verilator lint_on WIDTH
            {hazard_4, hazard_3, hazard_2, hazard_1, hazard_0} <= {hazard_3, hazard_2, hazard_1, hazard_0, limited};
            {signal_hazard_1, signal_hazard_0} <= {signal_hazard_0, lit};

            if (HasSecond) ambient_light <= light;
            if (MoreLight) {hazard_bits, hazard_reciprocal} <= {bits_0, reciprocal};
            {bits_4, bits_3, bits_2, bits_1, bits_0} <= {bits_3, bits_2, bits_1, bits_0, length};
            {mantissa_2, mantissa_1, mantissa_0} <= {mantissa_1, mantissa_0, mantissa_first};
            aligned <= shifted[25:12];

            k_before <= hazard_word[27:11];
            // What k grows by is extended to it.
            // verilator lint_off WIDTH
            k <= k_before + grown[20:10];
            // verilator lint_on WIDTH
            {gains_2, gains_1} <= {gains_1, gains_0};
            gains_0 <= k[12:0] - hazard_4[22:10];
            {shares_2, shares_1, shares_0} <= {shares_1, shares_0, share_first};

            {ended_k_1, ended_k_0} <= {ended_k_0, ended_k_first};
            product <= times[WaitingProductBits-1:0];
            down <= 5'd26 - bits_4;
            product_shifted <= |expected[WaitingProductBits+1:ExpectedBits] ? {ExpectedBits{1'b1}}
                : expected[ExpectedBits-1:0];

            residual <= any ? surplus_limited : {ResidualBits{1'b0}};
            predicted <= any ? product_shifted : {ExpectedBits{1'b0}};
            gain <= gains_2;
            share <= shares_2;
            slope <= z_11;
            {middle, middles_2, middles_1} <= {middles_2, middles_1, middles_0};
            middles_0 <= !bin_11 || between[CountBits+1] ? {CountBits + 1{1'b0}} : between[CountBits:0];
            {waits, awaited_2, awaited_1} <= {awaited_2, awaited_1, awaited_0};
            awaited_0 <= (bin_11 || rest_11) && |waiting_11;
            single <= bin_14;
            slide <= slides_14;
        end
    end
endmodule
