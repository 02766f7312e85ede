    // The blocks that go through the bins are left open, so it holds whatever is in the histogram. Of the solver remains
    // how it goes through its programs.
    localparam [3:0] Idle = 4'd0, Load = 4'd1, Ambient = 4'd2, Scan = 4'd3, Start = 4'd4, Fit = 4'd5, Step = 4'd6,
        Check = 4'd7, Rescan = 4'd8, End = 4'd9, Second = 4'd10, Swap = 4'd11;
    // Cycles of each state
    localparam [15:0] LoadFor = `LIKELIHOOD_BINS + 13;
    localparam [15:0] ScanFor = 2 * (`LIKELIHOOD_BINS + `LIKELIHOOD_BOX - `LIKELIHOOD_BOX / 2 - 1 + 29) + 1;
    localparam Glass = `LIKELIHOOD_GLASS != 0;
    localparam [15:0] GlassBeats = Glass ? `LIKELIHOOD_GLASS + 1 : 0;
    localparam [15:0] FitFor = 2 * (GlassBeats + `LIKELIHOOD_BEFORE + 1 + `LIKELIHOOD_AFTER + 29) + 1;
    localparam HasSecond = `LIKELIHOOD_TARGETS != 1;
    localparam [15:0] PairFor = FitFor + 2 * (`LIKELIHOOD_BEFORE + 1 + `LIKELIHOOD_AFTER + 1);
    // First and last instruction of each program, and its cycles
    localparam [29:0] AmbientProgram = `LIKELIHOOD_AMBIENT, StartProgram = `LIKELIHOOD_START,
        StepProgram = `LIKELIHOOD_STEP, EndProgram = `LIKELIHOOD_END, SecondProgram = `LIKELIHOOD_SECOND,
        SwapProgram = `LIKELIHOOD_SWAP;
    localparam [15:0] AmbientFor = AmbientProgram[15:0], StartFor = StartProgram[15:0], StepFor = StepProgram[15:0],
        EndFor = EndProgram[15:0], SecondFor = SecondProgram[15:0], SwapFor = SwapProgram[15:0];
    // Cycles of an estimation before each state first begins; fits without an echo are first, where there is a glass
    localparam [15:0] AmbientFrom = LoadFor, DarkFrom = AmbientFrom + AmbientFor;
    localparam [15:0] ScanFrom = DarkFrom + (Glass ? 2 * (FitFor + StepFor) : 16'd0), StartFrom = ScanFrom + ScanFor;
    localparam [15:0] FitFrom = StartFrom + StartFor, FittedFrom = FitFrom + 6 * (FitFor + StepFor);
    // With a second target: the results of one, a scan for the other, a check of one, ten turns, and after the ninth the
    // results of the other
    localparam [15:0] AloneScanFrom = FittedFrom + EndFor, SecondFrom = AloneScanFrom + ScanFor;
    localparam [15:0] AloneCheckFrom = SecondFrom + SecondFor, TurnFrom = AloneCheckFrom + PairFor;
    localparam [15:0] TurnFor = SwapFor + PairFor + StepFor, OtherEndFrom = TurnFrom + 9 * TurnFor;
    localparam [15:0] CheckFrom = HasSecond ? OtherEndFrom + EndFor + TurnFor : FittedFrom;
    localparam [15:0] RescanFrom = CheckFrom + (HasSecond ? PairFor : FitFor), EndFrom = RescanFrom + ScanFor;

    (* hierconn *) wire [3:0] \dut.state ;
    (* hierconn *) wire [$clog2(`LIKELIHOOD_BINS)+(HasSecond ? 3 : 2):0] \dut.waited ;
    (* hierconn *) wire [2:0] \dut.steps ;
    (* hierconn *) wire \dut.dark ;
`ifdef LIKELIHOOD_HAS_SECOND
    (* hierconn *) wire \dut.wide ;
    (* hierconn *) wire \dut.paired ;
    (* hierconn *) wire [3:0] \dut.turns ;
`endif
    (* hierconn *) wire \dut.run ;
    (* hierconn *) wire [6:0] \dut.entry ;
    (* hierconn *) wire \dut.likelihood_solver.running ;
    (* hierconn *) wire \dut.likelihood_solver.ran ;
    (* hierconn *) wire [6:0] \dut.likelihood_solver.counter ;
    (* hierconn *) wire [5:0] \dut.likelihood_solver.pause ;

    likelihood_estimator `LIKELIHOOD dut (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .mode(mode),
        .count(count),
        .algo_done(algo_done)
    );

    wire likelihood_latency = algo_done == done;

    wire [3:0] state = \dut.state ;
    wire [15:0] waited = \dut.waited ;
    wire [15:0] steps = \dut.steps ;
    wire dark = Glass && \dut.dark ;
`ifdef LIKELIHOOD_HAS_SECOND
    wire wide = \dut.wide ;
    wire paired = \dut.paired ;
    wire [15:0] turns = \dut.turns ;
