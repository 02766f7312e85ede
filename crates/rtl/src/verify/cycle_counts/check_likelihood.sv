    // The blocks that go through the bins are left open, so it holds whatever is in the histogram. Of the solver remains
    // how it goes through its programs.
    localparam [3:0] Idle = 4'd0, Load = 4'd1, Ambient = 4'd2, Scan = 4'd3, Start = 4'd4, Fit = 4'd5, Step = 4'd6,
        Check = 4'd7, Rescan = 4'd8, End = 4'd9;
    // Cycles of each state
    localparam [15:0] LoadFor = `LIKELIHOOD_BINS + 13;
    localparam [15:0] ScanFor = 2 * (`LIKELIHOOD_BINS + `LIKELIHOOD_BOX - `LIKELIHOOD_BOX / 2 - 1 + 29) + 1;
    localparam [15:0] FitFor = 2 * (`LIKELIHOOD_BEFORE + 1 + `LIKELIHOOD_AFTER + 29) + 1;
    localparam [15:0] AmbientFor = 65, StartFor = 56, StepFor = 165, EndFor = 74;
    // Cycles of an estimation before each state first begins
    localparam [15:0] AmbientFrom = LoadFor, ScanFrom = AmbientFrom + AmbientFor, StartFrom = ScanFrom + ScanFor;
    localparam [15:0] FitFrom = StartFrom + StartFor, CheckFrom = FitFrom + 6 * (FitFor + StepFor);
    localparam [15:0] RescanFrom = CheckFrom + FitFor, EndFrom = RescanFrom + ScanFor;

    (* hierconn *) wire [3:0] \dut.state ;
    (* hierconn *) wire [$clog2(`LIKELIHOOD_BINS)+2:0] \dut.waited ;
    (* hierconn *) wire [2:0] \dut.steps ;
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
    wire [6:0] counter = \dut.likelihood_solver.counter ;
    wire [15:0] pause = \dut.likelihood_solver.pause ;
    wire solver_works = \dut.run || \dut.likelihood_solver.running || \dut.likelihood_solver.ran ;

    // The program of a state, its last instruction, and its cycles
    reg solves;
    reg [6:0] program, stop;
    reg [15:0] program_for;
    always @*
        case (state)
            Ambient: {solves, program, stop, program_for} = {1'b1, 7'd0, 7'd6, AmbientFor};
            Start: {solves, program, stop, program_for} = {1'b1, 7'd7, 7'd12, StartFor};
            Step: {solves, program, stop, program_for} = {1'b1, 7'd13, 7'd48, StepFor};
            End: {solves, program, stop, program_for} = {1'b1, 7'd49, 7'd63, EndFor};
            default: {solves, program, stop, program_for} = 31'd0;
        endcase

    // Of an instruction: the cycle of the program in which it begins, and how long it waits for that at most
    reg [15:0] begins, longest;
    always @*
        case (counter)
            7'd0: {begins, longest} = {16'd0, 16'd0};
            7'd1: {begins, longest} = {16'd26, 16'd25};
            7'd2: {begins, longest} = {16'd35, 16'd8};
            7'd3: {begins, longest} = {16'd44, 16'd8};
            7'd4: {begins, longest} = {16'd46, 16'd1};
            7'd5: {begins, longest} = {16'd53, 16'd6};
            7'd6: {begins, longest} = {16'd62, 16'd8};
            7'd7: {begins, longest} = {16'd0, 16'd0};
            7'd8: {begins, longest} = {16'd26, 16'd25};
            7'd9: {begins, longest} = {16'd35, 16'd8};
            7'd10: {begins, longest} = {16'd37, 16'd1};
            7'd11: {begins, longest} = {16'd44, 16'd6};
            7'd12: {begins, longest} = {16'd53, 16'd8};
            7'd13: {begins, longest} = {16'd0, 16'd0};
            7'd14: {begins, longest} = {16'd26, 16'd25};
            7'd15: {begins, longest} = {16'd28, 16'd1};
            7'd16: {begins, longest} = {16'd30, 16'd1};
            7'd17: {begins, longest} = {16'd35, 16'd4};
            7'd18: {begins, longest} = {16'd37, 16'd1};
            7'd19: {begins, longest} = {16'd39, 16'd1};
            7'd20: {begins, longest} = {16'd41, 16'd1};
            7'd21: {begins, longest} = {16'd43, 16'd1};
            7'd22: {begins, longest} = {16'd53, 16'd9};
            7'd23: {begins, longest} = {16'd54, 16'd0};
            7'd24: {begins, longest} = {16'd56, 16'd1};
            7'd25: {begins, longest} = {16'd58, 16'd1};
            7'd26: {begins, longest} = {16'd60, 16'd1};
            7'd27: {begins, longest} = {16'd62, 16'd1};
            7'd28: {begins, longest} = {16'd65, 16'd2};
            7'd29: {begins, longest} = {16'd69, 16'd3};
            7'd30: {begins, longest} = {16'd71, 16'd1};
            7'd31: {begins, longest} = {16'd75, 16'd3};
            7'd32: {begins, longest} = {16'd77, 16'd1};
            7'd33: {begins, longest} = {16'd81, 16'd3};
            7'd34: {begins, longest} = {16'd83, 16'd1};
            7'd35: {begins, longest} = {16'd109, 16'd25};
            7'd36: {begins, longest} = {16'd111, 16'd1};
            7'd37: {begins, longest} = {16'd118, 16'd6};
            7'd38: {begins, longest} = {16'd128, 16'd9};
            7'd39: {begins, longest} = {16'd129, 16'd0};
            7'd40: {begins, longest} = {16'd131, 16'd1};
            7'd41: {begins, longest} = {16'd138, 16'd6};
            7'd42: {begins, longest} = {16'd140, 16'd1};
            7'd43: {begins, longest} = {16'd142, 16'd1};
            7'd44: {begins, longest} = {16'd144, 16'd1};
            7'd45: {begins, longest} = {16'd149, 16'd4};
            7'd46: {begins, longest} = {16'd151, 16'd1};
            7'd47: {begins, longest} = {16'd153, 16'd1};
            7'd48: {begins, longest} = {16'd162, 16'd8};
            7'd49: {begins, longest} = {16'd0, 16'd0};
            7'd50: {begins, longest} = {16'd2, 16'd1};
            7'd51: {begins, longest} = {16'd36, 16'd33};
            7'd52: {begins, longest} = {16'd38, 16'd1};
            7'd53: {begins, longest} = {16'd40, 16'd1};
            7'd54: {begins, longest} = {16'd42, 16'd1};
            7'd55: {begins, longest} = {16'd44, 16'd1};
            7'd56: {begins, longest} = {16'd48, 16'd3};
            7'd57: {begins, longest} = {16'd50, 16'd1};
            7'd58: {begins, longest} = {16'd52, 16'd1};
            7'd59: {begins, longest} = {16'd54, 16'd1};
            7'd60: {begins, longest} = {16'd58, 16'd3};
            7'd61: {begins, longest} = {16'd60, 16'd1};
            7'd62: {begins, longest} = {16'd62, 16'd1};
            7'd63: {begins, longest} = {16'd71, 16'd8};
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
            Fit: {from, within} = {FitFrom + steps * (FitFor + StepFor), FitFor};
            Step: {from, within} = {FitFrom + steps * (FitFor + StepFor) + FitFor, StepFor};
            Check: {from, within} = {CheckFrom, FitFor};
            Rescan: {from, within} = {RescanFrom, ScanFor};
            End: {from, within} = {EndFrom, EndFor};
            default: {from, within} = 32'd0;
        endcase

    wire in_step = under_way
        ? k == from + in_state && in_state < within && (solves ? in_program : !solver_works)
            && (state < Fit ? steps == 0 : state > Step || steps <= 5) && k < Latency && !done
        : state == Idle && !solver_works && done == (k == Latency) && (done || k == 16'd0);
