`timescale 1ps / 1fs
`default_nettype none

// The arithmetic between the passes of the likelihood estimator: a small machine with one multiplier.
//
// An instruction goes through nine cycles: operands, products with the low bits of b, with the others, their sum, two
// shifts, the sum with c, its limits, and the memory. Others begin before, as far as they do not need what it gives:
// each says when the next one begins. A reciprocal takes 17 cycles more, a root 25, a bit of each at a time.
module likelihood_solver #(
    parameter [0:0] Used = 1'b1,                 // 0: nothing starts it, and it has no ROM
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter [31:0] Kappa = 32'd30751,          // 16 times the square of the pulse's deviation in z
    parameter integer StepLog2 = 1,              // step of the pulse is 2 to the power of this [units]
    parameter [31:0] PulseSigma = 32'd351,       // deviation of the pulse [units]
    parameter [31:0] WindowEnd = 32'd262328,     // where the last bin ends [units / 16]
    parameter [31:0] Metres = 32'd16094985,      // distance of a 16th of a unit [2^-(29 + MetresShift) m]
    parameter integer MetresShift = 13,
    parameter integer GlassBins = 0,             // see likelihood_memory
    parameter [23:0] GlassLight = 24'd0,         // light of the glass when it was calibrated [2^-14 photons a shot]
    parameter integer Targets = 1,               // see likelihood_memory
    parameter ProgramFile = "rtl_ref/solver.mem"  // an instruction a word
) (
    input wire clk_sys,
    input wire rst,
    input wire run,                              // begins a program
    input wire [6:0] entry,                      // where it begins
    // likelihood_scan
    input wire [CountBits-1:0] ambient_ended,    // hits of the block that shows the ambient light
    input wire [CountBits+BinBits+9:0] ambient_exposure,  // its exposure [shots units]
    input wire lone,                             // it is the only one
    input wire signed [CountBits+BinBits+13:0] best_excess,  // of the highest box [2^-8 counts]
    input wire [CountBits+BinBits:0] best_middle,  // twice the shots that wait in the middle of its bins
    input wire [BinBits:0] box_length,           // bins in it
    input wire [BinBits+1:0] box_sum,            // its first bin and the one after its last, together
    // likelihood_sums
    input wire signed [CountBits+23:0] sum_11,
    input wire signed [CountBits+23:0] sum_12,
    input wire signed [CountBits+23:0] sum_13,
    input wire signed [CountBits+18:0] sum_22,
    input wire signed [CountBits+18:0] sum_23,
    input wire signed [CountBits+18:0] sum_33,
    input wire signed [CountBits+23:0] score_1,
    input wire signed [CountBits+18:0] score_2,
    input wire signed [CountBits+18:0] score_3,
    // likelihood_glass
    // verilator lint_off UNUSEDSIGNAL
    input wire signed [CountBits+23:0] sum_14,
    input wire signed [CountBits+18:0] sum_24,
    input wire signed [CountBits+18:0] sum_34,
    input wire signed [CountBits+18:0] sum_44,
    input wire signed [CountBits+18:0] score_4,
    // likelihood_pair
    input wire paired,                           // both echoes have light: its sums are those of log b
    input wire signed [CountBits+23:0] still_13,
    input wire signed [CountBits+18:0] still_23,
    input wire signed [CountBits+18:0] still_33,
    input wire signed [CountBits+18:0] still_score,
    // verilator lint_on UNUSEDSIGNAL
    // Results
    output reg ran,                              // a program has ended; one cycle
    output reg [BinBits+10:0] arrival,           // of the echo [units / 16]
    output reg [23:0] strength,                  // photons a shot [2^-14]
    output reg [23:0] ambient,                   // hazard of ambient light [2^-30 / unit]
    output reg [23:0] glass,                     // light of a glass, photons a shot [2^-14]
    output reg [BinBits+10:0] other_arrival,     // of the other echo [units / 16]
    output reg [23:0] other_strength,            // photons a shot [2^-14]
    output reg signed [35:0] depth,              // of the last end program [2^-29 m]
    output reg [35:0] sigma,                     // its deviation [2^-29 m]
    output reg [6:0] flags,                      // of the last end program
    output reg [5:0] cut                         // by how many bits the last step was shortened
);
    localparam integer Counted = CountBits + (BinBits > 8 ? BinBits + 11 : 19);
    localparam integer WordBits = Counted > 35 ? Counted : 35, LowProductBits = WordBits + 18;
    localparam integer ShiftedBits = WordBits + 2, FineBits = ShiftedBits + 16, PartBits = WordBits - 17;
    localparam [2:0] Alu = 3'd0, Reciprocal = 3'd1, Root = 3'd2, Exponent = 3'd3, Cut = 3'd4, Stop = 3'd5;
    // What is added to a shift, 0 for nothing, the limits of a result, 6 for those of a step in log b, and its mark, 8 and
    // more for a flag
    localparam [2:0] ByBits = 3'd1, ByExponent = 3'd2, ByCut = 3'd3, ByBoth = 3'd4, ByMetres = 3'd5;
    localparam [2:0] Whole = 3'd0, Positive = 3'd1, OfSignal = 3'd2, OfAmbient = 3'd3, OfChance = 3'd4,
        OfWindow = 3'd5;
    localparam [2:0] OfChange = 3'd7;
    localparam [3:0] Large = 4'd1;
    localparam signed [CountBits+18:0] Scarce = 512;  // 8 counts of information on log b
    // Words that are outputs too, and constants
    localparam [0:0] Glass = GlassBins != 0, HasSecond = Targets != 1, MoreLight = Glass || HasSecond;
    localparam integer ProgramBits = MoreLight ? 7 : 6, PlaceBits = MoreLight ? 6 : 5;
    localparam [5:0] Arrival = 6'd0, Signal = 6'd1, Ambient = 6'd2, Depth = 6'd32, SigmaAt = 6'd33;
    localparam [5:0] GlassAt = 6'd48, Calibrated = 6'd49, Left33 = 6'd56, OtherArrival = 6'd58, OtherSignal = 6'd59;
    // Places are integers.
    // verilator lint_off WIDTH
    localparam [PlaceBits-1:0] One = 18, KappaAt = 19, Stride = 20, MetresAt = 21, Third = 22, Nineteen = 23,
        Power = 24, Zero = 25, Wide = 26, Margin = 27, End = 28, Variance = 29, Unsure = 30,
        Two = 31;
    // verilator lint_on WIDTH
    // Operands of a and of c from other blocks, by the low bits of their places
    localparam [1:0] Sum13 = 2'd0, Sum23 = 2'd1, Sum33 = 2'd2, Ended = 2'd0, Exposure = 2'd1, Excess = 2'd2;
    localparam [1:0] Sum11 = 2'd0, Sum12 = 2'd1, Sum22 = 2'd2, Sum14 = 2'd0, Sum24 = 2'd1, Sum34 = 2'd2;

    reg scarce;                                // little is known of log b
    reg running;                               // a program is running
    reg [6:0] counter;                         // its instruction
    reg [5:0] pause;                           // cycles until that one begins
    reg at_0, at_1, at_2, at_3, at_4, at_5, at_6, at_7, at_8;  // there is an instruction in that cycle of it
    reg [ProgramBits-1:0] number_0, number_1, number_2, number_3, number_4, number_5, number_6, number_7;  // which one
    // No other block has an operand b.
    // verilator lint_off UNUSEDSIGNAL
    reg [5:0] from_a, from_b, from_c;          // where its operands are
    // verilator lint_on UNUSEDSIGNAL
    reg [4:0] base;                            // by how many bits its product is shifted,
    reg [2:0] by;                              // and what is added to that
    reg alu;                                   // it is no division and no root
    reg [5:0] to;                              // where its result goes
    reg [3:0] mark;                            // what else is kept of it
    reg signed [WordBits-1:0] a, b, c;         // operands
    reg signed [PartBits+17:0] low_product;    // the low bits of a times those of b, or its others
    reg signed [2*PartBits-1:0] high_product;  // the others times that
    reg signed [LowProductBits-1:0] low;       // a times the low bits of b
    reg signed [63:0] product;                 // a times b
    reg [5:0] shift;                           // by how many bits it is shifted
    reg [3:0] shift_low;                       // the low bits of that, a cycle later
    reg signed [FineBits-1:0] coarse;          // the product after the longest shifts, with half of its lowest place
    reg negative;                              // its sign
    reg coarse_fits;                           // that is the sign of all that is left out
    reg signed [ShiftedBits-1:0] shifted;      // the product as it is shifted, or a divisor
    reg half;                                  // and half of its lowest place
    reg beyond;                                // it has only its sign: the product is beyond all limits
    reg minus;                                 // it is subtracted
    reg divides, roots;                        // the instruction is a reciprocal or a root, is a root
    reg signed [ShiftedBits:0] sum;            // of it and c
    reg past, opposite;                        // it is beyond all limits, on that side
    reg [2:0] limits;                          // its limits
    reg signed [WordBits-1:0] result;          // what the instruction comes to
    reg dividing, divided;                     // a division or a root is on the way, has ended
    reg [4:0] digit;                           // its next bit
    reg [1:0] pair;                            // what a root takes for this one
    reg [5:0] bits;                            // of what was divided by last, or half of those of a variance
    reg [5:0] exponent;                        // by how many bits the rest of the information is shifted
    reg [WordBits-15:0] magnitude;             // all magnitudes that were marked, without their lowest 14 bits
    // A remainder's highest bit is shifted out.
    // verilator lint_off UNUSEDSIGNAL
    reg [27:0] remainder;                      // what a division or a root leaves
    // verilator lint_on UNUSEDSIGNAL
    reg [24:0] quotient;                       // what it has come to

    (* ram_style = "distributed" *) reg signed [WordBits-1:0] words [0:(1 << PlaceBits) - 1];

    integer i;
    initial begin
        for (i = 0; i < 1 << PlaceBits; i = i + 1) words[i] = 0;
        words[One] = 1;
        // Constants are extended to words.
        // verilator lint_off WIDTH
        words[KappaAt] = Kappa;
        words[Stride] = Kappa << StepLog2;
        words[MetresAt] = Metres;
        words[Third] = 341;
        words[Nineteen] = 19;
        words[Power] = 131072;
        words[Zero] = 0;
        words[Wide] = PulseSigma << 4;
        words[Margin] = PulseSigma << 3;
        words[End] = WindowEnd;
        if (Glass) words[Calibrated[PlaceBits-1:0]] = GlassLight;
        // verilator lint_on WIDTH
        words[Variance] = 64;
        words[Unsure] = 40;
        words[Two] = 2;
        {glass, other_arrival, other_strength} = 0;
        {ran, arrival, strength, ambient, depth, sigma, flags, cut, scarce, running, counter, pause} = 0;
        {at_0, at_1, at_2, at_3, at_4, at_5, at_6, at_7, at_8, from_a, from_b, a, b, c} = 0;
        {number_0, number_1, number_2, number_3, number_4, number_5, number_6, number_7} = 0;
        {from_c, base, by, alu, to, mark, pair} = 0;
        {low_product, high_product, low, product, shift, shift_low, coarse, negative, coarse_fits, shifted, half, beyond} = 0;
        {minus, divides, roots, sum, past, opposite, limits, result, dividing, divided, digit} = 0;
        {bits, exponent, magnitude, remainder, quotient} = 0;
    end

    // The program: op, to, a, b, c, whether the product is subtracted, shift, what is added to it, limits, mark, cycles
    // until the next
    reg [48:0] instructions [0:(1 << ProgramBits) - 1];
    initial if (Used) $readmemh(ProgramFile, instructions);
    // What an instruction says counts in different cycles of it.
    // verilator lint_off UNUSEDSIGNAL
    wire [48:0] next_one = instructions[counter[ProgramBits-1:0]], of_operands = instructions[number_1];
    wire [48:0] of_shift = instructions[number_2], of_c = instructions[number_4], of_minus = instructions[number_5];
    wire [48:0] of_sum = instructions[number_6], of_result = instructions[number_7];
    // verilator lint_on UNUSEDSIGNAL
    wire [2:0] op = next_one[48:46];
    wire computes = op == Alu || op == Reciprocal || op == Root;
    wire begins = running && !run && pause == 6'd0;

    // Information on log b, of all light but the signal, or with another echo of all but both
    wire signed [CountBits+23:0] on_13 = HasSecond && paired ? still_13 : sum_13;
    wire signed [CountBits+18:0] on_23 = HasSecond && paired ? still_23 : sum_23, on_33 = HasSecond && paired ? still_33 : sum_33;
    wire signed [CountBits+18:0] on_score = HasSecond && paired ? still_score : score_3;

    // Operands from other blocks, in groups of four
    reg signed [WordBits-1:0] sum_a, scan_a, box_a, glass_a, other_a, sum_c, later_c, other_c;
    // Operands are extended to words, or cut as long as words.
    // verilator lint_off WIDTH
    always @* begin
        case (from_a[1:0])
            Sum13: sum_a = on_13 >>> 5;
            Sum23: sum_a = on_23;
            Sum33: sum_a = on_33;
            default: sum_a = on_score <<< 2;
        endcase
        case (from_a[1:0])
            Ended: scan_a = lone ? {ambient_ended, 12'd0} : {ambient_ended, 16'd0};
            Exposure: scan_a = ambient_exposure;
            Excess: scan_a = best_excess <<< 4;
            default: scan_a = best_middle;
        endcase
        box_a = Glass && from_a[1] ? score_4 <<< 2 : from_a[0] ? {box_sum, 9'd0} : box_length;
        case (from_a[1:0])
            Sum14: glass_a = sum_14 >>> 5;
            Sum24: glass_a = sum_24;
            Sum34: glass_a = sum_34;
            default: glass_a = sum_44;
        endcase
        other_a = from_a[3] ? (Glass && from_a[2] ? glass_a : box_a) : from_a[2] ? scan_a : sum_a;
        case (from_c[1:0])
            Sum11: sum_c = sum_11 >>> 1;
            Sum12: sum_c = sum_12 >>> 5;
            Sum22: sum_c = sum_22;
            default: sum_c = score_1 >>> 3;
        endcase
        case (from_c[1:0])
            Sum13: later_c = on_13 >>> 5;
            Sum23: later_c = on_23;
            Sum33: later_c = on_33;
            default: later_c = on_score <<< 2;
        endcase
        other_c = Glass && from_c[3] ? later_c : from_c[2] ? score_2 <<< 2 : sum_c;
    end
    // verilator lint_on WIDTH

    // The bits of a, and of what has been marked
    reg [5:0] length, marked_length;
    always @* begin
        length = 6'd1;
        // A place is an integer.
        // verilator lint_off WIDTH
        for (i = 1; i < WordBits - 1; i = i + 1) if (a[i]) length = i + 1;
        // verilator lint_on WIDTH
        if (a[WordBits-1]) length = 6'd1;
        marked_length = 6'd0;
        // A place is an integer.
        // verilator lint_off WIDTH
        for (i = 0; i < WordBits - 14; i = i + 1) if (magnitude[i]) marked_length = i + 15;
        // verilator lint_on WIDTH
    end

    // One multiplier: the low bits of b, then the others. In two parts, to each of which one is added, as the slices
    // that multiply have it.
    // Parts are extended to the product.
    // verilator lint_off WIDTH
    wire signed [PartBits-1:0] part = at_1 ? $signed({1'b0, b[16:0]}) : $signed(b[WordBits-1:17]);
    wire signed [LowProductBits-1:0] lower = low_product + (low >>> 17);
    wire signed [LowProductBits-1:0] upper = high_product + (lower >>> 17);
    wire signed [LowProductBits-1:0] partial = {upper, lower[16:0]};
    // verilator lint_on WIDTH

    // The shift. It goes in steps, the longest first: the others have fewer bits to look at.
    reg [7:0] more;
    // Parts of a shift are extended to it.
    // verilator lint_off WIDTH
    always @*
        case (by)
            ByBits: more = bits;
            ByExponent: more = exponent;
            ByCut: more = cut;
            ByBoth: more = bits + exponent;
            ByMetres: more = MetresShift;
            default: more = 8'd0;
        endcase
    wire [7:0] all_shift = base + more;
    // verilator lint_on WIDTH
    reg signed [64:0] down;
    reg signed [FineBits-1:0] fine;
    reg moved_fits;
    always @* begin
        down = {product, 1'b0};
        for (i = 5; i >= 4; i = i - 1) if (shift[i]) down = down >>> (1 << i);
        fine = coarse;
        for (i = 3; i >= 0; i = i - 1) if (shift_low[i]) fine = fine >>> (1 << i);
        // One place is left for the rounding.
        moved_fits = coarse_fits && fine[FineBits-1:ShiftedBits-1] == {FineBits - ShiftedBits + 1{negative}};
    end
    wire odd = bits[0] ^ exponent[0];

    // A bit of a reciprocal or of a root, which takes two bits of the product each time, the highest first; of an odd
    // one they begin a place lower.
    wire [4:0] pairs_left = 5'd16 - digit;
    reg [34:0] pairs;
    always @* begin
        pairs = {product[33:0], 1'b0};
        for (i = 4; i >= 0; i = i - 1) if (pairs_left[i]) pairs = pairs >> (2 << i);
    end
    wire [27:0] left = roots ? {remainder[25:0], pair} : {remainder[26:0], 1'b1};
    // A quotient is as long as its root.
    // verilator lint_off WIDTH
    wire [27:0] against = roots ? {quotient, 2'b01} : shifted[27:0];
    // verilator lint_on WIDTH
    wire [28:0] less = {1'b0, left} - {1'b0, against};
    wire fits = !less[28];

    // The sum, within its limits, which are such that few bits tell whether it is
    // The lowest bit is the carry that went in.
    // verilator lint_off UNUSEDSIGNAL
    // A word is extended to the sum.
    // verilator lint_off WIDTH
    wire signed [ShiftedBits+1:0] doubled
        = $signed({c, 1'b1}) + $signed({{shifted[ShiftedBits-1], shifted} ^ {ShiftedBits + 1{minus}}, half ^ minus});
    // verilator lint_on WIDTH
    // verilator lint_on UNUSEDSIGNAL
    wire signed [WordBits-1:0] top = {1'b0, {WordBits - 1{1'b1}}};
    wire under = past ? opposite : sum[ShiftedBits];
    wire past_word = past || sum[ShiftedBits-1:WordBits-1] != {ShiftedBits - WordBits + 1{under}};
    wire past_24 = past_word || |sum[WordBits-2:24];
    // b does not fall while little is known of it, or the step is shortened.
    wire held = (scarce || cut != 6'd0) && limits != OfChange;
    wire below_half = held || !(&sum[WordBits-2:13]);
    wire past_growth = past_word || (under ? below_half : past_24 || |sum[23:16] || sum[15:14] == 2'd3);
    wire below_16 = under || !past_24 && sum[23:4] == 20'd0;
    wire below_1 = under || below_16 && sum[3:0] == 4'd0;
    reg past_end;
    reg signed [WordBits-1:0] least, most;
    reg below, outside;
    always @* begin
        // From the lowest bit up: each decides, unless it is that of the end.
        past_end = 1'b0;
        for (i = 0; i < BinBits + 11; i = i + 1) past_end = WindowEnd[i] ? sum[i] && past_end : sum[i] || past_end;
        case (limits)
            Whole: {least, most} = {~top, top};
            Positive: {least, most} = {{WordBits - 1{1'b0}}, 1'b1, top};
            OfSignal: begin least = 16; most = 16777215; end
            OfAmbient: begin least = 1; most = 16777215; end
            OfChance: begin least = 1; most = 8388608; end
            // The end is extended to a word.
            // verilator lint_off WIDTH
            OfWindow: begin least = 0; most = WindowEnd; end
            // verilator lint_on WIDTH
            default: begin least = held ? 0 : -8192; most = 49152; end
        endcase
        case (limits)
            Whole: {below, outside} = {under, past_word};
            Positive: {below, outside} = {below_1, below_1 || past_word};
            OfSignal: {below, outside} = {below_16, below_16 || past_24};
            OfAmbient: {below, outside} = {below_1, below_1 || past_24};
            OfChance: {below, outside} = {below_1, below_1 || past_24 || sum[23]};
            OfWindow: {below, outside} = {under, under || past_word || |sum[WordBits-2:BinBits+11] || past_end};
            default: {below, outside} = {under, past_growth};
        endcase
    end
    // A sum within its limits is cut to a word.
    // verilator lint_off WIDTH
    wire signed [WordBits-1:0] limited = !outside ? sum : below ? least : most;
    // verilator lint_on WIDTH
    wire last_digit = digit == (roots ? 5'd25 : 5'd17);
    wire [6:0] marked = 7'd1 << mark[2:0];
    // Its magnitude without the lowest 14 bits, on which no shift depends
    wire carried = result < 0 && result[13:0] == 14'd0;
    // The carry is extended.
    // verilator lint_off WIDTH
    wire [WordBits-15:0] absolute = (result[WordBits-1:14] ^ {WordBits - 14{result[WordBits-1]}}) + carried;
    // verilator lint_on WIDTH

    always @(posedge clk_sys)
        if (at_8 && (!to[5] || MoreLight && to[4])) words[to[PlaceBits-1:0]] <= result;

    always @(posedge clk_sys) begin
        if (rst) begin
            {glass, other_arrival, other_strength} <= 0;
            {ran, arrival, strength, ambient, depth, sigma, flags, cut, scarce, running, counter, pause} <= 0;
            {at_0, at_1, at_2, at_3, at_4, at_5, at_6, at_7, at_8, from_a, from_b, a, b, c} <= 0;
            {number_0, number_1, number_2, number_3, number_4, number_5, number_6, number_7} <= 0;
            {from_c, base, by, alu, to, mark, pair} <= 0;
            {low_product, high_product, low, product, shift, shift_low, coarse, negative, coarse_fits} <= 0;
            {shifted, half, beyond} <= 0;
            {minus, divides, roots, sum, past, opposite, limits, result, dividing, divided, digit} <= 0;
            {bits, exponent, magnitude, remainder, quotient} <= 0;
        end else begin
            if (!Glass) scarce <= on_33 < Scarce;
            // What begins
            ran <= begins && op == Stop;
            if (run) begin
                running <= 1'b1;
                counter <= entry;
                pause <= 6'd0;
            end else if (begins) begin
                if (op == Stop) running <= 1'b0;
                else counter <= counter + 7'd1;
                pause <= next_one[5:0] - 6'd1;
            end else if (running) pause <= pause - 6'd1;
            if (begins) {number_0, from_a, from_b} <= {counter[ProgramBits-1:0], next_one[39:34], next_one[33:28]};
            if (run || begins && (op == Exponent || op == Cut)) magnitude <= 0;
            else if (at_8 && mark == Large) magnitude <= magnitude | absolute;
            if (begins && op == Exponent) exponent <= marked_length > 6'd16 ? marked_length - 6'd16 : 6'd0;
            if (begins && op == Cut) cut <= marked_length > 6'd14 ? marked_length - 6'd14 : 6'd0;

            // What is on the way; a division holds it up.
            {at_7, at_6, at_5, at_4, at_3, at_2, at_1, at_0}
                <= {at_6 && !divides, at_5, at_4, at_3, at_2, at_1, at_0, begins && computes};
            at_8 <= at_7 || divided;
            {number_6, number_5, number_4, number_3, number_2, number_1}
                <= {number_5, number_4, number_3, number_2, number_1, number_0};
            if (at_6) number_7 <= number_6;
            {to, mark} <= {of_result[45:40], of_result[9:6]};
            {base, by} <= {of_shift[20:16], of_shift[15:13]};
            {from_c, alu} <= {of_c[27:22], of_c[48:46] == Alu};
            if (at_0) begin
                a <= from_a[5] && !(MoreLight && from_a[4]) ? other_a : words[from_a[PlaceBits-1:0]];
                b <= words[from_b[PlaceBits-1:0]];
            end
            low_product <= $signed({1'b0, a[16:0]}) * part;
            high_product <= $signed(a[WordBits-1:17]) * part;
            low <= at_2 ? partial : 0;
            // The product is cut to its words, a shift to its bits.
            // verilator lint_off WIDTH
            if (at_3) product <= {partial, low[16:0]};
            shift <= all_shift > 63 ? 6'd63 : all_shift;
            // verilator lint_on WIDTH
            shift_low <= shift[3:0];
            coarse <= down[FineBits-1:0];
            negative <= down[64];
            coarse_fits <= down[64:FineBits-1] == {66 - FineBits{down[64]}};
            if (at_5) begin
                shifted <= {negative, fine[ShiftedBits-1:1]};
                beyond <= !moved_fits;
                half <= fine[0] && alu;
                c <= from_c[5] && !(MoreLight && from_c[4]) ? other_c : words[from_c[PlaceBits-1:0]];
                minus <= of_minus[21];
                divides <= !alu;
                roots <= of_minus[48:46] == Root;
            end
            sum <= doubled[ShiftedBits+1:1];
            past <= beyond;
            opposite <= shifted[ShiftedBits-1] ^ minus;
            limits <= of_sum[12:10];
            // A quotient is extended to a word.
            // verilator lint_off WIDTH
            result <= divided ? quotient : limited;
            // verilator lint_on WIDTH

            // A bit of a reciprocal or of a root
            if (at_1 && of_operands[48:46] == Reciprocal) bits <= length;
            // Bits are counted in integers.
            // verilator lint_off WIDTH
            else if (divided && roots) bits <= (10 + bits + exponent + odd) >> 1;
            // verilator lint_on WIDTH
            dividing <= at_6 && divides || dividing && !last_digit;
            divided <= dividing && last_digit;
            pair <= odd ? pairs[1:0] : pairs[2:1];
            digit <= at_6 ? 5'd1 : dividing ? digit + 5'd1 : 5'd0;
            if (at_6) {remainder, quotient} <= {roots ? 28'd0 : 28'd65535, 25'd0};
            else if (dividing) begin
                remainder <= fits ? less[27:0] : left;
                quotient <= {quotient[23:0], fits};
            end

            // What an instruction has come to
            if (at_8) begin
                case (to)
                    // Results are cut to their words.
                    // verilator lint_off WIDTH
                    Arrival: arrival <= result;
                    Signal: strength <= result;
                    Ambient: ambient <= result;
                    GlassAt: if (Glass) glass <= result;
                    OtherArrival: if (HasSecond) other_arrival <= result;
                    OtherSignal: if (HasSecond) other_strength <= result;
                    Left33: if (Glass) scarce <= result < Scarce;
                    Depth: depth <= result;
                    SigmaAt: sigma <= result;
                    // verilator lint_on WIDTH
                    default: ;
                endcase
                if (mark[3]) flags <= (flags & ~marked) | (result < 0 ? marked : 7'd0);
            end
        end
    end
endmodule
