`default_nettype none

// What holds of likelihood_estimator in every cycle, for every pattern of starts and resets, once it has been reset
// in the first. `HOLDS names the property to prove.
//
// The blocks that go through the bins are left open, so it holds whatever is in the histogram. Of the solver remains
// how it goes through its programs. The registers of both make the induction go through without unrolling an
// estimation. `LIKELIHOOD sets the parameters where they are not the default; the other macros are of the same names
// in any case.
module check_likelihood #(
    parameter Latency = 3825  // cycle of algo_done, counted from the edge that takes a start
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,
    input wire [15:0] count
);
    localparam [3:0] Idle = 4'd0, Load = 4'd1, Ambient = 4'd2, Scan = 4'd3, Start = 4'd4, Fit = 4'd5, Step = 4'd6,
        Check = 4'd7, Rescan = 4'd8, End = 4'd9;
    // Cycles of each state
    localparam [15:0] LoadFor = `LIKELIHOOD_BINS + 10;
    localparam [15:0] ScanFor = 2 * (`LIKELIHOOD_BINS + `LIKELIHOOD_BOX - `LIKELIHOOD_BOX / 2 - 1 + 18) + 1;
    localparam [15:0] FitFor = 2 * (`LIKELIHOOD_BEFORE + 1 + `LIKELIHOOD_AFTER + 18) + 1;
    localparam [15:0] AmbientFor = 51, StartFor = 46, StepFor = 206, EndFor = 99;
    // Cycles of an estimation before each state first begins
    localparam [15:0] AmbientFrom = LoadFor, ScanFrom = AmbientFrom + AmbientFor, StartFrom = ScanFrom + ScanFor;
    localparam [15:0] FitFrom = StartFrom + StartFor, CheckFrom = FitFrom + 6 * (FitFor + StepFor);
    localparam [15:0] RescanFrom = CheckFrom + FitFor, EndFrom = RescanFrom + ScanFor;

    wire algo_done;
    (* hierconn *) wire [3:0] \dut.state ;
    (* hierconn *) wire [$clog2(`LIKELIHOOD_BINS)+2:0] \dut.waited ;
    (* hierconn *) wire [2:0] \dut.steps ;
    (* hierconn *) wire \dut.run ;
    (* hierconn *) wire [6:0] \dut.entry ;
    (* hierconn *) wire \dut.likelihood_solver.running ;
    (* hierconn *) wire \dut.likelihood_solver.ran ;
    (* hierconn *) wire [6:0] \dut.likelihood_solver.counter ;
    (* hierconn *) wire [4:0] \dut.likelihood_solver.cycle ;

`ifdef LIKELIHOOD
    likelihood_estimator #(`LIKELIHOOD) dut (
`else
    likelihood_estimator dut (
`endif
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .count(count),
        .algo_done(algo_done)
    );

    // Counts by itself: a start is taken unless one is under way, and is under way until algo_done.
    reg first = 1'b1;      // the first cycle
    reg under_way = 1'b0;  // cycles e0 .. e(Latency - 1)
    reg done = 1'b0;       // cycle eLatency
    reg [15:0] k = 16'd0;  // in cycle ek

    always @(posedge clk_sys) begin
        first <= 1'b0;
        under_way <= !rst && (under_way ? k + 1 < Latency : algo_start);
        done <= !rst && under_way && k + 1 == Latency;
        k <= !rst && under_way ? k + 16'd1 : 16'd0;
    end

    wire likelihood_latency = algo_done == done;

    wire [3:0] state = \dut.state ;
    wire [15:0] waited = \dut.waited ;
    wire [15:0] steps = \dut.steps ;
    wire [6:0] counter = \dut.likelihood_solver.counter ;
    wire [15:0] cycle = \dut.likelihood_solver.cycle ;
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

    // Of an instruction: its last cycle, and how many cycles of the program are before it. Four reciprocals and a
    // root take longer than five cycles; two instructions take one.
    reg [15:0] last_cycle, before;
    always @* begin
        last_cycle = 16'd4;
        before = 5 * (counter - program);
        case (counter)
            7'd0, 7'd7, 7'd13, 7'd34: last_cycle = 16'd22;
            7'd52: last_cycle = 16'd30;
            7'd6, 7'd12, 7'd22, 7'd38, 7'd48, 7'd63: last_cycle = 16'd0;
            default: ;
        endcase
        if (solves && counter > program && !(state == End)) before = before + 16'd18;
        if (counter > 7'd34 && state == Step) before = before + 16'd18;
        if (counter > 7'd22 && state == Step) before = before - 16'd4;
        if (counter > 7'd38 && state == Step) before = before - 16'd4;
        if (counter > 7'd52 && state == End) before = before + 16'd26;
    end

    wire in_program = \dut.run ? \dut.entry == program && !\dut.likelihood_solver.running && !\dut.likelihood_solver.ran
        : \dut.likelihood_solver.running ? counter >= program && counter <= stop && cycle <= last_cycle
            && !\dut.likelihood_solver.ran
        : \dut.likelihood_solver.ran ;
    wire [15:0] in_state = !solves ? waited
        : \dut.run ? 16'd0 : \dut.likelihood_solver.running ? 16'd1 + before + cycle : program_for - 16'd1;

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

    always @* begin
        if (first) assume (rst);
        else assert (in_step && `HOLDS);
    end
endmodule
