`timescale 1ps / 1fs
`default_nettype none

// Argmax with centroid correction, with the ports of depth_estimator.
//
// A window of 2 HalfWidth + 1 words slides over the histogram; where its centre stands highest, its
// centroid becomes the depth. 56 cycles more than there are bins: 312 with 256.
//
//   edge       e(s+1)                                 e(s+2)                    e(s+3)
//   registers  entering, leaving, level, centre       change, weighted, height  sum, ages, best ..
//
// for the word of cycle s and the window that ends before it.
module centroid_estimator #(
    parameter integer BinBits = 8,           // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,        // of a word of the histogram, 8 to 24
    parameter [4:0] HalfWidth = 5'd23,       // words to either side of the centre, 1 to 31 [bins]
    parameter [0:0] Background = 1'b1,       // 1: height is counted from the window's first word
    parameter [16:0] Slope = 17'd62871,      // distance of a bin [2^-24 m]
    parameter signed [29:0] Offset = 30'sd0  // distance that is added [2^-29 m]
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,               // starts an estimation
    // Histogram
    output reg read_en,                  // the histogram's word at read_addr is being read
    output reg [BinBits-1:0] read_addr,  // word of the histogram
    input wire [CountBits-1:0] count,    // word of the histogram at read_addr [hits]
    // Result
    output reg signed [35:0] depth,      // when algo_done is high, and until the next one [2^-29 m]
    output reg algo_done                 // the depth is ready; one cycle
);
    // Cycles after the edge that takes algo_start: first one of the division, then the ones before
    // the edge that makes the position, and before the one that makes the depth.
    localparam integer Bins = 1 << BinBits, LastAt = Bins + 55;
    localparam integer StepBits = $clog2(LastAt + 1);
    localparam [StepBits-1:0] Last = LastAt[StepBits-1:0], Place = Last - 3, Divide = Place - 18;
    localparam [5:0] Words = {HalfWidth, 1'b1};  // of the window
    // A window has 63 words at most, of 0 to 62 ages.
    localparam integer WindowBits = CountBits + 6, AgesBits = CountBits + 11, RemainderBits = CountBits + 13;
    // A position has 12 fraction bits, and 18 bits go into one multiplier.
    localparam integer PlaceBits = BinBits > 7 ? BinBits : 7, PositionBits = PlaceBits + 12;
    localparam integer HighBits = PositionBits - 18, CoarseBits = HighBits + 17, DistanceBits = PositionBits + 10;

    reg busy;                           // an estimation is under way
    reg [StepBits-1:0] step;            // cycles since e0
    reg whole;                          // the window has all its words
    reg [5:0] first;                    // place of its first word, of word 0 before that
    reg [CountBits-1:0] entering;       // the word that enters the window [hits]
    reg [CountBits-1:0] leaving;        // the word that leaves it [hits]
    reg [CountBits-1:0] level;          // background at its centre [hits]
    reg [CountBits-1:0] centre;         // the word at its centre [hits]
    reg signed [CountBits:0] change;    // what entering and leaving change in sum [hits]
    reg [WindowBits-1:0] weighted;      // leaving, as often as the window has words
    reg [CountBits-1:0] height;         // centre above the level, 0 below it or where none is [hits]
    reg [WindowBits-1:0] sum;           // hits in the window
    reg [AgesBits-1:0] ages;            // hits in the window, each times the words that came after its own
    reg [CountBits-1:0] best;           // height of the highest centre [hits]
    reg [BinBits-1:0] peak;             // its bin
    reg [WindowBits-1:0] best_sum;      // hits in its window: the divisor
    reg [RemainderBits-1:0] remainder;  // ages of its window, then what the division leaves of it
    reg [17:0] quotient;                // mean age of the hits in its window [2^-12 bins]
    reg [PositionBits-1:0] position;    // centroid from the begin of bin 0 [2^-12 bins]
    reg [34:0] fine;                    // low 18 bits of position times slope [2^-36 m]
    reg [CoarseBits-1:0] coarse;        // those above them times slope [2^-18 m]
    reg [DistanceBits-1:0] distance;    // position times slope [2^-29 m]

    // The last words, each at its number plus one modulo 64, without reset: nothing is read before it
    // has been written.
    (* ram_style = "distributed" *) reg [CountBits-1:0] window [0:63];

    reg algo_done_next, read_en_next, busy_next;
    reg [BinBits-1:0] read_addr_next, peak_next;
    reg signed [35:0] depth_next;
    reg [StepBits-1:0] step_next;
    reg whole_next;
    reg [5:0] first_next;
    reg [CountBits-1:0] entering_next, leaving_next, level_next, centre_next;
    reg [CountBits-1:0] height_next, best_next;
    reg signed [CountBits:0] change_next;
    reg [WindowBits-1:0] weighted_next, sum_next, best_sum_next;
    reg [AgesBits-1:0] ages_next;
    reg [RemainderBits-1:0] remainder_next;
    reg [17:0] quotient_next;
    reg [PositionBits-1:0] position_next;
    reg [34:0] fine_next;
    reg [CoarseBits-1:0] coarse_next;
    reg [DistanceBits-1:0] distance_next;

    integer i;
    initial begin
        for (i = 0; i < 64; i = i + 1) window[i] = {CountBits{1'b0}};
        {algo_done, read_en, busy} = 3'd0;
        {read_addr, peak} = {2 * BinBits{1'b0}};
        depth = 36'sd0;
        step = {StepBits{1'b0}};
        whole = 1'b0;
        first = 6'd0;
        {entering, leaving, level, centre, height, best} = {6 * CountBits{1'b0}};
        change = {CountBits + 1{1'b0}};
        {weighted, sum, best_sum} = {3 * WindowBits{1'b0}};
        ages = {AgesBits{1'b0}};
        remainder = {RemainderBits{1'b0}};
        quotient = 18'd0;
        position = {PositionBits{1'b0}};
        fine = 35'd0;
        coarse = {CoarseBits{1'b0}};
        distance = {DistanceBits{1'b0}};
    end

    wire sliding = busy && step < Divide;
    wire [CountBits-1:0] first_word = window[first];
    wire [5:0] centre_place = step[5:0] - {1'b0, HalfWidth};
    wire [CountBits-1:0] centre_word = window[centre_place];

    // A cycle later.
    wire [StepBits-1:0] half_width = {{StepBits - 5{1'b0}}, HalfWidth};
    wire centred = step > half_width + 1'b1;
    wire [CountBits:0] over = {1'b0, centre} - {1'b0, level};

    // Another cycle later.
    wire higher = height > best;
    // verilator lint_off UNUSEDSIGNAL
    wire [StepBits-1:0] centre_number = step - 3 - half_width;
    // verilator lint_on UNUSEDSIGNAL

    // Restoring division, a bit a cycle.
    wire [RemainderBits-1:0] shifted = {remainder[RemainderBits-2:0], 1'b0};
    wire [RemainderBits:0] left = {1'b0, shifted} - {2'd0, best_sum, 6'd0};
    wire fits = !left[RemainderBits];

    // Bin i is centred at i + 1/2. The centroid is within the bins, so the carry out of the sum means nothing.
    wire [PlaceBits:0] peak_place = {{PlaceBits + 1 - BinBits{1'b0}}, peak};
    // verilator lint_off UNUSEDSIGNAL
    wire [PlaceBits:0] window_end = peak_place + {{PlaceBits - 4{1'b0}}, HalfWidth};
    // verilator lint_on UNUSEDSIGNAL
    // A multiplier has 18 bits. The low ones are rounded down: a depth word has no place for them.
    // verilator lint_off UNUSEDSIGNAL
    wire [CoarseBits+17:0] product = {{CoarseBits - 17{1'b0}}, fine} + {coarse, 18'd0};
    // verilator lint_on UNUSEDSIGNAL

    always @* begin
        algo_done_next = 1'b0;
        read_en_next = read_en;
        read_addr_next = read_addr;
        depth_next = depth;
        busy_next = busy;
        step_next = step;
        whole_next = whole;
        first_next = first;
        entering_next = entering;
        leaving_next = leaving;
        level_next = level;
        centre_next = centre;
        change_next = change;
        weighted_next = weighted;
        height_next = height;
        sum_next = sum;
        ages_next = ages;
        best_next = best;
        peak_next = peak;
        best_sum_next = best_sum;
        remainder_next = remainder;
        quotient_next = quotient;
        position_next = position;
        fine_next = {17'd0, position[17:0]} * {18'd0, Slope};
        coarse_next = {17'd0, position[PositionBits-1:18]} * {{HighBits{1'b0}}, Slope};
        distance_next = product[CoarseBits+17:7];
        if (busy) begin
            step_next = step + 1'b1;
            read_en_next = step_next < Bins[StepBits-1:0];
            read_addr_next = read_en_next ? step_next[BinBits-1:0] : {BinBits{1'b0}};
            if (step < Divide) begin
                whole_next = step >= {half_width[StepBits-2:0], 1'b0};
                first_next = whole ? first + 6'd1 : 6'd1;
                entering_next = read_en ? count : {CountBits{1'b0}};
                leaving_next = whole ? first_word : {CountBits{1'b0}};
                // Pile-up makes the background fall with time, so the first word is at least its
                // level. No word is there before word 0: it stands for those, doubled, as bins may be
                // twice as wide as others. No word is above the greatest.
                level_next = !Background ? {CountBits{1'b0}} : whole ? first_word
                    : first_word[CountBits-1] ? {CountBits{1'b1}} : {first_word[CountBits-2:0], 1'b0};
                centre_next = centre_word;
                change_next = {1'b0, entering} - {1'b0, leaving};
                weighted_next = {{CountBits{1'b0}}, Words} * {6'd0, leaving};
                height_next = centred && !over[CountBits] ? over[CountBits-1:0] : {CountBits{1'b0}};
                if (higher) begin
                    best_next = height;
                    peak_next = centre_number[BinBits-1:0];
                    best_sum_next = sum;
                    remainder_next = {2'd0, ages};
                end
                sum_next = sum + {{5{change[CountBits]}}, change};
                ages_next = ages + {5'd0, sum} - {5'd0, weighted};
            end else if (step < Place) begin
                remainder_next = fits ? left[RemainderBits-1:0] : shifted;
                quotient_next = {quotient[16:0], fits};
            end else if (step == Place) begin
                position_next = {window_end[PlaceBits-1:0], 12'd2048} - {{HighBits{1'b0}}, quotient};
            end else if (step == Last) begin
                depth_next = best == {CountBits{1'b0}} ? 36'sd0
                    : {{36 - DistanceBits{1'b0}}, distance} + {{6{Offset[29]}}, Offset};
                algo_done_next = 1'b1;
                busy_next = 1'b0;
                step_next = {StepBits{1'b0}};
            end
        end else if (algo_start) begin
            read_en_next = 1'b1;
            read_addr_next = {BinBits{1'b0}};
            busy_next = 1'b1;
            step_next = {StepBits{1'b0}};
            whole_next = 1'b0;
            first_next = 6'd0;
            entering_next = {CountBits{1'b0}};
            leaving_next = {CountBits{1'b0}};
            level_next = {CountBits{1'b0}};
            centre_next = {CountBits{1'b0}};
            change_next = {CountBits + 1{1'b0}};
            weighted_next = {WindowBits{1'b0}};
            height_next = {CountBits{1'b0}};
            sum_next = {WindowBits{1'b0}};
            ages_next = {AgesBits{1'b0}};
            best_next = {CountBits{1'b0}};
            peak_next = {BinBits{1'b0}};
            best_sum_next = {WindowBits{1'b0}};
            remainder_next = {RemainderBits{1'b0}};
            quotient_next = 18'd0;
            position_next = {PositionBits{1'b0}};
            fine_next = 35'd0;
            coarse_next = {CoarseBits{1'b0}};
            distance_next = {DistanceBits{1'b0}};
        end
    end

    always @(posedge clk_sys) if (sliding) window[step[5:0]] <= entering;

    always @(posedge clk_sys) begin
        if (rst) begin
            algo_done <= 1'b0;
            read_en <= 1'b0;
            read_addr <= {BinBits{1'b0}};
            depth <= 36'sd0;
            busy <= 1'b0;
            step <= {StepBits{1'b0}};
            whole <= 1'b0;
            first <= 6'd0;
            entering <= {CountBits{1'b0}};
            leaving <= {CountBits{1'b0}};
            level <= {CountBits{1'b0}};
            centre <= {CountBits{1'b0}};
            change <= {CountBits + 1{1'b0}};
            weighted <= {WindowBits{1'b0}};
            height <= {CountBits{1'b0}};
            sum <= {WindowBits{1'b0}};
            ages <= {AgesBits{1'b0}};
            best <= {CountBits{1'b0}};
            peak <= {BinBits{1'b0}};
            best_sum <= {WindowBits{1'b0}};
            remainder <= {RemainderBits{1'b0}};
            quotient <= 18'd0;
            position <= {PositionBits{1'b0}};
            fine <= 35'd0;
            coarse <= {CoarseBits{1'b0}};
            distance <= {DistanceBits{1'b0}};
        end else begin
            algo_done <= algo_done_next;
            read_en <= read_en_next;
            read_addr <= read_addr_next;
            depth <= depth_next;
            busy <= busy_next;
            step <= step_next;
            whole <= whole_next;
            first <= first_next;
            entering <= entering_next;
            leaving <= leaving_next;
            level <= level_next;
            centre <= centre_next;
            change <= change_next;
            weighted <= weighted_next;
            height <= height_next;
            sum <= sum_next;
            ages <= ages_next;
            best <= best_next;
            peak <= peak_next;
            best_sum <= best_sum_next;
            remainder <= remainder_next;
            quotient <= quotient_next;
            position <= position_next;
            fine <= fine_next;
            coarse <= coarse_next;
            distance <= distance_next;
        end
    end
endmodule
