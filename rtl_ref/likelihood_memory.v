`timescale 1ps / 1fs
`default_nettype none

// Counts, shots that wait and exposures, as the likelihood estimator goes through them.
//
// A load reads the histogram once, in order. A pass goes over bins in beats of two cycles, phase low and high:
// an edge, the bins after it, and then all other bins as one or, in a scan, what lets the box leave.
module likelihood_memory #(
    parameter [0:0] Used = 1'b1,                 // 0: nothing starts it, and it has no ROMs
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter [23:0] LikelihoodShots = 24'd30000,  // shots of a histogram
    parameter integer BoxBins = 15,              // bins of the box
    parameter integer Columns = 1,               // see frame_ctrl
    parameter [0:0] OwnChains = 1'b0,            // each column has its own bins, in 2 to the power of BinBits + 1 words
    parameter integer GlassBins = 0,             // bins with light of a cover glass, 0 if it is not known
    parameter GlassFile = "",                    // the part of that light in each bin
    parameter integer Targets = 1,               // targets that are looked for, 1 or 2
    parameter EdgesFile = "rtl_ref/edges.mem"    // of each place the width of the bin before it [units], and its time
) (
    input wire clk_sys,
    input wire rst,
    input wire load,                             // begins a load
    // Histogram
    output reg read_en,                          // the histogram's word at read_addr is being read
    output reg [BinBits-1:0] read_addr,          // word of the histogram
    // verilator lint_off UNUSEDSIGNAL
    input wire [5:0] depth_column,               // column of the histogram
    // verilator lint_on UNUSEDSIGNAL
    input wire [CountBits-1:0] count,            // word of the histogram at read_addr [hits]
    // Blocks of an eighth of the bins
    output reg block_done,                       // one is complete; one cycle
    output reg [CountBits+BinBits-1:0] block_ended,      // its hits
    output reg [CountBits+BinBits+9:0] block_exposure,   // its exposure [shots units]
    output reg [CountBits-1:0] left,                     // shots that are left
    // Passes
    input wire pass,                             // begins a pass
    input wire scan,                             // over all bins but those of the fit
    input wire [BinBits:0] fit_begin,               // begin of the fit [bins]
    input wire [BinBits:0] fit_end,                // end of the fit [bins]
    // verilator lint_off UNUSEDSIGNAL
    input wire wide,                             // a fit goes on over the later bins
    input wire [BinBits:0] later_begin,          // begin of the later bins of a fit [bins]
    input wire [BinBits:0] later_end,            // their end [bins]
    // verilator lint_on UNUSEDSIGNAL
    input wire phase,                            // second cycle of a beat
    output reg word_bin,                         // the word is a bin of the pass
    output reg word_rest,                        // it stands for all other bins
    output reg word_edge,                        // it is an edge alone
    output reg word_slide,                       // a box goes on with it
    output reg word_first,                       // of bin 0
    output reg [CountBits+BinBits-1:0] word_ended,    // shots that end in it
    output reg [CountBits+BinBits-1:0] word_waiting,  // shots that wait when it begins
    output reg [9:0] word_width,                 // its width [units]
    output reg [BinBits+7:0] word_end,           // where it ends [half units]
    output reg [16:0] word_glass,                // part of the glass's light in it [2^-17]
    output reg word_window,                      // it is the first one of the window around the echo
    output reg word_later                        // it is the first one of the later bins
);
    localparam integer Bins = 1 << BinBits, EdgeBits = BinBits + 8, RestBits = CountBits + BinBits;
    localparam integer ExposureBits = RestBits + 10, KeptBits = 2 * CountBits + ExposureBits;
    localparam [0:0] Glass = GlassBins != 0, HasSecond = Targets != 1, MoreLight = Glass || HasSecond;
    // Numbers of bins are integers elsewhere.
    // verilator lint_off WIDTH
    localparam [BinBits:0] All = Bins, Tail = BoxBins - BoxBins / 2 - 1, GlassEnd = GlassBins;
    // verilator lint_on WIDTH

    reg taken;                              // a word has been read in the last cycle
    reg [BinBits-1:0] taken_bin;            // its bin
    reg [CountBits-1:0] taken_ended;        // the word
    reg [CountBits-1:0] taken_waiting;      // shots that waited
    reg begun;                              // its exposure is begun
    reg [BinBits-1:0] begun_bin;
    reg [CountBits-1:0] begun_ended;
    reg [CountBits-1:0] begun_waiting;
    reg [CountBits+1:0] begun_three;        // three times these
    reg [5:0] begun_width;                  // the bits of the width that are left
    reg [CountBits+3:0] begun_exposure;     // the exposure of its low bits
    reg written;                            // what it comes to is written
    reg [BinBits-1:0] written_bin;          // to this word
    reg [CountBits-1:0] written_ended;
    reg [CountBits-1:0] written_waiting;
    reg [ExposureBits-1:0] written_exposure;
    reg summed;                             // a block has been added to all bins in the last cycle
    reg [RestBits-1:0] all_ended;           // hits of all bins; in the second cycle of a beat of a bin, of the rest
    reg [ExposureBits-1:0] all_exposure;    // their exposure
    reg [9:0] fetched_width;                // width of the bin that is looked up
    reg [EdgeBits-1:0] fetched_end;         // where it ends
    reg passing;                            // a pass is on the way
    reg scanning;                           // it is a scan
    reg [BinBits:0] index;                  // place of the edge that is looked up, one after its bin
    reg [BinBits-1:0] bin;                  // that bin
    reg blank;                              // it is one of the fit in a scan
    reg opening;                            // the first beat of a pass: an edge alone
    reg tailing;                            // the last bin has been
    reg [BinBits:0] tail;                   // beats after it that have been
    reg read_bin, read_rest, read_edge;     // a bin is looked up, the rest, an edge alone
    reg read_slide, read_first;             // a box goes on, that of bin 0
    reg [CountBits-1:0] read_ended;
    reg [CountBits-1:0] read_waiting;
    reg [ExposureBits-1:0] read_exposure;
    reg [16:0] read_glass;                  // part of the glass's light
    reg read_window;                        // the first bin of the window
    reg in_glass;                           // the pass is at the bins of the glass
    reg read_later;                         // the first of the later bins
    reg in_later;                           // the pass is at the later bins
    reg [RestBits-1:0] rest_ended;          // hits outside of the fit, when it has been gone through
    reg [ExposureBits-1:0] rest_exposure;   // exposure outside of it

