`timescale 1ps / 1fs
`default_nettype none

// Argmax with centroid correction, with the ports of depth_estimator.
//
// A window of 2 HalfWidth + 1 words slides over the histogram; where its centre stands highest, its
// centroid becomes the depth. 312 cycles.
//
//   edge       e(s+1)                                 e(s+2)                    e(s+3)
//   registers  entering, leaving, level, centre       change, weighted, height  sum, ages, best ..
//
// for the word of cycle s and the window that ends before it.
module centroid_estimator #(
    parameter [4:0] HalfWidth = 5'd23,        // words to either side of the centre, 1 to 31 [bins]
    parameter [0:0] Background = 1'b1,        // 1: height is counted from the window's first word
    parameter [16:0] Slope = 17'd62871,       // distance of a bin [2^-24 m]
    parameter signed [29:0] Offset = 30'sd0   // distance that is added [2^-29 m]
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,           // starts an estimation
    // Histogram
    output reg read_en,              // the histogram's word at read_addr is being read
    output reg [7:0] read_addr,      // word of the histogram
    input wire [15:0] count,         // word of the histogram at read_addr [hits]
    // Result
    output reg signed [35:0] depth,  // when algo_done is high, and until the next one [2^-29 m]
    output reg algo_done             // the depth is ready; one cycle
);
    // Cycles after the edge that takes algo_start: first one of the division, then the ones before
    // the edge that makes the position, and before the one that makes the depth.
    localparam [8:0] Divide = 9'd290, Place = 9'd308, Last = 9'd311;
    localparam [5:0] Words = {HalfWidth, 1'b1};  // of the window

    reg busy;              // an estimation is under way
    reg [8:0] step;        // cycles since e0
    reg whole;             // the window has all its words
    reg [5:0] first;       // place of its first word, of word 0 before that
    reg [15:0] entering;   // the word that enters the window [hits]
    reg [15:0] leaving;    // the word that leaves it [hits]
    reg [15:0] level;      // background at its centre [hits]
    reg [15:0] centre;     // the word at its centre [hits]
    reg signed [16:0] change;  // what entering and leaving change in sum [hits]
    reg [21:0] weighted;   // leaving, as often as the window has words
    reg [15:0] height;     // centre above the level, 0 below it or where none is [hits]
    reg [21:0] sum;        // hits in the window
    reg [26:0] ages;       // hits in the window, each times the words that came after its own
    reg [15:0] best;       // height of the highest centre [hits]
    reg [7:0] peak;        // its bin
    reg [21:0] best_sum;   // hits in its window: the divisor
    reg [28:0] remainder;  // ages of its window, then what the division leaves of it
    reg [17:0] quotient;   // mean age of the hits in its window [2^-12 bins]
    reg [19:0] position;   // centroid from the begin of bin 0 [2^-12 bins]
    reg [34:0] fine;       // low 18 bits of position times slope [2^-36 m]
    reg [18:0] coarse;     // the two above them times slope [2^-18 m]
    reg [29:0] distance;   // position times slope [2^-29 m]

    // The last words, each at its number plus one modulo 64, without reset: nothing is read before it
    // has been written.
    (* ram_style = "distributed" *) reg [15:0] window [0:63];

    reg algo_done_next, read_en_next, busy_next;
    reg [7:0] read_addr_next, peak_next;
    reg signed [35:0] depth_next;
    reg [8:0] step_next;
    reg whole_next;
    reg [5:0] first_next;
    reg [15:0] entering_next, leaving_next, level_next, centre_next;
    reg [15:0] height_next, best_next;
    reg signed [16:0] change_next;
    reg [21:0] weighted_next, sum_next, best_sum_next;
    reg [26:0] ages_next;
    reg [28:0] remainder_next;
    reg [17:0] quotient_next;
    reg [19:0] position_next;
    reg [34:0] fine_next;
    reg [18:0] coarse_next;
    reg [29:0] distance_next;

    integer i;
    initial begin
        for (i = 0; i < 64; i = i + 1) window[i] = 16'd0;
        {algo_done, read_en, busy} = 3'd0;
        {read_addr, peak} = 16'd0;
        depth = 36'sd0;
        step = 9'd0;
        whole = 1'b0;
        first = 6'd0;
        {entering, leaving, level, centre, height, best} = 96'd0;
        change = 17'sd0;
        {weighted, sum, best_sum} = 66'd0;
        ages = 27'd0;
        remainder = 29'd0;
        quotient = 18'd0;
        position = 20'd0;
        fine = 35'd0;
        coarse = 19'd0;
        distance = 30'd0;
    end

    wire sliding = busy && step < Divide;
    wire [15:0] first_word = window[first];
    wire [5:0] centre_place = step[5:0] - {1'b0, HalfWidth};
    wire [15:0] centre_word = window[centre_place];

    // A cycle later.
    wire centred = step > {4'd0, HalfWidth} + 9'd1;
    wire [16:0] over = {1'b0, centre} - {1'b0, level};

    // Another cycle later.
    wire higher = height > best;
    wire [7:0] centre_number = step[7:0] - 8'd3 - {3'd0, HalfWidth};

    // Restoring division, a bit a cycle.
    wire [28:0] shifted = {remainder[27:0], 1'b0};
    wire [29:0] left = {1'b0, shifted} - {2'd0, best_sum, 6'd0};
    wire fits = !left[29];

    // Bin i is centred at i + 1/2. The centroid is below 256, so the carry out of the sum means nothing.
    wire [7:0] window_end = peak + {3'd0, HalfWidth};
    // A multiplier has 18 bits. The low ones are rounded down: a depth word has no place for them.
    // verilator lint_off UNUSEDSIGNAL
    wire [36:0] product = {2'd0, fine} + {coarse, 18'd0};
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
        coarse_next = {17'd0, position[19:18]} * {2'd0, Slope};
        distance_next = product[36:7];
        if (busy) begin
            step_next = step + 9'd1;
            read_en_next = !step_next[8];
            read_addr_next = read_en_next ? step_next[7:0] : 8'd0;
            if (step < Divide) begin
                whole_next = step >= {3'd0, HalfWidth, 1'b0};
                first_next = whole ? first + 6'd1 : 6'd1;
                entering_next = read_en ? count : 16'd0;
                leaving_next = whole ? first_word : 16'd0;
                // Pile-up makes the background fall with time, so the first word is at least its
                // level. No word is there before word 0: it stands for those, doubled, as bins may be
                // twice as wide as others. No word is above the greatest.
                level_next = !Background ? 16'd0 : whole ? first_word
                    : first_word[15] ? 16'hffff : {first_word[14:0], 1'b0};
                centre_next = centre_word;
                change_next = {1'b0, entering} - {1'b0, leaving};
                weighted_next = {16'd0, Words} * {6'd0, leaving};
                height_next = centred && !over[16] ? over[15:0] : 16'd0;
                if (higher) begin
                    best_next = height;
                    peak_next = centre_number;
                    best_sum_next = sum;
                    remainder_next = {2'd0, ages};
                end
                sum_next = sum + {{5{change[16]}}, change};
                ages_next = ages + {5'd0, sum} - {5'd0, weighted};
            end else if (step < Place) begin
                remainder_next = fits ? left[28:0] : shifted;
                quotient_next = {quotient[16:0], fits};
            end else if (step == Place) begin
                position_next = {window_end, 12'd2048} - {2'd0, quotient};
            end else if (step == Last) begin
                depth_next = best == 16'd0 ? 36'sd0
                    : {6'd0, distance} + {{6{Offset[29]}}, Offset};
                algo_done_next = 1'b1;
                busy_next = 1'b0;
                step_next = 9'd0;
            end
        end else if (algo_start) begin
            read_en_next = 1'b1;
            read_addr_next = 8'd0;
            busy_next = 1'b1;
            step_next = 9'd0;
            whole_next = 1'b0;
            first_next = 6'd0;
            entering_next = 16'd0;
            leaving_next = 16'd0;
            level_next = 16'd0;
            centre_next = 16'd0;
            change_next = 17'sd0;
            weighted_next = 22'd0;
            height_next = 16'd0;
            sum_next = 22'd0;
            ages_next = 27'd0;
            best_next = 16'd0;
            peak_next = 8'd0;
            best_sum_next = 22'd0;
            remainder_next = 29'd0;
            quotient_next = 18'd0;
            position_next = 20'd0;
            fine_next = 35'd0;
            coarse_next = 19'd0;
            distance_next = 30'd0;
        end
    end

    always @(posedge clk_sys) if (sliding) window[step[5:0]] <= entering;

    always @(posedge clk_sys) begin
        if (rst) begin
            algo_done <= 1'b0;
            read_en <= 1'b0;
            read_addr <= 8'd0;
            depth <= 36'sd0;
            busy <= 1'b0;
            step <= 9'd0;
            whole <= 1'b0;
            first <= 6'd0;
            entering <= 16'd0;
            leaving <= 16'd0;
            level <= 16'd0;
            centre <= 16'd0;
            change <= 17'sd0;
            weighted <= 22'd0;
            height <= 16'd0;
            sum <= 22'd0;
            ages <= 27'd0;
            best <= 16'd0;
            peak <= 8'd0;
            best_sum <= 22'd0;
            remainder <= 29'd0;
            quotient <= 18'd0;
            position <= 20'd0;
            fine <= 35'd0;
            coarse <= 19'd0;
            distance <= 30'd0;
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