`else
    wire wide = 1'b0, paired = 1'b0;
    wire [15:0] turns = 16'd0;
`endif
    wire [15:0] turn_from = TurnFrom + turns * TurnFor + (turns == 9 ? EndFor : 16'd0);
    wire [6:0] counter = \dut.likelihood_solver.counter ;
    wire [15:0] pause = \dut.likelihood_solver.pause ;
    wire solver_works = \dut.run || \dut.likelihood_solver.running || \dut.likelihood_solver.ran ;

    // The program of a state, its last instruction, and its cycles
    reg solves;
    reg [6:0] program, stop;
    reg [15:0] program_for;
    always @*
        case (state)
            Ambient: {solves, program, stop, program_for} = {1'b1, AmbientProgram};
            Start: {solves, program, stop, program_for} = {1'b1, StartProgram};
            Step: {solves, program, stop, program_for} = {1'b1, StepProgram};
            End: {solves, program, stop, program_for} = {1'b1, EndProgram};
            Second: {solves, program, stop, program_for} = {1'b1, SecondProgram};
            Swap: {solves, program, stop, program_for} = {1'b1, SwapProgram};
            default: {solves, program, stop, program_for} = 31'd0;
        endcase

    // Of an instruction: the cycle of the program in which it begins, and how long it waits for that at most
    reg [15:0] begins, longest;
    always @*
        case (counter)
            `LIKELIHOOD_PROGRAM
            default: {begins, longest} = 32'd0;
        endcase

    wire in_program = \dut.run ? \dut.entry == program && !\dut.likelihood_solver.running && !\dut.likelihood_solver.ran
        : \dut.likelihood_solver.running ? counter >= program && counter <= stop && pause <= longest
            && !\dut.likelihood_solver.ran
        : \dut.likelihood_solver.ran ;
    wire [15:0] in_state = !solves ? waited
        : \dut.run ? 16'd0 : \dut.likelihood_solver.running ? 16'd1 + begins - pause : program_for - 16'd1;

    reg [15:0] from, within;
    always @*
        case (state)
            Load: {from, within} = {16'd0, LoadFor};
            Ambient: {from, within} = {AmbientFrom, AmbientFor};
            Scan: {from, within} = {ScanFrom, ScanFor};
            Start: {from, within} = {StartFrom, StartFor};
            Fit: {from, within} = paired ? {turn_from + SwapFor, PairFor}
                : {(dark ? DarkFrom : FitFrom) + steps * (FitFor + StepFor), FitFor};
            Step: {from, within} = paired ? {turn_from + SwapFor + PairFor, StepFor}
                : {(dark ? DarkFrom : FitFrom) + steps * (FitFor + StepFor) + FitFor, StepFor};
            Check: {from, within} = HasSecond ? {paired ? CheckFrom : AloneCheckFrom, PairFor} : {CheckFrom, FitFor};
            Rescan: {from, within} = {HasSecond && !paired ? AloneScanFrom : RescanFrom, ScanFor};
            End: {from, within} = {!HasSecond ? EndFrom : !paired ? FittedFrom : turns == 9 ? OtherEndFrom : EndFrom, EndFor};
            Second: {from, within} = {SecondFrom, SecondFor};
            Swap: {from, within} = {turn_from, SwapFor};
            default: {from, within} = 32'd0;
        endcase

    // Of turns: there are none of one echo, up to nine before the last, and ten after it
    wire in_turns = !HasSecond ? state <= End : !paired ? turns == 0 && state != Swap && wide == (state == Check)
        : wide && (state == Fit || state == Step || state == Swap ? turns <= 9
            : state == End ? turns == 9 || turns == 10 : (state == Check || state == Rescan) && turns == 10);
    wire in_step = under_way
        ? k == from + in_state && in_state < within && (solves ? in_program : !solver_works)
            && (state < Fit ? steps == 0 : state > Step || paired || steps <= (dark ? 1 : 5)) && in_turns
            && k < Latency && !done
        : state == Idle && !solver_works && done == (k == Latency) && (done || k == 16'd0);
