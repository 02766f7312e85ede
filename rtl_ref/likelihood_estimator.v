`timescale 1ps / 1fs
`default_nettype none

// Maximum likelihood, with the ports of depth_estimator: a depth, its deviation, and whether to believe it.
//
// A load of the histogram, a scan for the start, six passes over the bins around the echo with a step after each,
// one to see how well they fit, and a scan of all others.
module likelihood_estimator #(
    parameter [0:0] Used = 1'b1,                 // 0: nothing starts it, and it has no ROMs
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter [23:0] LikelihoodShots = 24'd30000,  // shots of a histogram
    parameter integer BoxBins = 15,              // bins of the box
    parameter integer BinsBefore = 26,           // bins of the fit before the one of the echo
    parameter integer BinsAfter = 26,            // bins after it
    parameter [31:0] Kappa = 32'd30751,          // 16 times the square of the pulse's deviation in z
    parameter integer StepLog2 = 1,              // step of the pulse is 2 to the power of this [units]
    parameter [31:0] PulseSigma = 32'd351,       // deviation of the pulse [units]
    parameter [31:0] WindowEnd = 32'd262328,     // where the last bin ends [units / 16]
    parameter [31:0] Metres = 32'd16094985,      // distance of a 16th of a unit [2^-(29 + MetresShift) m]
    parameter integer MetresShift = 13,
    parameter [31:0] LaserDelay = 32'd0,         // distance of the light's delay after the laser edge [2^-29 m]
    parameter integer Columns = 1,               // see frame_ctrl
    parameter [0:0] OwnChains = 1'b0,            // see likelihood_memory
    parameter integer GlassBins = 0,             // see likelihood_memory
    parameter [23:0] GlassLight = 24'd0,         // light of the glass when it was calibrated [2^-14 photons a shot]
    parameter GlassFile = "",
    parameter integer Targets = 1,               // targets that are looked for, 1 or 2
    parameter [0:0] Strongest = 1'b0,            // the one with more signal comes first, and not the nearer one
    parameter EdgesFile = "rtl_ref/edges.mem",
    parameter PulseFile = "rtl_ref/pulse.mem",
    parameter HazardFile = "rtl_ref/hazard.mem",
    parameter LogFile = "rtl_ref/log2.mem",
    parameter ProgramFile = "rtl_ref/solver.mem"
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,                       // starts an estimation
    input wire mode,                             // SPADs come back by themselves
    input wire [5:0] depth_column,               // column of the histogram
    // Histogram
    output wire read_en,                         // the histogram's word at read_addr is being read
    output wire [BinBits-1:0] read_addr,         // word of the histogram
    input wire [CountBits-1:0] count,            // word of the histogram at read_addr [hits]
    // Result
    output reg signed [35:0] depth,              // when algo_done is high, and until the next one [2^-29 m]
    output reg [35:0] sigma,                     // its standard deviation [2^-29 m]
    output reg [6:0] status,                     // why not to believe it
    output reg [BinBits+24:0] chi_square,        // of the fit [2^-8]
    output reg valid,                            // the status says nothing against the depth
    output reg [3:0] code,                       // what a host can rely on
    output reg algo_done,                        // the depth is ready; one cycle
    // Second target, all 0 without one
    output reg signed [35:0] second_depth,       // its depth [2^-29 m]
    output reg [35:0] second_sigma,              // its standard deviation [2^-29 m]
    output reg [23:0] second_strength,           // its signal, photons a shot [2^-14]
    output reg [6:0] second_status,              // why not to believe it
    output reg second_valid                      // there is one, and its status says nothing against it
);
    localparam [3:0] Idle = 4'd0, Load = 4'd1, Ambient = 4'd2, Scan = 4'd3, Start = 4'd4, Fit = 4'd5, Step = 4'd6,
        Check = 4'd7, Rescan = 4'd8, End = 4'd9, Second = 4'd10, Swap = 4'd11;
    localparam [0:0] Glass = GlassBins != 0, HasSecond = Targets != 1;
    localparam [6:0] AmbientProgram = 7'd0, StartProgram = Glass ? 7'd8 : 7'd7, StepProgram = Glass ? 7'd14 : 7'd13,
        EndProgram = Glass ? 7'd69 : 7'd49, SecondProgram = Glass ? 7'd84 : 7'd64, SwapProgram = SecondProgram + 7'd6;
    localparam [3:0] Turns = 4'd10;
    localparam [3:0] Valid = 4'd1, ValidSecond = 4'd2, NoTarget = 4'd3, AmbientTooHigh = 4'd4, CutOff = 4'd5,
        Saturated = 4'd6, PedestalChanged = 4'd7, AnotherEcho = 4'd8, NotSettled = 4'd9, NoFit = 4'd10, NotArmed = 4'd11;
    localparam integer Bins = 1 << BinBits, Beats = 29;
    localparam integer ScanCycles = 2 * (Bins + BoxBins - BoxBins / 2 - 1 + Beats);
    localparam integer GlassBeats = Glass ? GlassBins + 1 : 0;
    localparam integer FitCycles = 2 * (GlassBeats + BinsBefore + 1 + BinsAfter + Beats), LoadCycles = Bins + 12;
    localparam integer PairCycles = FitCycles + 2 * (BinsBefore + 1 + BinsAfter + 1);
    localparam integer WaitBits = BinBits + (HasSecond ? 4 : 3), ChiBits = BinBits + 25, ApartBits = 38;
    // Numbers of bins are integers elsewhere.
    // verilator lint_off WIDTH
    localparam [BinBits:0] All = Bins, Before = BinsBefore, After = BinsAfter + 1;
    localparam [CountBits-1:0] LeastLeft = LikelihoodShots >> 6;
    // verilator lint_on WIDTH

    reg [3:0] state;                  // what it does
    reg [WaitBits-1:0] waited;   // cycles in this state
    reg [2:0] steps;                  // steps taken
    reg load, pass, sums;             // begins a load, a pass, the sums of a pass
    reg scan, check;                  // a scan, a check is on the way
    reg phase;                        // second cycle of a beat; there are none but in a pass
    reg run;                          // begins a program
    reg [6:0] entry;                  // where it begins
    reg [BinBits:0] fit_begin, fit_end;      // begin and end of the fit, and of what a scan blanks [bins]
    reg signed [13:0] start_score;    // score of the first scan
    reg seen;                         // a bin of the check has come
    reg used_up;                      // few shots waited at the first
    reg dark;                         // a fit or a scan is without an echo, where there is a glass
    reg reached;                      // the check has come to the window around the echo
    reg free;                         // mode was high since the last estimation began
    reg unarmed;                      // the same of the shots of this estimation
    // Where a second target is looked for
    reg wide;                         // a pass goes over the bins around both echoes
    reg paired;                       // both echoes have light
    reg [3:0] turns;                  // steps taken of both
    reg behind;                       // the other echo's bins are the earlier ones
    reg [BinBits:0] later_begin, later_end;  // begin and end of the later bins of a fit [bins]
    reg later_reached, later_seen;    // the check has come to them, one of them has come
    reg later_used_up;                // few shots waited at the first
    reg signed [13:0] alone_score;    // of one echo: score of the box over it,
    reg signed [35:0] alone_depth;    // depth, deviation and flags,
    reg [35:0] alone_sigma;
    reg [6:0] alone_flags;
    reg alone_cut, alone_changed;     // its last step was shortened, the glass's light has changed,
    reg [ChiBits-1:0] alone_chi;      // chi-square over the bins of both,
    reg alone_far, alone_used_up;     // a bin is far from it, few shots waited at its first bin
    reg signed [35:0] other_depth;    // of the other of two echoes: depth, deviation, flags
    reg [35:0] other_sigma;
    // Whether the signal is known to a quarter counts for one echo.
    // verilator lint_off UNUSEDSIGNAL
    reg [6:0] other_flags;
    // verilator lint_on UNUSEDSIGNAL
    reg other_cut;                    // its last step was shortened

    initial begin
        {depth, sigma, status, chi_square, valid, code, algo_done} = 0;
        {state, waited, steps, load, pass, sums, scan, check, phase, run, entry, fit_begin, fit_end} = 0;
        {start_score, seen, used_up, dark, reached, free, unarmed} = 0;
        {second_depth, second_sigma, second_strength, second_status, second_valid} = 0;
        {wide, paired, turns, behind, later_begin, later_end, later_reached, later_seen, later_used_up} = 0;
        {alone_score, alone_depth, alone_sigma, alone_flags, alone_cut, alone_changed, alone_chi} = 0;
        {alone_far, alone_used_up, other_depth, other_sigma, other_flags, other_cut} = 0;
    end

    wire block_done, word_bin, word_rest, word_edge, word_slide, word_first;
    wire [CountBits+BinBits-1:0] block_ended, word_ended, word_waiting;
    wire [CountBits+BinBits+9:0] block_exposure, ambient_exposure;
    wire [CountBits-1:0] left;
    wire [9:0] word_width;
    wire [BinBits+7:0] word_end;
    wire signed [CountBits+8:0] residual;
    wire [CountBits+17:0] predicted;
    wire [12:0] gain, share;
    wire signed [8:0] slope;
    wire [CountBits:0] middle;
    wire waits, single, slide;
    wire signed [CountBits+23:0] sum_11, sum_12, sum_13, score_1;
    wire signed [CountBits+18:0] sum_22, sum_23, sum_33, score_2, score_3;
    wire [BinBits+24:0] sum_chi;
    wire far, lone, ran;
    wire signed [13:0] best_score;
    wire signed [CountBits+BinBits+13:0] best_excess;
    wire [CountBits+BinBits:0] best_middle;
    wire [BinBits:0] box_length;
    wire [BinBits+1:0] box_sum;
    wire [CountBits-1:0] ambient_ended;
    wire [BinBits+10:0] arrival;
    wire [23:0] strength, ambient, glass;
    wire [16:0] word_glass;
    wire [4:0] hazard_bits;
    wire [9:0] hazard_reciprocal;
    wire [(CountBits > 16 ? CountBits + 8 : 24)-1:0] weight_first;
    wire word_window, word_later;
    wire [BinBits+10:0] other_arrival;
    wire [23:0] other_strength;
    wire [25:0] other_light, ambient_light;
    wire [12:0] still_share;
    wire signed [CountBits+23:0] still_13;
    wire signed [CountBits+18:0] still_23, still_33, still_score;
    wire [25:0] glass_light;
    wire signed [CountBits+23:0] sum_14;
    wire signed [CountBits+18:0] sum_24, sum_34, sum_44, score_4;
    wire signed [35:0] solved_depth;
    wire [35:0] solved_sigma;
    wire [6:0] flags;
    wire [5:0] cut;

    // Bins around the arrival
    wire [BinBits:0] bin = arrival[BinBits+10:10];
    wire [BinBits:0] centre = bin < All ? bin : All - 1'b1;
    wire [BinBits:0] next_begin = centre > Before ? centre - Before : {BinBits + 1{1'b0}};
    wire [BinBits+1:0] window_end = {1'b0, centre} + {1'b0, After};
    wire [BinBits:0] next_end = window_end > {1'b0, All} ? All : window_end[BinBits:0];

    // Bins around the other echo, and which come first
    wire [BinBits:0] other_bin = other_arrival[BinBits+10:10];
    wire [BinBits:0] other_centre = other_bin < All ? other_bin : All - 1'b1;
    wire [BinBits:0] other_begin = other_centre > Before ? other_centre - Before : {BinBits + 1{1'b0}};
    wire [BinBits+1:0] other_window_end = {1'b0, other_centre} + {1'b0, After};
    wire [BinBits:0] other_end = other_window_end > {1'b0, All} ? All : other_window_end[BinBits:0];
    wire behind_next = HasSecond && wide_next && other_begin < next_begin;

    wire unsure = flags[1] && start_score < 14'sd425;
    wire faint = flags[0] && start_score < 14'sd850;
    // Half of what was calibrated is too little of a pedestal, and twice as much too much.
    // Of no glass the limits are 0.
    // verilator lint_off UNSIGNED
    wire changed = Glass && (glass < {1'b0, GlassLight[23:1]} || {1'b0, glass} > {GlassLight, 1'b0});
    // verilator lint_on UNSIGNED
    wire no_fit = far || changed;
    wire no_echo = unsure || faint || flags[2] || start_score < 14'sd297;

    // A fit without an echo is the first, and those that follow it
    wire unlit = Glass && (state == Ambient || state == Step && dark);

    // Two targets or one
    wire signed [ChiBits:0] drop = {1'b0, alone_chi} - {1'b0, sum_chi};
    wire [BinBits+10:0] apart = arrival > other_arrival ? arrival - other_arrival : other_arrival - arrival;
    // Distances are extended to the longest.
    // verilator lint_off WIDTH
    wire [ApartBits-1:0] apart_by = apart, least_apart = 44 * {6'd0, PulseSigma}, near = {6'd0, PulseSigma} << 6;
    // verilator lint_on WIDTH
    wire fewer = drop > 9216;
    wire are_two = fewer && apart_by > least_apart && flags[2:1] == 2'd0 && other_flags[2:1] == 2'd0;
    wire split = fewer || drop > 3584 && apart_by < near;
    wire own_first = Strongest ? strength >= other_strength : solved_depth <= other_depth;
    wire own_used_up = behind ? later_used_up : used_up, other_used_up = behind ? used_up : later_used_up;
    wire [6:0] of_both = {unarmed, no_fit, 1'b0, best_score > 14'sd331, 3'd0};
    wire [6:0] own_status = of_both | {2'd0, cut != 6'd0 || flags[5] || flags[6], 1'b0, own_used_up,
                                       flags[3] || flags[4], 1'b0};
    wire [6:0] other_status = of_both | {2'd0, other_cut || other_flags[5] || other_flags[6], 1'b0, other_used_up,
                                         other_flags[3] || other_flags[4], 1'b0};
    wire alone_unsure = alone_flags[1] && start_score < 14'sd425;
    wire alone_faint = alone_flags[0] && start_score < 14'sd850;
    wire [6:0] alone_status = {unarmed, alone_far || alone_changed, alone_cut || alone_flags[5] || alone_flags[6],
                               split || alone_score > 14'sd331, alone_used_up, alone_flags[3] || alone_flags[4],
                               alone_unsure || alone_faint || alone_flags[2] || start_score < 14'sd297};
    wire [6:0] first_status = !are_two ? alone_status : own_first ? own_status : other_status;
    wire [6:0] later_status = own_first ? other_status : own_status;
    // The results of all are there, and not those of one echo or of the other
    wire last_end = !HasSecond || paired && turns == Turns;

    // What a host can rely on: the first that applies.
    wire [6:0] status_next = HasSecond ? first_status
        : {unarmed, no_fit, cut != 6'd0 || flags[5] || flags[6], best_score > 14'sd331, used_up,
           flags[3] || flags[4], no_echo};
    wire blind = left < LeastLeft, code_changed = HasSecond && !are_two ? alone_changed : changed;
    wire [3:0] code_next = status_next[6] ? NotArmed
        : code_changed ? PedestalChanged
        : status_next[0] && blind ? AmbientTooHigh
        : status_next[0] ? NoTarget
        : status_next[2] ? Saturated
        : status_next[1] ? CutOff
        : status_next[3] ? AnotherEcho
        : status_next[4] ? NotSettled
        : status_next[5] ? NoFit
        : HasSecond && are_two ? ValidSecond : Valid;

    // begin_pass: 1 a fit, 2 a scan; begin_program: its entry
    reg [3:0] state_next;
    reg begin_fit, begin_scan, begin_program;
    wire ends_alone = HasSecond && state == Check && begin_program;  // a check of one echo
    wire wide_next = HasSecond && (wide || state == Second);
    wire [WaitBits-1:0] fit_for = HasSecond && wide ? PairCycles[WaitBits-1:0] : FitCycles[WaitBits-1:0];
    always @* begin
        state_next = state;
        {begin_fit, begin_scan, begin_program} = 3'b000;
        case (state)
            Idle: if (algo_start) state_next = Load;
            Load: if (waited == LoadCycles[WaitBits-1:0]) {state_next, begin_program} = {Ambient, 1'b1};
            Ambient: if (ran && Glass) {state_next, begin_fit} = {Fit, 1'b1};
                else if (ran) {state_next, begin_scan} = {Scan, 1'b1};
            Scan: if (waited == ScanCycles[WaitBits-1:0]) {state_next, begin_program} = {Start, 1'b1};
            Start: if (ran) {state_next, begin_fit} = {Fit, 1'b1};
            Fit: if (waited == fit_for) {state_next, begin_program} = {Step, 1'b1};
            Step: if (ran && HasSecond && paired && turns == Turns - 4'd1) {state_next, begin_fit} = {Check, 1'b1};
                else if (ran && HasSecond && paired) {state_next, begin_program} = {turns == Turns - 4'd2 ? End : Swap, 1'b1};
                else if (ran && Glass && dark && steps == 3'd1) {state_next, begin_scan} = {Scan, 1'b1};
                else if (ran && HasSecond && steps == 3'd5) {state_next, begin_program} = {End, 1'b1};
                else if (ran) {state_next, begin_fit} = {steps == 3'd5 ? Check : Fit, 1'b1};
            Check: if (waited == fit_for && HasSecond && !paired) {state_next, begin_program} = {Swap, 1'b1};
                else if (waited == fit_for) {state_next, begin_scan} = {Rescan, 1'b1};
            Rescan: if (waited == ScanCycles[WaitBits-1:0])
                {state_next, begin_program} = {HasSecond && !paired ? Second : End, 1'b1};
            End: if (ran && last_end) state_next = Idle;
                else if (ran && paired) {state_next, begin_program} = {Swap, 1'b1};
                else if (ran) {state_next, begin_scan} = {Rescan, 1'b1};
            Second: if (ran) {state_next, begin_fit} = {Check, 1'b1};
            Swap: if (ran) {state_next, begin_fit} = {Fit, 1'b1};
            default: ;
        endcase
    end

    always @(posedge clk_sys) begin
        if (rst) begin
            {depth, sigma, status, chi_square, valid, code, algo_done} <= 0;
            {state, waited, steps, load, pass, sums, scan, check, phase, run, entry, fit_begin, fit_end} <= 0;
            {start_score, seen, used_up, dark, reached, free, unarmed} <= 0;
            {second_depth, second_sigma, second_strength, second_status, second_valid} <= 0;
            {wide, paired, turns, behind, later_begin, later_end, later_reached, later_seen, later_used_up} <= 0;
            {alone_score, alone_depth, alone_sigma, alone_flags, alone_cut, alone_changed, alone_chi} <= 0;
            {alone_far, alone_used_up, other_depth, other_sigma, other_flags, other_cut} <= 0;
        end else begin
            state <= state_next;
            waited <= state_next == Idle || state_next != state || begin_fit ? {WaitBits{1'b0}} : waited + 1'b1;
            phase <= (state == Scan || state == Fit || state == Check || state == Rescan) && !pass && !phase;
            load <= state == Idle && algo_start;
            pass <= begin_fit || begin_scan;
            sums <= begin_fit;
            run <= begin_program;
            algo_done <= state == End && ran && last_end;
            free <= mode || free && !(state == Idle && algo_start);
            if (state == Idle && algo_start) begin
                {fit_begin, fit_end, steps} <= {2 * BinBits + 5{1'b0}};
                {wide, paired, turns} <= 6'd0;
                unarmed <= free || mode;
            end
            if (begin_fit) begin
                fit_begin <= behind_next ? other_begin : unlit ? {BinBits + 1{1'b0}} : next_begin;
                fit_end <= behind_next ? other_end : unlit ? {BinBits + 1{1'b0}} : next_end;
                if (HasSecond) begin
                    behind <= behind_next;
                    wide <= wide_next;
                    {later_begin, later_end} <= behind_next ? {next_begin, next_end} : {other_begin, other_end};
                    {later_reached, later_seen} <= 2'b00;
                end
                dark <= unlit;
                check <= state_next == Check;
                {seen, reached} <= 2'b00;
            end
            if (HasSecond && state == Ambient && ran && !Glass) dark <= 1'b1;
            if (begin_scan) {scan, check} <= 2'b10;
            if (begin_program) begin
                scan <= 1'b0;
                entry <= state == Load ? AmbientProgram : state == Scan ? StartProgram
                    : state == Fit ? StepProgram : HasSecond && state_next == Second ? SecondProgram
                    : HasSecond && state_next == Swap ? SwapProgram : EndProgram;
            end
            if (state == Scan && begin_program) start_score <= best_score;
            if (state == Step && ran && !(HasSecond && paired)) steps <= begin_scan ? 3'd0 : steps + 3'd1;
            if (HasSecond && state == Step && ran && paired) turns <= turns + 4'd1;
            if (Glass && state == Check && !begin_scan && !ends_alone && word_window) reached <= 1'b1;
            if (state == Check && !begin_scan && !ends_alone && word_bin && !seen && (!Glass || reached || word_window)) begin
                seen <= 1'b1;
                used_up <= word_waiting < 32;
            end
            if (HasSecond && state == Check && !begin_scan && !ends_alone) begin
                if (word_later) later_reached <= 1'b1;
                if (word_bin && !later_seen && (later_reached || word_later)) begin
                    later_seen <= 1'b1;
                    later_used_up <= word_waiting < 32;
                end
            end
            if (ends_alone) begin
                {alone_chi, alone_far, alone_used_up} <= {sum_chi, far, own_used_up};
                paired <= 1'b1;
            end
            if (HasSecond && state == Rescan && begin_program && !paired) alone_score <= best_score;
            if (HasSecond && state == End && ran && !paired) begin
                {alone_depth, alone_sigma, alone_flags} <= {solved_depth, solved_sigma, flags};
                {alone_cut, alone_changed} <= {cut != 6'd0, changed};
            end
            if (HasSecond && state == End && ran && paired && !last_end)
                {other_depth, other_sigma, other_flags, other_cut} <= {solved_depth, solved_sigma, flags, cut != 6'd0};
            if (state == End && ran && last_end) begin
                status <= status_next;
                valid <= status_next == 7'd0;
                code <= code_next;
                scan <= 1'b0;
            end
            if (HasSecond && state == End && ran && last_end) begin
                depth <= (!are_two ? alone_depth : own_first ? solved_depth : other_depth)
                    - $signed({4'd0, LaserDelay});
                sigma <= !are_two ? alone_sigma : own_first ? solved_sigma : other_sigma;
                chi_square <= are_two ? sum_chi : alone_chi;
                second_depth <= !are_two ? 36'sd0
                    : (own_first ? other_depth : solved_depth) - $signed({4'd0, LaserDelay});
                second_sigma <= !are_two ? 36'd0 : own_first ? other_sigma : solved_sigma;
                second_strength <= !are_two ? 24'd0 : own_first ? other_strength : strength;
                second_status <= are_two ? later_status : 7'd0;
                second_valid <= are_two && later_status == 7'd0;
            end
            if (!HasSecond && state == End && ran) begin
                // An arrival counts from the laser edge, a depth from where the light leaves.
                depth <= solved_depth - $signed({4'd0, LaserDelay});
                sigma <= solved_sigma;
                chi_square <= sum_chi;
            end
        end
    end

    likelihood_memory #(
        .Used(Used),
        .BinBits(BinBits),
        .CountBits(CountBits),
        .LikelihoodShots(LikelihoodShots),
        .BoxBins(BoxBins),
        .Columns(Columns),
        .OwnChains(OwnChains),
        .GlassBins(GlassBins),
        .GlassFile(GlassFile),
        .Targets(Targets),
        .EdgesFile(EdgesFile)
    ) likelihood_memory (
        .clk_sys(clk_sys),
        .rst(rst),
        .load(load),
        .read_en(read_en),
        .read_addr(read_addr),
        .depth_column(depth_column),
        .count(count),
        .block_done(block_done),
        .block_ended(block_ended),
        .block_exposure(block_exposure),
        .left(left),
        .pass(pass),
        .scan(scan),
        .fit_begin(fit_begin),
        .fit_end(fit_end),
        .wide(wide),
        .later_begin(later_begin),
        .later_end(later_end),
        .phase(phase),
        .word_bin(word_bin),
        .word_rest(word_rest),
        .word_edge(word_edge),
        .word_slide(word_slide),
        .word_first(word_first),
        .word_ended(word_ended),
        .word_waiting(word_waiting),
        .word_width(word_width),
        .word_end(word_end),
        .word_glass(word_glass),
        .word_window(word_window),
        .word_later(word_later)
    );

    likelihood_terms #(
        .Used(Used),
        .BinBits(BinBits),
        .CountBits(CountBits),
        .GlassBins(GlassBins),
        .Targets(Targets),
        .StepLog2(StepLog2),
        .PulseFile(PulseFile),
        .HazardFile(HazardFile)
    ) likelihood_terms (
        .clk_sys(clk_sys),
        .phase(phase),
        .scan(scan),
        .dark(dark),
        .glass_light(glass_light),
        .other_light(other_light),
        .arrival(arrival),
        .strength(strength),
        .ambient(ambient),
        .word_bin(word_bin),
        .word_rest(word_rest),
        .word_edge(word_edge),
        .word_slide(word_slide),
        .word_first(word_first),
        .word_ended(word_ended),
        .word_waiting(word_waiting),
        .word_width(word_width),
        .word_end(word_end),
        .residual(residual),
        .predicted(predicted),
        .gain(gain),
        .share(share),
        .slope(slope),
        .middle(middle),
        .waits(waits),
        .single(single),
        .slide(slide),
        .hazard_bits(hazard_bits),
        .hazard_reciprocal(hazard_reciprocal),
        .ambient_light(ambient_light)
    );

    likelihood_sums #(
        .BinBits(BinBits),
        .CountBits(CountBits),
        .Targets(Targets)
    ) likelihood_sums (
        .clk_sys(clk_sys),
        .pass(sums),
        .check(check),
        .phase(phase),
        .residual(residual),
        .predicted(predicted),
        .gain(gain),
        .share(share),
        .slope(slope),
        .single(single),
        .sum_11(sum_11),
        .sum_12(sum_12),
        .sum_13(sum_13),
        .sum_22(sum_22),
        .sum_23(sum_23),
        .sum_33(sum_33),
        .score_1(score_1),
        .score_2(score_2),
        .score_3(score_3),
        .chi_square(sum_chi),
        .far(far),
        .weight_first(weight_first)
    );

    wire signed [CountBits+8:0] glass_residual = Glass ? residual : {CountBits + 9{1'b0}};
    // Without a glass it stays in place, with constant inputs: a generate block would put its own scope into its path.
    likelihood_glass #(
        .CountBits(CountBits),
        .Targets(Targets)
    ) likelihood_glass (
        .clk_sys(clk_sys),
        .pass(Glass && sums),
        .phase(Glass && phase),
        .glass(Glass ? glass : 24'd0),
        .word_glass(word_glass),
        .hazard_bits(hazard_bits),
        .hazard_reciprocal(hazard_reciprocal),
        .residual(glass_residual),
        .weight_first(weight_first),
        .share(share),
        .slope(slope),
        .paired(paired),
        .still_share(still_share),
        .glass_light(glass_light),
        .sum_14(sum_14),
        .sum_24(sum_24),
        .sum_34(sum_34),
        .sum_44(sum_44),
        .score_4(score_4)
    );

    likelihood_pair #(
        .Used(Used),
        .BinBits(BinBits),
        .CountBits(CountBits),
        .GlassBins(GlassBins),
        .Targets(Targets),
        .StepLog2(StepLog2),
        .PulseFile(PulseFile)
    ) likelihood_pair (
        .clk_sys(clk_sys),
        .pass(sums),
        .phase(phase),
        .paired(paired),
        .other_arrival(other_arrival),
        .other_strength(other_strength),
        .word_bin(word_bin),
        .word_edge(word_edge),
        .word_first(word_first),
        .word_end(word_end),
        .glass_light(glass_light),
        .ambient_light(ambient_light),
        .hazard_bits(hazard_bits),
        .hazard_reciprocal(hazard_reciprocal),
        .residual(residual),
        .weight_first(weight_first),
        .share(share),
        .slope(slope),
        .other_light(other_light),
        .still_share(still_share),
        .still_13(still_13),
        .still_23(still_23),
        .still_33(still_33),
        .still_score(still_score)
    );

    likelihood_scan #(
        .Used(Used),
        .BinBits(BinBits),
        .CountBits(CountBits),
        .BoxBins(BoxBins),
        .LogFile(LogFile)
    ) likelihood_scan (
        .clk_sys(clk_sys),
        .load(load),
        .block_done(block_done),
        .block_ended(block_ended),
        .block_exposure(block_exposure),
        .pass(pass),
        .scan(scan),
        .phase(phase),
        .slide(slide),
        .residual(residual),
        .predicted(predicted),
        .middle(middle),
        .waits(waits),
        .best_score(best_score),
        .best_excess(best_excess),
        .best_middle(best_middle),
        .box_length(box_length),
        .box_sum(box_sum),
        .ambient_ended(ambient_ended),
        .ambient_exposure(ambient_exposure),
        .lone(lone)
    );

    likelihood_solver #(
        .Used(Used),
        .BinBits(BinBits),
        .CountBits(CountBits),
        .Kappa(Kappa),
        .StepLog2(StepLog2),
        .PulseSigma(PulseSigma),
        .WindowEnd(WindowEnd),
        .Metres(Metres),
        .MetresShift(MetresShift),
        .GlassBins(GlassBins),
        .GlassLight(GlassLight),
        .Targets(Targets),
        .ProgramFile(ProgramFile)
    ) likelihood_solver (
        .clk_sys(clk_sys),
        .rst(rst),
        .run(run),
        .entry(entry),
        .ambient_ended(ambient_ended),
        .ambient_exposure(ambient_exposure),
        .lone(lone),
        .best_excess(best_excess),
        .best_middle(best_middle),
        .box_length(box_length),
        .box_sum(box_sum),
        .sum_11(sum_11),
        .sum_12(sum_12),
        .sum_13(sum_13),
        .sum_22(sum_22),
        .sum_23(sum_23),
        .sum_33(sum_33),
        .score_1(score_1),
        .score_2(score_2),
        .score_3(score_3),
        .sum_14(sum_14),
        .sum_24(sum_24),
        .sum_34(sum_34),
        .sum_44(sum_44),
        .score_4(score_4),
        .paired(paired),
        .still_13(still_13),
        .still_23(still_23),
        .still_33(still_33),
        .still_score(still_score),
        .ran(ran),
        .arrival(arrival),
        .strength(strength),
        .ambient(ambient),
        .glass(glass),
        .other_arrival(other_arrival),
        .other_strength(other_strength),
        .depth(solved_depth),
        .sigma(solved_sigma),
        .flags(flags),
        .cut(cut)
    );
endmodule
