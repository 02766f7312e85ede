`timescale 1ps / 1fs
`default_nettype none

// The arithmetic between the passes of the likelihood estimator: a small machine with one multiplier.
//
// An instruction goes through nine cycles: operands, products with the low bits of b, with the others, their sum, two
// shifts, the sum with c, its limits, and the memory. Others begin before, as far as they do not need what it gives:
// each says when the next one begins. A reciprocal takes 17 cycles more, a root 25, a bit of each at a time.
// Words are extended and cut as what they are assigned to is wide; some bits are not needed.
// verilator lint_off WIDTH
// verilator lint_off UNUSEDSIGNAL
module likelihood_solver #(
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter [31:0] Kappa = 32'd30751,          // 16 times the square of the pulse's deviation in z
    parameter integer StepLog2 = 1,              // step of the pulse is 2 to the power of this [units]
    parameter [31:0] PulseSigma = 32'd351,       // deviation of the pulse [units]
    parameter [31:0] WindowEnd = 32'd262328,     // where the last bin ends [units / 16]
    parameter [31:0] Metres = 32'd16094985,      // distance of a 16th of a unit [2^-(29 + MetresShift) m]
    parameter integer MetresShift = 13
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
    // Results
    output reg ran,                              // a program has ended; one cycle
    output reg [BinBits+10:0] arrival,           // of the echo [units / 16]
    output reg [23:0] strength,                  // photons a shot [2^-14]
    output reg [23:0] ambient,                   // hazard of ambient light [2^-30 / unit]
    output reg signed [35:0] depth,              // of the last end program [2^-29 m]
    output reg [35:0] sigma,                     // its deviation [2^-29 m]
    output reg [6:0] flags,                      // of the last end program
    output reg [5:0] cut                         // by how many bits the last step was shortened
);
    localparam integer Counted = CountBits + (BinBits > 8 ? BinBits + 11 : 19);
    localparam integer WordBits = Counted > 35 ? Counted : 35, LowProductBits = WordBits + 18;
    localparam integer ShiftedBits = WordBits + 2, FineBits = ShiftedBits + 16, PartBits = WordBits - 17;
    localparam [2:0] Alu = 3'd0, Reciprocal = 3'd1, Root = 3'd2, Exponent = 3'd3, Cut = 3'd4, Stop = 3'd5;
    localparam [2:0] ByNothing = 3'd0, ByBits = 3'd1, ByExponent = 3'd2, ByCut = 3'd3, ByBoth = 3'd4, ByMetres = 3'd5;
    localparam [2:0] Whole = 3'd0, Positive = 3'd1, OfSignal = 3'd2, OfAmbient = 3'd3, OfChance = 3'd4,
        OfWindow = 3'd5, OfGrowth = 3'd6;
    localparam [3:0] Large = 4'd1, Flag0 = 4'd8, Flag1 = 4'd9, Flag2 = 4'd10, Flag3 = 4'd11, Flag4 = 4'd12,
        Flag5 = 4'd13, Flag6 = 4'd14;
    // Words: variables, then constants
    localparam [5:0] Arrival = 6'd0, Signal = 6'd1, Ambient = 6'd2, F1 = 6'd3, F2 = 6'd4, F3 = 6'd5, A11 = 6'd6,
        A12 = 6'd7, A22 = 6'd8, X1 = 6'd9, X2 = 6'd10, Det = 6'd11, N1 = 6'd12, N2 = 6'd13, D1 = 6'd14,
        D2 = 6'd15, T = 6'd16, R = 6'd17, One = 6'd18, KappaAt = 6'd19, Stride = 6'd20, MetresAt = 6'd21,
        Third = 6'd22, Nineteen = 6'd23, Power = 6'd24, Zero = 6'd25, Wide = 6'd26, Margin = 6'd27, End = 6'd28,
        Variance = 6'd29, Unsure = 6'd30, Two = 6'd31;
    // Operands of a and of c from other blocks, and results that are outputs
    localparam [5:0] Sum13 = 6'd32, Sum23 = 6'd33, Sum33 = 6'd34, Score3 = 6'd35, Ended = 6'd36, Exposure = 6'd37,
        Excess = 6'd38, Middle = 6'd39, Length = 6'd40, Box = 6'd41;
    localparam [5:0] Sum11 = 6'd32, Sum12 = 6'd33, Sum22 = 6'd34, Score1 = 6'd35, Score2 = 6'd36;
    localparam [5:0] Depth = 6'd32, SigmaAt = 6'd33;

    reg running;                               // a program is running
    reg [6:0] counter;                         // its instruction
    reg [5:0] pause;                           // cycles until that one begins
    reg at_0, at_1, at_2, at_3, at_4, at_5, at_6, at_7, at_8;  // there is an instruction in that cycle of it
    reg [5:0] number_0, number_1, number_2, number_3, number_4, number_5, number_6, number_7;  // which one
    reg [5:0] from_a, from_b, from_c;          // where its operands are
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
    reg [27:0] remainder;                      // what a division or a root leaves
    reg [24:0] quotient;                       // what it has come to

    (* ram_style = "distributed" *) reg signed [WordBits-1:0] words [0:31];

    integer i;
    initial begin
        for (i = 0; i < 18; i = i + 1) words[i] = 0;
        words[One] = 1;
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
        words[Variance] = 64;
        words[Unsure] = 40;
        words[Two] = 2;
        {ran, arrival, strength, ambient, depth, sigma, flags, cut, running, counter, pause} = 0;
        {at_0, at_1, at_2, at_3, at_4, at_5, at_6, at_7, at_8, from_a, from_b, a, b, c} = 0;
        {number_0, number_1, number_2, number_3, number_4, number_5, number_6, number_7} = 0;
        {from_c, base, by, alu, to, mark, pair} = 0;
        {low_product, high_product, low, product, shift, shift_low, coarse, negative, coarse_fits, shifted, half, beyond} = 0;
        {minus, divides, roots, sum, past, opposite, limits, result, dividing, divided, digit} = 0;
        {bits, exponent, magnitude, remainder, quotient} = 0;
    end

    // op, to, a, b, c, whether the product is subtracted, shift, what is added to it, limits, mark, cycles until the next
    function [48:0] instruction(input [5:0] number);
        case (number)
            // The chance of a bin, and -log(1 - chance) to the third power.
            6'd0: instruction = {Reciprocal, R, Exposure, Power, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0, 6'd26};
            6'd1: instruction = {Alu, T, Ended, R, Zero, 1'b0, 5'd2, ByBits, OfChance, 4'd0, 6'd9};
            6'd2: instruction = {Alu, X1, T, T, Zero, 1'b0, 5'd24, ByNothing, Whole, 4'd0, 6'd9};
            6'd3: instruction = {Alu, X2, X1, T, Zero, 1'b0, 5'd24, ByNothing, Whole, 4'd0, 6'd2};
            6'd4: instruction = {Alu, T, X1, One, T, 1'b0, 5'd1, ByNothing, Whole, 4'd0, 6'd7};
            6'd5: instruction = {Alu, Ambient, X2, Third, T, 1'b0, 5'd10, ByNothing, OfAmbient, 4'd0, 6'd9};
            6'd6: instruction = {Stop, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd1};
            // Where the box stands highest, and how high.
            6'd7: instruction = {Reciprocal, R, Middle, Power, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0, 6'd26};
            6'd8: instruction = {Alu, T, Excess, R, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0, 6'd9};
            6'd9: instruction = {Alu, T, Length, T, Zero, 1'b0, 5'd13, ByNothing, Whole, 4'd0, 6'd2};
            6'd10: instruction = {Alu, Arrival, Box, One, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd7};
            6'd11: instruction = {Alu, Signal, T, Nineteen, Zero, 1'b0, 5'd4, ByNothing, OfSignal, 4'd0, 6'd9};
            6'd12: instruction = {Stop, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd1};
            // log b is eliminated.
            6'd13: instruction = {Reciprocal, R, Sum33, Power, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0, 6'd26};
            6'd14: instruction = {Alu, F1, Sum13, R, Zero, 1'b0, 5'd2, ByBits, Whole, 4'd0, 6'd2};
            6'd15: instruction = {Alu, F2, Sum23, R, Zero, 1'b0, 5'd2, ByBits, Whole, 4'd0, 6'd2};
            6'd16: instruction = {Alu, F3, Score3, R, Zero, 1'b0, 5'd2, ByBits, Whole, 4'd0, 6'd5};
            6'd17: instruction = {Alu, A11, Sum13, F1, Sum11, 1'b1, 5'd14, ByNothing, Positive, Large, 6'd2};
            6'd18: instruction = {Alu, A12, Sum23, F1, Sum12, 1'b1, 5'd14, ByNothing, Whole, 4'd0, 6'd2};
            6'd19: instruction = {Alu, A22, Sum23, F2, Sum22, 1'b1, 5'd14, ByNothing, Positive, Large, 6'd2};
            6'd20: instruction = {Alu, X1, Score3, F1, Score1, 1'b1, 5'd14, ByNothing, Whole, Large, 6'd2};
            6'd21: instruction = {Alu, X2, Score3, F2, Score2, 1'b1, 5'd14, ByNothing, Whole, Large, 6'd10};
            // The rest is shifted to 16 bits, and solved by Cramer's rule.
            6'd22: instruction = {Exponent, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd1};
            6'd23: instruction = {Alu, A11, A11, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0, 6'd2};
            6'd24: instruction = {Alu, A22, A22, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0, 6'd2};
            6'd25: instruction = {Alu, A12, A12, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0, 6'd2};
            6'd26: instruction = {Alu, X1, X1, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0, 6'd2};
            6'd27: instruction = {Alu, X2, X2, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0, 6'd3};
            6'd28: instruction = {Alu, Det, A11, A22, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd4};
            6'd29: instruction = {Alu, Det, A12, A12, Det, 1'b1, 5'd0, ByNothing, Positive, 4'd0, 6'd2};
            6'd30: instruction = {Alu, N1, A22, X1, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd4};
            6'd31: instruction = {Alu, N1, A12, X2, N1, 1'b1, 5'd0, ByNothing, Whole, 4'd0, 6'd2};
            6'd32: instruction = {Alu, N2, A11, X2, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd4};
            6'd33: instruction = {Alu, N2, A12, X1, N2, 1'b1, 5'd0, ByNothing, Whole, 4'd0, 6'd2};
            6'd34: instruction = {Reciprocal, R, Det, Power, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0, 6'd26};
            6'd35: instruction = {Alu, D1, N1, R, Zero, 1'b0, 5'd2, ByBits, Whole, 4'd0, 6'd2};
            6'd36: instruction = {Alu, D2, N2, R, Zero, 1'b0, 5'd2, ByBits, Whole, Large, 6'd7};
            6'd37: instruction = {Alu, T, D1, KappaAt, Zero, 1'b0, 5'd14, ByNothing, Whole, Large, 6'd10};
            6'd38: instruction = {Cut, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd1};
            6'd39: instruction = {Alu, D1, D1, One, Zero, 1'b0, 5'd0, ByCut, Whole, 4'd0, 6'd2};
            6'd40: instruction = {Alu, D2, D2, One, Zero, 1'b0, 5'd0, ByCut, Whole, 4'd0, 6'd7};
            6'd41: instruction = {Alu, T, F1, D1, F3, 1'b1, 5'd14, ByNothing, Whole, 4'd0, 6'd2};
            6'd42: instruction = {Alu, X1, D1, Stride, Zero, 1'b0, 5'd17, ByNothing, Whole, 4'd0, 6'd2};
            6'd43: instruction = {Alu, X2, D2, D2, D2, 1'b0, 5'd15, ByNothing, Whole, 4'd0, 6'd2};
            6'd44: instruction = {Alu, T, F2, D2, T, 1'b1, 5'd14, ByNothing, OfGrowth, 4'd0, 6'd5};
            6'd45: instruction = {Alu, Arrival, X1, One, Arrival, 1'b0, 5'd0, ByNothing, OfWindow, 4'd0, 6'd2};
            6'd46: instruction = {Alu, Signal, Signal, X2, Signal, 1'b0, 5'd14, ByNothing, OfSignal, 4'd0, 6'd2};
            6'd47: instruction = {Alu, Ambient, Ambient, T, Ambient, 1'b0, 5'd14, ByNothing, OfAmbient, 4'd0, 6'd9};
            6'd48: instruction = {Stop, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd1};
            // Flags 0 and 1: log S is not known to a quarter, to a fifth; 2: nor mu to the pulse's deviation.
            6'd49: instruction = {Alu, N1, A11, R, Zero, 1'b0, 5'd0, ByBoth, Whole, 4'd0, 6'd2};
            6'd50: instruction = {Root, N2, A22, R, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd34};
            6'd51: instruction = {Alu, T, N1, One, Variance, 1'b1, 5'd0, ByNothing, Whole, Flag0, 6'd2};
            6'd52: instruction = {Alu, T, N1, One, Unsure, 1'b1, 5'd0, ByNothing, Whole, Flag1, 6'd2};
            6'd53: instruction = {Alu, N2, N2, Stride, Zero, 1'b0, 5'd11, ByBits, Whole, 4'd0, 6'd2};
            // Flags 3 and 4: next to the begin or the end of the window; 5 and 6: the last step was long.
            6'd54: instruction = {Alu, T, Margin, One, Arrival, 1'b1, 5'd0, ByNothing, Whole, Flag3, 6'd2};
            6'd55: instruction = {Alu, T, Arrival, One, End, 1'b1, 5'd0, ByNothing, Whole, 4'd0, 6'd4};
            6'd56: instruction = {Alu, T, Margin, One, T, 1'b1, 5'd0, ByNothing, Whole, Flag4, 6'd2};
            6'd57: instruction = {Alu, T, N2, One, Wide, 1'b1, 5'd0, ByNothing, Whole, Flag2, 6'd2};
            6'd58: instruction = {Alu, T, N2, Two, X1, 1'b0, 5'd0, ByNothing, Whole, Flag5, 6'd2};
            6'd59: instruction = {Alu, X1, X1, One, Zero, 1'b1, 5'd0, ByNothing, Whole, 4'd0, 6'd4};
            6'd60: instruction = {Alu, T, N2, Two, X1, 1'b0, 5'd0, ByNothing, Whole, Flag6, 6'd2};
            6'd61: instruction = {Alu, Depth, Arrival, MetresAt, Zero, 1'b0, 5'd0, ByMetres, Whole, 4'd0, 6'd2};
            6'd62: instruction = {Alu, SigmaAt, N2, MetresAt, Zero, 1'b0, 5'd0, ByMetres, Whole, 4'd0, 6'd9};
            6'd63: instruction = {Stop, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0, 6'd1};
        endcase
    endfunction

    // What an instruction says counts in different cycles of it.
    function [2:0] op_of(input [48:0] all); op_of = all[48:46]; endfunction
    function [5:0] to_of(input [48:0] all); to_of = all[45:40]; endfunction
    function [5:0] a_of(input [48:0] all); a_of = all[39:34]; endfunction
    function [5:0] b_of(input [48:0] all); b_of = all[33:28]; endfunction
    function [5:0] c_of(input [48:0] all); c_of = all[27:22]; endfunction
    function [4:0] base_of(input [48:0] all); base_of = all[20:16]; endfunction
    function [2:0] by_of(input [48:0] all); by_of = all[15:13]; endfunction
    function [2:0] limits_of(input [48:0] all); limits_of = all[12:10]; endfunction
    function [3:0] mark_of(input [48:0] all); mark_of = all[9:6]; endfunction

    wire [48:0] next_one = instruction(counter[5:0]), of_operands = instruction(number_1);
    wire [48:0] of_shift = instruction(number_2), of_c = instruction(number_4), of_minus = instruction(number_5);
    wire [48:0] of_sum = instruction(number_6), of_result = instruction(number_7);
    wire [2:0] op = op_of(next_one);
    wire computes = op == Alu || op == Reciprocal || op == Root;
    wire begins = running && !run && pause == 6'd0;

    // Operands from other blocks, in groups of four
    reg signed [WordBits-1:0] sum_a, scan_a, box_a, other_a, sum_c, other_c;
    always @* begin
        case (from_a[1:0])
            Sum13[1:0]: sum_a = sum_13 >>> 5;
            Sum23[1:0]: sum_a = sum_23;
            Sum33[1:0]: sum_a = sum_33;
            default: sum_a = score_3 <<< 2;
        endcase
        case (from_a[1:0])
            Ended[1:0]: scan_a = lone ? {ambient_ended, 12'd0} : {ambient_ended, 16'd0};
            Exposure[1:0]: scan_a = ambient_exposure;
            Excess[1:0]: scan_a = best_excess <<< 4;
            default: scan_a = best_middle;
        endcase
        box_a = from_a[0] ? {box_sum, 9'd0} : box_length;
        other_a = from_a[3] ? box_a : from_a[2] ? scan_a : sum_a;
        case (from_c[1:0])
            Sum11[1:0]: sum_c = sum_11 >>> 1;
            Sum12[1:0]: sum_c = sum_12 >>> 5;
            Sum22[1:0]: sum_c = sum_22;
            default: sum_c = score_1 >>> 3;
        endcase
        other_c = from_c[2] ? score_2 <<< 2 : sum_c;
    end

    // The bits of a, and of what has been marked
    reg [5:0] length, marked_length;
    always @* begin
        length = 6'd1;
        for (i = 1; i < WordBits - 1; i = i + 1) if (a[i]) length = i + 1;
        if (a[WordBits-1]) length = 6'd1;
        marked_length = 6'd0;
        for (i = 0; i < WordBits - 14; i = i + 1) if (magnitude[i]) marked_length = i + 15;
    end

    // One multiplier: the low bits of b, then the others. In two parts, to each of which one is added, as the slices
    // that multiply have it.
    wire signed [PartBits-1:0] part = at_1 ? $signed({1'b0, b[16:0]}) : $signed(b[WordBits-1:17]);
    wire signed [LowProductBits-1:0] lower = low_product + (low >>> 17);
    wire signed [LowProductBits-1:0] upper = high_product + (lower >>> 17);
    wire signed [LowProductBits-1:0] partial = {upper, lower[16:0]};

    // The shift. It goes in steps, the longest first: the others have fewer bits to look at.
    reg [7:0] more;
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
    wire [27:0] against = roots ? {quotient, 2'b01} : shifted[27:0];
    wire [28:0] less = {1'b0, left} - {1'b0, against};
    wire fits = !less[28];

    // The sum, within its limits, which are such that few bits tell whether it is
    wire signed [ShiftedBits+1:0] doubled
        = $signed({c, 1'b1}) + $signed({{shifted[ShiftedBits-1], shifted} ^ {ShiftedBits + 1{minus}}, half ^ minus});
    wire signed [WordBits-1:0] top = {1'b0, {WordBits - 1{1'b1}}};
    wire under = past ? opposite : sum[ShiftedBits];
    wire past_word = past || sum[ShiftedBits-1:WordBits-1] != {ShiftedBits - WordBits + 1{under}};
    wire past_24 = past_word || |sum[WordBits-2:24];
    wire past_growth = past_word || (under ? !(&sum[WordBits-2:13]) : past_24 || |sum[23:16] || sum[15:14] == 2'd3);
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
            OfWindow: begin least = 0; most = WindowEnd; end
            default: begin least = -8192; most = 49152; end
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
    wire signed [WordBits-1:0] limited = !outside ? sum : below ? least : most;
    wire last_digit = digit == (roots ? 5'd25 : 5'd17);
    wire [6:0] marked = 7'd1 << mark[2:0];
    // Its magnitude without the lowest 14 bits, on which no shift depends
    wire carried = result < 0 && result[13:0] == 14'd0;
    wire [WordBits-15:0] absolute = (result[WordBits-1:14] ^ {WordBits - 14{result[WordBits-1]}}) + carried;

    always @(posedge clk_sys)
        if (at_8 && !to[5]) words[to[4:0]] <= result;

    always @(posedge clk_sys) begin
        if (rst) begin
            {ran, arrival, strength, ambient, depth, sigma, flags, cut, running, counter, pause} <= 0;
            {at_0, at_1, at_2, at_3, at_4, at_5, at_6, at_7, at_8, from_a, from_b, a, b, c} <= 0;
            {number_0, number_1, number_2, number_3, number_4, number_5, number_6, number_7} <= 0;
            {from_c, base, by, alu, to, mark, pair} <= 0;
            {low_product, high_product, low, product, shift, shift_low, coarse, negative, coarse_fits} <= 0;
            {shifted, half, beyond} <= 0;
            {minus, divides, roots, sum, past, opposite, limits, result, dividing, divided, digit} <= 0;
            {bits, exponent, magnitude, remainder, quotient} <= 0;
        end else begin
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
            if (begins) {number_0, from_a, from_b} <= {counter[5:0], a_of(next_one), b_of(next_one)};
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
            {to, mark} <= {to_of(of_result), mark_of(of_result)};
            {base, by} <= {base_of(of_shift), by_of(of_shift)};
            {from_c, alu} <= {c_of(of_c), op_of(of_c) == Alu};
            if (at_0) begin
                a <= from_a[5] ? other_a : words[from_a[4:0]];
                b <= words[from_b[4:0]];
            end
            low_product <= $signed({1'b0, a[16:0]}) * part;
            high_product <= $signed(a[WordBits-1:17]) * part;
            low <= at_2 ? partial : 0;
            if (at_3) product <= {partial, low[16:0]};
            shift <= all_shift > 63 ? 6'd63 : all_shift;
            shift_low <= shift[3:0];
            coarse <= down[FineBits-1:0];
            negative <= down[64];
            coarse_fits <= down[64:FineBits-1] == {66 - FineBits{down[64]}};
            if (at_5) begin
                shifted <= {negative, fine[ShiftedBits-1:1]};
                beyond <= !moved_fits;
                half <= fine[0] && alu;
                c <= from_c[5] ? other_c : words[from_c[4:0]];
                minus <= of_minus[21];
                divides <= !alu;
                roots <= op_of(of_minus) == Root;
            end
            sum <= doubled[ShiftedBits+1:1];
            past <= beyond;
            opposite <= shifted[ShiftedBits-1] ^ minus;
            limits <= limits_of(of_sum);
            result <= divided ? quotient : limited;

            // A bit of a reciprocal or of a root
            if (at_1 && op_of(of_operands) == Reciprocal) bits <= length;
            else if (divided && roots) bits <= (10 + bits + exponent + odd) >> 1;
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
                    Arrival: arrival <= result;
                    Signal: strength <= result;
                    Ambient: ambient <= result;
                    Depth: depth <= result;
                    SigmaAt: sigma <= result;
                    default: ;
                endcase
                if (mark[3]) flags <= (flags & ~marked) | (result < 0 ? marked : 7'd0);
            end
        end
    end
endmodule
// verilator lint_on UNUSEDSIGNAL
// verilator lint_on WIDTH
