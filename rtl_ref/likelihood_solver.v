`timescale 1ps / 1fs
`default_nettype none

// The arithmetic between the passes of the likelihood estimator: a small machine with one multiplier.
//
// An instruction takes five cycles: operands, the product with the low bits of b, with the others, the shift, the
// sum. A reciprocal takes 18 more, a root 26, a bit of each at a time.
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
    input wire [CountBits+2*BinBits:0] best_middle,  // twice the shots that wait in the middle of its bins
    input wire [BinBits:0] box_length,           // bins in it
    input wire [BinBits+1:0] box_sum,            // its first bin and the one after its last, together
    // likelihood_sums
    input wire signed [CountBits+19:0] sum_11,
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
    localparam integer ShiftedBits = WordBits + 2;
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
    reg [4:0] cycle;                           // cycle of it
    reg signed [WordBits-1:0] a, b, c;         // operands
    reg signed [LowProductBits-1:0] low;       // a times the low bits of b
    reg signed [63:0] product;                 // a times b
    reg signed [ShiftedBits-1:0] shifted;               // the product as it is shifted, or a divisor
    reg [5:0] bits;                            // of what was divided by last, or half of those of a variance
    reg [5:0] exponent;                        // by how many bits the rest of the information is shifted
    reg [WordBits-1:0] magnitude;              // all magnitudes that were marked
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
        {ran, arrival, strength, ambient, depth, sigma, flags, cut, running, counter, cycle} = 0;
        {a, b, c, low, product, shifted, bits, exponent, magnitude, remainder, quotient} = 0;
    end

    // op, to, a, b, c, whether the product is subtracted, shift, what is added to it, limits, mark
    reg [42:0] instruction;
    always @*
        case (counter)
            // The chance of a bin, and -log(1 - chance) to the third power.
            7'd0: instruction = {Reciprocal, R, Exposure, Power, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0};
            7'd1: instruction = {Alu, T, Ended, R, Zero, 1'b0, 5'd2, ByBits, OfChance, 4'd0};
            7'd2: instruction = {Alu, X1, T, T, Zero, 1'b0, 5'd24, ByNothing, Whole, 4'd0};
            7'd3: instruction = {Alu, X2, X1, T, Zero, 1'b0, 5'd24, ByNothing, Whole, 4'd0};
            7'd4: instruction = {Alu, T, X1, One, T, 1'b0, 5'd1, ByNothing, Whole, 4'd0};
            7'd5: instruction = {Alu, Ambient, X2, Third, T, 1'b0, 5'd10, ByNothing, OfAmbient, 4'd0};
            7'd6: instruction = {Stop, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            // Where the box stands highest, and how high.
            7'd7: instruction = {Reciprocal, R, Middle, Power, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0};
            7'd8: instruction = {Alu, T, Excess, R, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0};
            7'd9: instruction = {Alu, T, Length, T, Zero, 1'b0, 5'd13, ByNothing, Whole, 4'd0};
            7'd10: instruction = {Alu, Signal, T, Nineteen, Zero, 1'b0, 5'd4, ByNothing, OfSignal, 4'd0};
            7'd11: instruction = {Alu, Arrival, Box, One, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            7'd12: instruction = {Stop, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            // log b is eliminated.
            7'd13: instruction = {Reciprocal, R, Sum33, Power, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0};
            7'd14: instruction = {Alu, F1, Sum13, R, Zero, 1'b0, 5'd2, ByBits, Whole, 4'd0};
            7'd15: instruction = {Alu, F2, Sum23, R, Zero, 1'b0, 5'd2, ByBits, Whole, 4'd0};
            7'd16: instruction = {Alu, F3, Score3, R, Zero, 1'b0, 5'd2, ByBits, Whole, 4'd0};
            7'd17: instruction = {Alu, A11, Sum13, F1, Sum11, 1'b1, 5'd14, ByNothing, Positive, Large};
            7'd18: instruction = {Alu, A12, Sum23, F1, Sum12, 1'b1, 5'd14, ByNothing, Whole, 4'd0};
            7'd19: instruction = {Alu, A22, Sum23, F2, Sum22, 1'b1, 5'd14, ByNothing, Positive, Large};
            7'd20: instruction = {Alu, X1, Score3, F1, Score1, 1'b1, 5'd14, ByNothing, Whole, Large};
            7'd21: instruction = {Alu, X2, Score3, F2, Score2, 1'b1, 5'd14, ByNothing, Whole, Large};
            // The rest is shifted to 16 bits, and solved by Cramer's rule.
            7'd22: instruction = {Exponent, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            7'd23: instruction = {Alu, A11, A11, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0};
            7'd24: instruction = {Alu, A12, A12, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0};
            7'd25: instruction = {Alu, A22, A22, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0};
            7'd26: instruction = {Alu, X1, X1, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0};
            7'd27: instruction = {Alu, X2, X2, One, Zero, 1'b0, 5'd0, ByExponent, Whole, 4'd0};
            7'd28: instruction = {Alu, Det, A11, A22, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            7'd29: instruction = {Alu, Det, A12, A12, Det, 1'b1, 5'd0, ByNothing, Positive, 4'd0};
            7'd30: instruction = {Alu, N1, A22, X1, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            7'd31: instruction = {Alu, N1, A12, X2, N1, 1'b1, 5'd0, ByNothing, Whole, 4'd0};
            7'd32: instruction = {Alu, N2, A11, X2, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            7'd33: instruction = {Alu, N2, A12, X1, N2, 1'b1, 5'd0, ByNothing, Whole, 4'd0};
            7'd34: instruction = {Reciprocal, R, Det, Power, Zero, 1'b0, 5'd0, ByBits, Whole, 4'd0};
            7'd35: instruction = {Alu, D1, N1, R, Zero, 1'b0, 5'd2, ByBits, Whole, 4'd0};
            7'd36: instruction = {Alu, D2, N2, R, Zero, 1'b0, 5'd2, ByBits, Whole, Large};
            7'd37: instruction = {Alu, T, D1, KappaAt, Zero, 1'b0, 5'd14, ByNothing, Whole, Large};
            7'd38: instruction = {Cut, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            7'd39: instruction = {Alu, D1, D1, One, Zero, 1'b0, 5'd0, ByCut, Whole, 4'd0};
            7'd40: instruction = {Alu, D2, D2, One, Zero, 1'b0, 5'd0, ByCut, Whole, 4'd0};
            7'd41: instruction = {Alu, T, F1, D1, F3, 1'b1, 5'd14, ByNothing, Whole, 4'd0};
            7'd42: instruction = {Alu, T, F2, D2, T, 1'b1, 5'd14, ByNothing, OfGrowth, 4'd0};
            7'd43: instruction = {Alu, Ambient, Ambient, T, Ambient, 1'b0, 5'd14, ByNothing, OfAmbient, 4'd0};
            7'd44: instruction = {Alu, X1, D1, Stride, Zero, 1'b0, 5'd17, ByNothing, Whole, 4'd0};
            7'd45: instruction = {Alu, Arrival, X1, One, Arrival, 1'b0, 5'd0, ByNothing, OfWindow, 4'd0};
            7'd46: instruction = {Alu, T, D2, D2, D2, 1'b0, 5'd15, ByNothing, Whole, 4'd0};
            7'd47: instruction = {Alu, Signal, Signal, T, Signal, 1'b0, 5'd14, ByNothing, OfSignal, 4'd0};
            7'd48: instruction = {Stop, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            // Flags 0 and 1: log S is not known to a quarter, to a fifth; 2: nor mu to the pulse's deviation.
            7'd49: instruction = {Alu, N1, A11, R, Zero, 1'b0, 5'd0, ByBoth, Whole, 4'd0};
            7'd50: instruction = {Alu, T, N1, One, Variance, 1'b1, 5'd0, ByNothing, Whole, Flag0};
            7'd51: instruction = {Alu, T, N1, One, Unsure, 1'b1, 5'd0, ByNothing, Whole, Flag1};
            7'd52: instruction = {Root, N2, A22, R, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            7'd53: instruction = {Alu, N2, N2, Stride, Zero, 1'b0, 5'd11, ByBits, Whole, 4'd0};
            7'd54: instruction = {Alu, T, N2, One, Wide, 1'b1, 5'd0, ByNothing, Whole, Flag2};
            // Flags 3 and 4: next to the begin or the end of the window; 5 and 6: the last step was long.
            7'd55: instruction = {Alu, T, Margin, One, Arrival, 1'b1, 5'd0, ByNothing, Whole, Flag3};
            7'd56: instruction = {Alu, T, Arrival, One, End, 1'b1, 5'd0, ByNothing, Whole, 4'd0};
            7'd57: instruction = {Alu, T, Margin, One, T, 1'b1, 5'd0, ByNothing, Whole, Flag4};
            7'd58: instruction = {Alu, T, N2, Two, X1, 1'b0, 5'd0, ByNothing, Whole, Flag5};
            7'd59: instruction = {Alu, X1, X1, One, Zero, 1'b1, 5'd0, ByNothing, Whole, 4'd0};
            7'd60: instruction = {Alu, T, N2, Two, X1, 1'b0, 5'd0, ByNothing, Whole, Flag6};
            7'd61: instruction = {Alu, Depth, Arrival, MetresAt, Zero, 1'b0, 5'd0, ByMetres, Whole, 4'd0};
            7'd62: instruction = {Alu, SigmaAt, N2, MetresAt, Zero, 1'b0, 5'd0, ByMetres, Whole, 4'd0};
            7'd63: instruction = {Stop, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
            default: instruction = {Stop, Zero, Zero, Zero, Zero, 1'b0, 5'd0, ByNothing, Whole, 4'd0};
        endcase

    wire [2:0] op;
    wire [5:0] to, from_a, from_b, from_c;
    wire minus;
    wire [4:0] base;
    wire [2:0] by, limits;
    wire [3:0] mark;
    assign {op, to, from_a, from_b, from_c, minus, base, by, limits, mark} = instruction;

    // Operands
    reg signed [WordBits-1:0] other_a, other_c;
    always @* begin
        case (from_a)
            Sum13: other_a = sum_13 >>> 5;
            Sum23: other_a = sum_23;
            Sum33: other_a = sum_33;
            Score3: other_a = score_3 <<< 2;
            Ended: other_a = lone ? {ambient_ended, 12'd0} : {ambient_ended, 16'd0};
            Exposure: other_a = ambient_exposure;
            Excess: other_a = best_excess <<< 4;
            Middle: other_a = best_middle;
            Length: other_a = box_length;
            default: other_a = {box_sum, 9'd0};
        endcase
        case (from_c)
            Sum11: other_c = sum_11 >>> 1;
            Sum12: other_c = sum_12 >>> 5;
            Sum22: other_c = sum_22;
            Score1: other_c = score_1 >>> 3;
            default: other_c = score_2 <<< 2;
        endcase
    end

    // The bits of a, or of what has been marked
    wire [WordBits-1:0] measured = op == Reciprocal ? (a[WordBits-1] ? 0 : a) : magnitude;
    reg [5:0] length;
    always @* begin
        length = 6'd0;
        for (i = 0; i < WordBits; i = i + 1) if (measured[i]) length = i + 1;
    end

    // One multiplier: the low bits of b, then the others
    wire signed [WordBits-18:0] part = cycle == 5'd1 ? $signed({1'b0, b[16:0]}) : $signed(b[WordBits-1:17]);
    wire signed [LowProductBits-1:0] partial = a * part;

    // The shift; a divisor is not rounded
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
    wire [5:0] shift = all_shift > 63 ? 6'd63 : all_shift;
    wire signed [64:0] down = $signed({product, 1'b0}) >>> shift;
    wire signed [ShiftedBits-1:0] moved = $signed(down[ShiftedBits:1]) + $signed({1'b0, down[0] && op != Reciprocal});
    // One place is left for the rounding.
    wire moved_fits = down[64:ShiftedBits-1] == {66 - ShiftedBits{down[64]}};
    wire odd = bits[0] ^ exponent[0];

    // A bit of a reciprocal or of a root
    wire [27:0] left = op == Root ? {remainder[25:0], product[49:48]} : {remainder[26:0], 1'b1};
    wire [27:0] against = op == Root ? {quotient, 2'b01} : shifted[27:0];
    wire fits = left >= against;

    // The sum, within its limits
    wire signed [ShiftedBits:0] sum = minus ? c - shifted : c + shifted;
    wire signed [WordBits-1:0] top = {1'b0, {WordBits - 1{1'b1}}};
    reg signed [WordBits-1:0] least, most;
    always @* begin
        case (limits)
            Whole: {least, most} = {~top, top};
            Positive: {least, most} = {{WordBits - 1{1'b0}}, 1'b1, top};
            OfSignal: begin least = 16; most = 16777215; end
            OfAmbient: begin least = 1; most = 16777215; end
            OfChance: begin least = 1; most = 8388608; end
            OfWindow: begin least = 0; most = WindowEnd; end
            default: begin least = -8192; most = 49152; end
        endcase
    end
    wire signed [WordBits-1:0] result = op != Alu ? quotient : sum < least ? least : sum > most ? most : sum;
    wire [4:0] last_cycle = op == Reciprocal ? 5'd22 : op == Root ? 5'd30 : 5'd4;
    wire ends = cycle == last_cycle;
    wire computes = op == Alu || op == Reciprocal || op == Root;
    wire [6:0] marked = 7'd1 << mark[2:0];
    wire [WordBits-1:0] absolute = result < 0 ? -result : result;

    always @(posedge clk_sys)
        if (running && !run && computes && ends && !to[5]) words[to[4:0]] <= result;

    always @(posedge clk_sys) begin
        if (rst) begin
            {ran, arrival, strength, ambient, depth, sigma, flags, cut, running, counter, cycle} <= 0;
            {a, b, c, low, product, shifted, bits, exponent, magnitude, remainder, quotient} <= 0;
        end else begin
            ran <= 1'b0;
            if (run) begin
                running <= 1'b1;
                counter <= entry;
                cycle <= 5'd0;
                magnitude <= 0;
            end else if (running) begin
                if (op == Stop) {running, ran} <= 2'b01;
                if (op == Exponent || op == Cut) begin
                    if (op == Exponent) exponent <= length > 6'd16 ? length - 6'd16 : 6'd0;
                    else cut <= length > 6'd14 ? length - 6'd14 : 6'd0;
                    magnitude <= 0;
                    counter <= counter + 7'd1;
                end
                if (computes) begin
                    cycle <= ends ? 5'd0 : cycle + 5'd1;
                    if (ends) counter <= counter + 7'd1;
                    case (cycle)
                        5'd0: begin
                            a <= from_a[5] ? other_a : words[from_a[4:0]];
                            b <= words[from_b[4:0]];
                            c <= from_c[5] ? other_c : words[from_c[4:0]];
                        end
                        5'd1: begin
                            low <= partial;
                            if (op == Reciprocal) bits <= length == 6'd0 ? 6'd1 : length;
                        end
                        5'd2: product <= low + (partial <<< 17);
                        5'd3:
                            if (op == Root) product <= odd ? product <<< 17 : product <<< 16;
                            else shifted <= moved_fits ? moved : {down[64], {ShiftedBits - 1{!down[64]}}};
                        default: ;
                    endcase
                    if (op != Alu && cycle == 5'd4) begin
                        remainder <= op == Root ? 28'd0 : 28'd65535;
                        quotient <= 25'd0;
                    end else if (op != Alu && cycle > 5'd4) begin
                        if (op == Root) product <= product <<< 2;
                        remainder <= fits ? left - against : left;
                        quotient <= {quotient[23:0], fits};
                        if (op == Root && ends) bits <= (10 + bits + exponent + odd) >> 1;
                    end
                    if (ends) begin
                        case (to)
                            Arrival: arrival <= result;
                            Signal: strength <= result;
                            Ambient: ambient <= result;
                            Depth: depth <= result;
                            SigmaAt: sigma <= result;
                            default: ;
                        endcase
                        if (mark == Large) magnitude <= magnitude | absolute;
                        if (mark[3]) flags <= (flags & ~marked) | (result < 0 ? marked : 7'd0);
                    end
                end
            end
        end
    end
endmodule
// verilator lint_on UNUSEDSIGNAL
// verilator lint_on WIDTH
