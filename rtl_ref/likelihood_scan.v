`timescale 1ps / 1fs
`default_nettype none

// Where a box stands highest above ambient light, in the likelihood estimator, and how much of that there is.
//
// In a scan a box slides over the bins; a memory keeps what entered it until it leaves. One unit takes
// logarithms: of excess and of what is expected, in the two cycles of a beat, and of blocks of bins in a load.
module likelihood_scan #(
    parameter [0:0] Used = 1'b1,                 // 0: nothing starts it, and it has no ROMs
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter integer BoxBins = 15,              // bins of the box
    parameter LogFile = "rtl_ref/log2.mem"       // 64 log2(1 + (i + 1/2) / 64)
) (
    input wire clk_sys,
    input wire load,                             // begins a load
    // Blocks of an eighth of the bins
    input wire block_done,                       // one is complete
    input wire [CountBits+BinBits-1:0] block_ended,     // its hits
    input wire [CountBits+BinBits+9:0] block_exposure,  // its exposure [shots units]
    // Passes
    input wire pass,                             // begins a pass
    input wire scan,                             // it is a scan
    input wire phase,                            // second cycle of a beat
    input wire slide,                            // a bin of a scan, or a beat after the last one, comes
    input wire signed [CountBits+8:0] residual,  // n k - R lambda [2^-4 counts], 0 of what is no bin
    // The box counts in 256ths.
    // verilator lint_off UNUSEDSIGNAL
    input wire [CountBits+17:0] predicted,        // R lambda [2^-12 counts]
    // verilator lint_on UNUSEDSIGNAL
    input wire [CountBits:0] middle,             // twice the shots that wait in the middle of the bin
    input wire waits,                            // shots wait at it
    // The highest box
    output reg signed [13:0] best_score,         // of its squared excess over what is expected [log2 / 64]
    output reg signed [CountBits+BinBits+13:0] best_excess,  // [2^-8 counts]
    output reg [CountBits+BinBits:0] best_middle,  // twice the shots that wait in the middle of its bins
    output reg [BinBits:0] box_length,           // bins in it
    output reg [BinBits+1:0] box_sum,            // its first bin and the one after its last, together
    // The block that shows the ambient light
    output reg [CountBits-1:0] ambient_ended,    // its hits
    output reg [CountBits+BinBits+9:0] ambient_exposure,  // its exposure [shots units]
    output reg lone                              // it is the only one with enough exposure
);
    localparam integer Bins = 1 << BinBits, RestBits = CountBits + BinBits, ExposureBits = RestBits + 10;
    localparam integer ExcessBits = RestBits + 14, BoxExpectedBits = RestBits + 14, MiddleBits = CountBits + 1;
    localparam integer BoxMiddleBits = MiddleBits + BinBits, LogBits = BoxExpectedBits;
    localparam integer BoxTermBits = CountBits + 15, KeptBits = 2 * BoxTermBits + MiddleBits;
    // Numbers of bins are integers elsewhere.
    // verilator lint_off WIDTH
    localparam [BinBits:0] All = Bins, Box = BoxBins, Back = BoxBins - BoxBins / 2;
    // verilator lint_on WIDTH

    reg [BinBits:0] count;                           // bins that have come
    reg [BinBits-1:0] newest;                        // the last of them
    reg signed [BinBits+1:0] oldest, centre;         // the box's first bin and its middle, negative before bin 0
    reg entered;                                     // a bin has come
    reg signed [BoxTermBits-1:0] entering_excess, leaving_excess;           // of what enters and leaves the box
    reg [BoxTermBits-1:0] entering_expected, leaving_expected;              // [2^-8 counts]
    reg [MiddleBits-1:0] entering_middle, leaving_middle;
    reg signed [ExcessBits-1:0] excess_0, excess_1, excess_2, excess_3;  // of the box, and as it goes along
    reg [BoxExpectedBits-1:0] box_expected;
    reg [BoxMiddleBits-1:0] box_middle_0, box_middle_1, box_middle_2, box_middle_3;
    reg signed [ExcessBits-1:0] held_excess;         // the box as it was in the first cycle of the beat
    reg [BoxExpectedBits-1:0] held_expected;
    reg [BoxMiddleBits-1:0] held_middle;
    reg boxed_0, boxed_1, boxed_2, boxed_3;          // the box is within the histogram
    reg [BinBits:0] from_0, from_1, from_2, from_3;  // its first bin in the histogram
    reg [BinBits:0] until_0, until_1, until_2, until_3;  // the one after its last
    reg [LogBits-1:0] log_number;                    // the number whose logarithm is taken
    reg [21:0] log_value;                            // its top
    reg [1:0] log_high;                              // high bits of the place of its leading one
    reg [21:0] log_mantissa;                         // that top, raised until its leading one is in the upper 4 bits
    reg [3:0] log_middle;                            // all but the low bits of that one's place
    reg log_expected_0, log_expected_1, log_expected_2;  // it is what is expected, of which 1 is the least
    reg signed [13:0] upper_log, lower_log;          // of excess or hits, of what is expected or an exposure
    reg signed [13:0] score;                         // of the box
    reg [BinBits:0] best_from, best_until;           // first bin of the highest box, and the one after its last
    reg [ExposureBits-1:0] held_exposure;            // of the block
    reg block_0, block_1, block_2, block_3, block_4; // a block is in the logarithms
    reg [2:0] block_count;                           // blocks that have come
    reg [2:0] judged;                                // blocks whose hazards are known
    reg [3:0] exposed;                               // blocks that have enough exposure
    reg signed [13:0] threshold;                     // logarithm that an exposure has to be above
    reg signed [13:0] lowest_0, lowest_1, lowest_2;  // logarithms of the lowest hazards, in order
    reg [2:0] which_0, which_1, which_2;             // their blocks

    reg [KeptBits-1:0] kept [0:Bins-1];              // what entered
    (* ram_style = "distributed" *) reg [RestBits+ExposureBits-1:0] blocks [0:7];  // exposures and hits
    reg [6:0] logs [0:63];

    integer i;
    initial begin
        if (Used) $readmemh(LogFile, logs);
        for (i = 0; i < Bins; i = i + 1) kept[i] = 0;
        for (i = 0; i < 8; i = i + 1) blocks[i] = 0;
        {best_score, best_excess, best_middle, box_length, box_sum, ambient_ended, ambient_exposure, lone} = 0;
        {count, newest, oldest, centre, entered, entering_excess, leaving_excess} = 0;
        {entering_expected, leaving_expected, entering_middle, leaving_middle} = 0;
        {excess_0, excess_1, excess_2, excess_3, box_expected, held_excess, held_expected, held_middle} = 0;
        {box_middle_0, box_middle_1, box_middle_2, box_middle_3, boxed_0, boxed_1, boxed_2, boxed_3} = 0;
        {from_0, from_1, from_2, from_3, until_0, until_1, until_2, until_3, best_from, best_until} = 0;
        {log_number, log_value, log_high, log_mantissa, log_middle, log_expected_0, log_expected_1, log_expected_2} = 0;
        {upper_log, lower_log, score, held_exposure} = 0;
        {block_0, block_1, block_2, block_3, block_4, block_count, judged, exposed, threshold} = 0;
        {lowest_0, lowest_1, lowest_2, which_0, which_1, which_2} = 0;
    end

    // The unit that takes logarithms. A number is raised until its leading one is at the top, in steps, the longest
    // first: each tells a bit of that one's place. Two of them come before each register.
    reg [LogBits-1:0] value;
    reg [63:0] raised;
    reg [21:0] raised_on, mantissa;
    reg [3:0] middle_bits;
    reg [5:0] leading;
    always @* begin
        case ({scan, scan ? phase : block_done})
            // The largest of these numbers is as long as the word; the others are extended.
            // verilator lint_off WIDTH
            2'b00: value = held_exposure;
            2'b01: value = block_ended;
            // verilator lint_on WIDTH
            2'b10: value = $unsigned(excess_0);  // that of a negative one is of no use
            default: value = held_expected;
        endcase
        // It is extended, to be raised.
        // verilator lint_off WIDTH
        raised = log_number;
        // verilator lint_on WIDTH
        raised_on = log_value;
        middle_bits[3:2] = log_high;
        for (i = 3; i >= 2; i = i - 1) begin
            middle_bits[i - 2] = |(raised_on >> (22 - (1 << i)));
            if (!middle_bits[i - 2]) raised_on = raised_on << (1 << i);
        end
        mantissa = log_mantissa;
        leading[5:2] = log_middle;
        for (i = 1; i >= 0; i = i - 1) begin
            leading[i] = |(mantissa >> (22 - (1 << i)));
            if (!leading[i]) mantissa = mantissa << (1 << i);
        end
    end
    wire some_high = |raised[63:32];
    // Only the top of a number has to do with its logarithm.
    // verilator lint_off UNUSEDSIGNAL
    wire [47:0] half_raised = some_high ? raised[63:16] : {raised[31:0], 16'd0};
    // verilator lint_on UNUSEDSIGNAL
    wire some_low = |half_raised[47:32];
    wire signed [13:0] log = !mantissa[21] && !log_expected_2 ? -14'sd64
        : $signed({2'd0, leading, 6'd0}) + $signed({7'd0, logs[mantissa[20:15]]});

    // Blocks, and the three with the lowest hazards
    wire signed [13:0] hazard = upper_log - lower_log;
    wire enough = judged == 3'd0 || lower_log > threshold;
    wire below_0 = hazard < lowest_0, below_1 = hazard < lowest_1, below_2 = hazard < lowest_2;
    wire [1:0] pick = exposed >= 4'd7 ? 2'd2 : exposed >= 4'd4 ? 2'd1 : 2'd0;
    wire [2:0] picked = pick == 2'd2 || exposed == 4'd0 ? which_2 : pick == 2'd1 ? which_1 : which_0;
    wire [RestBits+ExposureBits-1:0] block = blocks[picked];
    wire [RestBits-1:0] ended = block[RestBits-1:0];

    // The box
    wire above_0 = !excess_2[ExcessBits-1] && |excess_2;
    wire signed [5:0] added = waits ? 6'sd26 : 6'sd0;
    wire [KeptBits-1:0] leaving = kept[oldest[BinBits-1:0]];
    wire full = !oldest[BinBits+1];
    wire fits_in = centre[BinBits+1:BinBits] == 2'd0;

    // One adder for what enters, in the first cycle of a beat, and for what leaves, in the second. It is written as a
    // difference, as those of likelihood_sums are.
    function signed [ExcessBits-1:0] changed(
        input signed [ExcessBits-1:0] sum, input signed [ExcessBits-1:0] enters, input signed [ExcessBits-1:0] leaves,
        input second
    );
        // The lowest bit is the carry that went in.
        // verilator lint_off UNUSEDSIGNAL
        reg signed [ExcessBits:0] doubled;
        // verilator lint_on UNUSEDSIGNAL
        begin
            doubled = {sum, 1'b0} - {second ? leaves : ~enters, !second};
            changed = doubled[ExcessBits:1];
        end
    endfunction

    always @(posedge clk_sys)
        if (phase && entered) kept[newest] <= {entering_excess, entering_expected, entering_middle};
    always @(posedge clk_sys) if (block_done) blocks[block_count] <= {block_exposure, block_ended};

    always @(posedge clk_sys) begin
        log_number <= value;
        log_value <= some_low ? half_raised[47:26] : half_raised[31:10];
        log_high <= {some_high, some_low};
        log_mantissa <= raised_on;
        log_middle <= middle_bits;
        {log_expected_2, log_expected_1, log_expected_0} <= {log_expected_1, log_expected_0, scan && phase};
        if (scan ? phase : block_2) upper_log <= log;
        if (scan ? !phase : block_3) lower_log <= log;

        {block_4, block_3, block_2, block_1, block_0} <= {block_3, block_2, block_1, block_0, block_done};
        held_exposure <= block_exposure;
        if (block_done) block_count <= block_count + 3'd1;
        if (block_4) begin
            judged <= judged + 3'd1;
            if (judged == 3'd0) threshold <= lower_log - 14'sd384;
            if (enough) begin
                exposed <= exposed + 4'd1;
                if (below_0) {lowest_0, which_0} <= {hazard, judged};
                if (below_0) {lowest_1, which_1} <= {lowest_0, which_0};
                else if (below_1) {lowest_1, which_1} <= {hazard, judged};
                if (below_1) {lowest_2, which_2} <= {lowest_1, which_1};
                else if (below_2) {lowest_2, which_2} <= {hazard, judged};
            end
        end
        if (load) begin
            {block_count, judged, exposed} <= 10'd0;
            {lowest_0, lowest_1, lowest_2} <= {3{14'sd8191}};
            threshold <= -14'sd8192;
        end
        ambient_ended <= |ended[RestBits-1:CountBits] ? {CountBits{1'b1}} : ended[CountBits-1:0];
        ambient_exposure <= block[RestBits+ExposureBits-1:RestBits];
        lone <= exposed == 4'd1;

        if (entered) begin
            // What enters and what leaves are extended to the box's sums.
            // verilator lint_off WIDTH
            excess_0 <= changed(excess_0, entering_excess, leaving_excess, phase);
            box_expected <= changed(box_expected, $signed({1'b0, entering_expected}),
                                    $signed({1'b0, leaving_expected}), phase);
            box_middle_0 <= changed(box_middle_0, $signed({1'b0, entering_middle}),
                                    $signed({1'b0, leaving_middle}), phase);
            // verilator lint_on WIDTH
        end
        {held_excess, held_expected, held_middle} <= {excess_0, box_expected, box_middle_0};
        if (phase) begin
            entered <= slide;
            if (slide) begin
                // Both are extended by the addition.
                // verilator lint_off WIDTH
                entering_excess <= $signed({residual, 4'd0}) - added;
                entering_expected <= predicted[CountBits+17:4] + $unsigned(added);
                // verilator lint_on WIDTH
                entering_middle <= middle;
                {leaving_excess, leaving_expected, leaving_middle} <= full ? leaving : {KeptBits{1'b0}};
                newest <= count[BinBits-1:0];
                count <= count + 1'b1;
                oldest <= oldest + 1'b1;
                centre <= centre + 1'b1;
            end
            {excess_3, excess_2, excess_1} <= {excess_2, excess_1, held_excess};
            {box_middle_3, box_middle_2, box_middle_1} <= {box_middle_2, box_middle_1, held_middle};
            {from_3, from_2, from_1, from_0} <= {from_2, from_1, from_0, full ? oldest[BinBits:0] : {BinBits + 1{1'b0}}};
            {until_3, until_2, until_1, until_0} <= {until_2, until_1, until_0, count[BinBits] ? All : count};
            {boxed_3, boxed_2, boxed_1, boxed_0} <= {boxed_2, boxed_1, boxed_0, entered && fits_in};
            score <= above_0 ? ((upper_log - 14'sd256) <<< 1) - lower_log : -14'sd4096;
            if (boxed_3 && score > best_score) begin
                best_score <= score;
                {best_from, best_until} <= {from_3, until_3};
                best_excess <= excess_3;
                best_middle <= box_middle_3;
            end
        end
        box_length <= best_until - best_from;
        box_sum <= best_from + best_until;
        if (pass && scan) begin
            {count, entered, boxed_0, boxed_1, boxed_2, boxed_3} <= 0;
            {oldest, centre} <= {-$signed({1'b0, Box}), -$signed({1'b0, Back})};
            {excess_0, box_expected, box_middle_0, box_middle_1, box_middle_2, box_middle_3} <= 0;
            {from_0, from_1, from_2, from_3, until_0, until_1, until_2, until_3} <= 0;
            best_score <= -14'sd8192;
        end
    end
endmodule
