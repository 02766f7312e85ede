`timescale 1ps / 1fs
`default_nettype none

// Where a box stands highest above ambient light, in the likelihood estimator, and how much of that there is.
//
// In a scan a box slides over the bins; a memory keeps what entered it fit_end it leaves. One unit takes
// logarithms: of excess and of what is expected, in the two cycles of a beat, and of blocks of bins in a load.
// Words are extended and cut as what they are assigned to is wide; some bits are not needed.
// verilator lint_off WIDTH
// verilator lint_off UNUSEDSIGNAL
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
    input wire [CountBits+17:0] predicted,        // R lambda [2^-12 counts]
    input wire [CountBits+BinBits:0] middle,     // twice the shots that wait in the middle of the bin
    input wire waits,                            // shots wait at it
    // The highest box
    output reg signed [13:0] best_score,         // of its squared excess over what is expected [log2 / 64]
    output reg signed [CountBits+BinBits+13:0] best_excess,  // [2^-8 counts]
    output reg [CountBits+2*BinBits:0] best_middle,  // twice the shots that wait in the middle of its bins
    output reg [BinBits:0] box_length,           // bins in it
    output reg [BinBits+1:0] box_sum,            // its first bin and the one after its last, together
    // The block that shows the ambient light
    output reg [CountBits-1:0] ambient_ended,    // its hits
    output reg [CountBits+BinBits+9:0] ambient_exposure,  // its exposure [shots units]
    output reg lone                              // it is the only one with enough exposure
);
    localparam integer Bins = 1 << BinBits, RestBits = CountBits + BinBits, ExposureBits = RestBits + 10;
    localparam integer ExcessBits = RestBits + 14, BoxExpectedBits = RestBits + 14, MiddleBits = RestBits + 1;
    localparam integer BoxMiddleBits = MiddleBits + BinBits, LogBits = BoxExpectedBits;
    localparam integer KeptBits = ExcessBits + BoxExpectedBits + MiddleBits;
    localparam [BinBits:0] All = Bins, Box = BoxBins, Half = BoxBins / 2, Back = BoxBins - BoxBins / 2;

    reg [BinBits:0] count;                           // bins that have come
    reg entered;                                     // a bin has come
    reg signed [ExcessBits-1:0] entering_excess, leaving_excess;         // of what enters and leaves the box
    reg [BoxExpectedBits-1:0] entering_expected, leaving_expected;       // [2^-8 counts]
    reg [MiddleBits-1:0] entering_middle, leaving_middle;
    reg signed [ExcessBits-1:0] excess_0, excess_1, excess_2;            // of the box, and as it goes along
    reg [BoxExpectedBits-1:0] box_expected;
    reg [BoxMiddleBits-1:0] box_middle_0, box_middle_1, box_middle_2;
    reg boxed_0, boxed_1, boxed_2;                   // the box is within the histogram
    reg [BinBits:0] place_0, place_1, place_2;       // its middle
    reg [5:0] log_bits;                              // of the number whose logarithm is taken
    reg [5:0] log_part;                              // the six bits after its leading one
    reg signed [13:0] upper_log, lower_log;          // of excess or hits, of what is expected or an exposure
    reg signed [13:0] score;                         // of the box
    reg [BinBits:0] best_place;                      // middle of the highest box
    reg [ExposureBits-1:0] held_exposure;            // of the block
    reg block_0, block_1, block_2;                   // a block is in the logarithms
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
        {count, entered, entering_excess, leaving_excess, entering_expected, leaving_expected} = 0;
        {entering_middle, leaving_middle, excess_0, excess_1, excess_2, box_expected} = 0;
        {box_middle_0, box_middle_1, box_middle_2, boxed_0, boxed_1, boxed_2, place_0, place_1, place_2} = 0;
        {log_bits, log_part, upper_log, lower_log, score, best_place, held_exposure} = 0;
        {block_0, block_1, block_2, block_count, judged, exposed, threshold} = 0;
        {lowest_0, lowest_1, lowest_2, which_0, which_1, which_2} = 0;
    end

    // The unit that takes logarithms
    reg [LogBits-1:0] value;
    reg [5:0] length;
    always @* begin
        if (!scan) value = block_done ? block_ended : held_exposure;
        else if (!phase) value = excess_0[ExcessBits-1] ? 0 : $unsigned(excess_0[ExcessBits-2:0]);
        else value = box_expected == 0 ? 1 : box_expected;
        length = 6'd0;
        for (i = 0; i < LogBits; i = i + 1) if (value[i]) length = i + 1;
    end
    wire [LogBits+6:0] aligned = {value, 7'd0} >> length;
    wire signed [13:0] log = log_bits == 6'd0 ? -14'sd64
        : $signed({2'd0, log_bits - 6'd1, 6'd0}) + $signed({7'd0, logs[log_part]});

    // Blocks, and the three with the lowest hazards
    wire signed [13:0] hazard = upper_log - lower_log;
    wire enough = judged == 3'd0 || lower_log > threshold;
    wire below_0 = hazard < lowest_0, below_1 = hazard < lowest_1, below_2 = hazard < lowest_2;
    wire [1:0] pick = exposed >= 4'd7 ? 2'd2 : exposed >= 4'd4 ? 2'd1 : 2'd0;
    wire [2:0] picked = pick == 2'd2 || exposed == 4'd0 ? which_2 : pick == 2'd1 ? which_1 : which_0;
    wire [RestBits+ExposureBits-1:0] block = blocks[picked];
    wire [RestBits-1:0] ended = block[RestBits-1:0];

    // The box
    wire signed [5:0] added = waits ? 6'sd26 : 6'sd0;
    wire [BinBits:0] oldest = count - Box;
    wire [KeptBits-1:0] leaving = kept[oldest[BinBits-1:0]];
    wire full = count >= Box;
    wire [BinBits:0] place = count > Back ? count - Back : 0;
    wire fits_in = count >= Back && place < All;
    wire [BinBits:0] newest = count - 1'b1;
    wire [BinBits+1:0] box_end = best_place + Back;
    wire [BinBits:0] box_from = best_place > Half ? best_place - Half : 0;
    wire [BinBits:0] box_until = box_end > All ? All : box_end;

    always @(posedge clk_sys)
        if (phase && entered) kept[newest[BinBits-1:0]] <= {entering_excess, entering_expected, entering_middle};
    always @(posedge clk_sys) if (block_done) blocks[block_count] <= {block_exposure, block_ended};

    always @(posedge clk_sys) begin
        log_bits <= length;
        log_part <= aligned[5:0];
        if (scan ? phase : block_0) upper_log <= log;
        if (scan ? !phase : block_1) lower_log <= log;

        {block_2, block_1, block_0} <= {block_1, block_0, block_done};
        held_exposure <= block_exposure;
        if (block_done) block_count <= block_count + 3'd1;
        if (block_2) begin
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

        if (phase) begin
            entered <= slide;
            if (slide) begin
                entering_excess <= $signed({residual, 4'd0}) - added;
                entering_expected <= predicted[CountBits+17:4] + $unsigned(added);
                entering_middle <= middle;
                {leaving_excess, leaving_expected, leaving_middle} <= full ? leaving : {KeptBits{1'b0}};
                count <= count + 1'b1;
            end
            if (entered) begin
                excess_0 <= excess_0 + entering_excess - leaving_excess;
                box_expected <= box_expected + entering_expected - leaving_expected;
                box_middle_0 <= box_middle_0 + entering_middle - leaving_middle;
            end
            {excess_2, excess_1} <= {excess_1, excess_0};
            {box_middle_2, box_middle_1} <= {box_middle_1, box_middle_0};
            {place_2, place_1, place_0} <= {place_1, place_0, place};
            {boxed_2, boxed_1, boxed_0} <= {boxed_1, boxed_0, entered && fits_in};
            score <= excess_1 > 0 ? (upper_log <<< 1) - lower_log - 14'sd512 : -14'sd4096;
            if (boxed_2 && score > best_score) begin
                best_score <= score;
                best_place <= place_2;
                best_excess <= excess_2;
                best_middle <= box_middle_2;
            end
        end
        box_length <= box_until - box_from;
        box_sum <= box_from + box_until;
        if (pass && scan) begin
            {count, entered, boxed_0, boxed_1, boxed_2} <= 0;
            {excess_0, box_expected, box_middle_0} <= 0;
            best_score <= -14'sd8192;
        end
    end
endmodule
// verilator lint_on UNUSEDSIGNAL
// verilator lint_on WIDTH