`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg [EdgeBits+9:0] edges [0:OwnChains ? 2 * Bins * Columns - 1 : Bins];
`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg [16:0] glass_parts [0:Bins-1];
    reg [KeptBits-1:0] ram [0:Bins-1];      // shots that end, that wait, and their exposure

    integer i;
    initial begin
        if (Used) $readmemh(EdgesFile, edges);
        if (GlassBins != 0) $readmemh(GlassFile, glass_parts);
        {word_glass, word_window, read_glass, read_window, in_glass} = 37'd0;
        {word_later, read_later, in_later} = 3'd0;
        for (i = 0; i < Bins; i = i + 1) ram[i] = {KeptBits{1'b0}};
        {read_en, block_done, word_bin, word_rest, word_edge, word_slide, word_first} = 7'd0;
        {begun, begun_bin, begun_ended, begun_waiting, begun_three, begun_width, begun_exposure} = 0;
        {read_addr, taken_bin, written_bin, bin} = {4 * BinBits{1'b0}};
        {block_ended, word_ended, word_waiting, all_ended, rest_ended} = {5 * RestBits{1'b0}};
        {block_exposure, written_exposure, all_exposure} = {3 * ExposureBits{1'b0}};
        {read_exposure, rest_exposure} = {2 * ExposureBits{1'b0}};
        {taken, written, summed, passing, scanning, opening, tailing, blank} = 8'd0;
        {read_bin, read_rest, read_edge, read_slide, read_first} = 5'd0;
        {taken_ended, taken_waiting, left, written_ended, written_waiting} = {5 * CountBits{1'b0}};
        {read_ended, read_waiting} = {2 * CountBits{1'b0}};
        {word_width, fetched_width} = 20'd0;
        {word_end, fetched_end} = {2 * EdgeBits{1'b0}};
        {index, tail} = {2 * (BinBits + 1){1'b0}};
    end

    wire last_word = &read_addr;
    wire [BinBits:0] place = read_en ? {1'b0, read_addr} + 1'b1 : index;
    // It has more bits than the address needs.
    // verilator lint_off WIDTH
    wire [EdgeBits+9:0] edge_word = edges[OwnChains ? {depth_column, place} : {6'd0, place}];
    // verilator lint_on WIDTH
    wire first_of_block = written_bin[BinBits-4:0] == {BinBits - 3{1'b0}};
    wire [CountBits:0] less = {1'b0, left} - {1'b0, count};
    wire at_begin = index == fit_begin, at_end = index == fit_end;
    wire past_end = index >= (HasSecond && in_later ? later_end : fit_end);
    wire last = scanning ? index == All : MoreLight ? past_end : at_end;
    wire glass_over = Glass && in_glass && !opening && index == GlassEnd;
    wire goes_on = in_glass || !last || opening && (scanning || !MoreLight);
    wire later_next = HasSecond && wide && !scanning && !in_later;
    wire last_tail = !scanning || tail == Tail;

    // Written as differences, as those of likelihood_sums are.
    // The lowest bit is the carry that went in.
    // verilator lint_off UNUSEDSIGNAL
    wire [RestBits:0] rest_ended_next = {rest_ended, 1'b0} - {block_done ? ~block_ended
        : phase ? {RestBits{1'b0}} : {{BinBits{1'b0}}, read_ended}, block_done};
    // verilator lint_on UNUSEDSIGNAL
    // The lowest bit is the carry that went in.
    // verilator lint_off UNUSEDSIGNAL
    wire [ExposureBits:0] rest_exposure_next = {rest_exposure, 1'b0} - {block_done ? ~block_exposure
        : phase ? {ExposureBits{1'b0}} : read_exposure, block_done};
    // verilator lint_on UNUSEDSIGNAL

    wire [RestBits-1:0] rest_waiting
        = rest_exposure[ExposureBits-1:RestBits+6] != 4'd0 ? {RestBits{1'b1}} : rest_exposure[RestBits+5:6];

    // Shots times a width, in fabric, as multipliers are needed elsewhere: two bits of the width at a time, and the
    // lowest bits of the sum are done with. Two rows come before a register, three after it.
    // Both are extended to the sum.
    // verilator lint_off WIDTH
    wire [CountBits+1:0] three = taken_waiting + {taken_waiting, 1'b0};
    // verilator lint_on WIDTH
    wire [CountBits+1:0] first_row = row(fetched_width[1:0], taken_waiting, three);
    wire [CountBits+1:0] first_rows = (first_row >> 2) + row(fetched_width[3:2], taken_waiting, three);
    reg [CountBits+1:0] rest;
    reg [CountBits+9:0] exposure;
    always @* begin
        // Its highest bits are none.
        // verilator lint_off WIDTH
        rest = begun_exposure >> 2;
        // verilator lint_on WIDTH
        exposure[3:0] = begun_exposure[3:0];
        for (i = 0; i < 6; i = i + 2) begin
            rest = (rest >> 2) + row(begun_width[i +: 2], begun_waiting, begun_three);
            exposure[4 + i +: 2] = rest[1:0];
        end
        exposure[CountBits+9:10] = rest[CountBits+1:2];
    end
    function [CountBits+1:0] row(input [1:0] two, input [CountBits-1:0] once, input [CountBits+1:0] thrice);
        // Each is extended to the row.
        // verilator lint_off WIDTH
        row = !two[1] ? (two[0] ? once : {CountBits + 2{1'b0}}) : two[0] ? thrice : {once, 1'b0};
        // verilator lint_on WIDTH
    endfunction

    always @(posedge clk_sys) if (written) ram[written_bin] <= {written_exposure, written_waiting, written_ended};

    always @(posedge clk_sys) begin
        if (rst) begin
            {word_glass, word_window, read_glass, read_window, in_glass} <= 37'd0;
            {word_later, read_later, in_later} <= 3'd0;
            {read_en, block_done, word_bin, word_rest, word_edge, word_slide, word_first} <= 7'd0;
            {begun, begun_bin, begun_ended, begun_waiting, begun_three, begun_width, begun_exposure} <= 0;
            {read_addr, taken_bin, written_bin, bin} <= {4 * BinBits{1'b0}};
            {block_ended, word_ended, word_waiting, all_ended, rest_ended} <= {5 * RestBits{1'b0}};
            {block_exposure, written_exposure, all_exposure} <= {3 * ExposureBits{1'b0}};
            {read_exposure, rest_exposure} <= {2 * ExposureBits{1'b0}};
            {taken, written, summed, passing, scanning, opening, tailing, blank} <= 8'd0;
            {read_bin, read_rest, read_edge, read_slide, read_first} <= 5'd0;
            {taken_ended, taken_waiting, left, written_ended, written_waiting} <= {5 * CountBits{1'b0}};
            {read_ended, read_waiting} <= {2 * CountBits{1'b0}};
            {word_width, fetched_width} <= 20'd0;
            {word_end, fetched_end} <= {2 * EdgeBits{1'b0}};
            {index, tail} <= {2 * (BinBits + 1){1'b0}};
        end else begin
            // The histogram, word by word
            if (load) begin
                read_en <= 1'b1;
                read_addr <= {BinBits{1'b0}};
                left <= LikelihoodShots[CountBits-1:0];
            end else if (read_en) begin
                read_en <= !last_word;
                read_addr <= read_addr + 1'b1;
                left <= less[CountBits] ? {CountBits{1'b0}} : less[CountBits-1:0];
            end
            taken <= read_en;
            taken_bin <= read_addr;
            taken_ended <= count;
            taken_waiting <= left;
            begun <= taken;
            begun_bin <= taken_bin;
            begun_ended <= taken_ended;
            begun_waiting <= taken_waiting;
            begun_three <= three;
            begun_width <= fetched_width[9:4];
            begun_exposure <= {first_rows, first_row[1:0]};
            written <= begun;
            written_bin <= begun_bin;
            written_ended <= begun_ended;
            written_waiting <= begun_waiting;
            // Bins of all sizes have an exposure that is extended.
            // verilator lint_off WIDTH
            written_exposure <= exposure;
            // verilator lint_on WIDTH

            // Sums over a block
            block_done <= written && (&written_bin[BinBits-4:0]);
            if (written) begin
                block_ended <= {{BinBits{1'b0}}, written_ended} + (first_of_block ? {RestBits{1'b0}} : block_ended);
                block_exposure <= written_exposure + (first_of_block ? {ExposureBits{1'b0}} : block_exposure);
            end

            // Sums over all bins and over the rest of them, with one adder: blocks are added to all. With a bin of a
            // pass they change places twice, and it is subtracted from the rest on the way.
            summed <= block_done;
            if (block_done || read_bin) begin
                all_ended <= rest_ended_next[RestBits:1];
                all_exposure <= rest_exposure_next[ExposureBits:1];
            end
            if (summed || pass || read_bin) {rest_ended, rest_exposure} <= {all_ended, all_exposure};
            if (load) {all_ended, all_exposure, rest_ended, rest_exposure} <= {2 * (RestBits + ExposureBits){1'b0}};

            // What is looked up, and what goes on
            if (phase || read_en) {fetched_width, fetched_end} <= edge_word;
            if (phase) begin
                read_bin <= passing && !opening && !tailing && !blank;
                read_rest <= passing && tailing && !scanning;
                read_edge <= passing && opening;
                read_slide <= passing && scanning && !opening;
                read_first <= index == (opening ? {BinBits + 1{1'b0}} : {{BinBits{1'b0}}, 1'b1});
                {read_exposure, read_waiting, read_ended} <= ram[bin];
                word_bin <= read_bin && fetched_width != 10'd0;
                word_rest <= read_rest;
                word_edge <= read_edge;
                word_slide <= read_slide;
                word_first <= read_first;
                word_end <= fetched_end;
                word_ended <= read_rest ? rest_ended : {{BinBits{1'b0}}, read_ended};
                word_waiting <= read_rest ? rest_waiting : {{BinBits{1'b0}}, read_waiting};
                word_width <= read_rest ? 10'd64 : fetched_width;
                if (Glass) begin
                    read_glass <= glass_parts[bin];
                    read_window <= passing && !opening && !tailing && {1'b0, bin} == fit_begin;
                    word_glass <= read_bin ? read_glass : 17'd0;
                    word_window <= read_window;
                end
                if (HasSecond) begin
                    read_later <= passing && !opening && !tailing && !blank && {1'b0, bin} == later_begin;
                    word_later <= read_later;
                end
            end

            // The pass
            if (pass) begin
                {passing, opening, tailing, blank} <= 4'b1100;
                scanning <= scan;
                in_glass <= Glass && !scan;
                in_later <= 1'b0;
                index <= scan || Glass ? {BinBits + 1{1'b0}} : fit_begin;
                tail <= {BinBits + 1{1'b0}};
            end else if (passing && phase) begin
                opening <= glass_over || !goes_on && later_next;
                if (glass_over) begin
                    in_glass <= 1'b0;
                    if (index < fit_begin) index <= fit_begin;
                end else if (goes_on) begin
                    index <= index + 1'b1;
                    bin <= index[BinBits-1:0];
                    if (at_begin || at_end) blank <= scanning && !at_end && !MoreLight;
                end else if (later_next) begin
                    in_later <= 1'b1;
                    if (index < later_begin) index <= later_begin;
                end else if (!tailing) tailing <= 1'b1;
                else if (last_tail) passing <= 1'b0;
                else tail <= tail + 1'b1;
            end
        end
    end
endmodule
