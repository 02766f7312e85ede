`timescale 1ps / 1fs
`default_nettype none

// Calibrates the TDC between two frames: counts hits of a ring oscillator, and works out ages from them.
//   state     Idle   Zero       Count                      Integrate      Idle
//   cycles           Taps + 1   2^HitsLog2 of the ring     5 (Taps + 1)
//   ring_on          ^---------------------------------v
module tdc_calibration #(
    parameter integer Taps = 800,                // see tdc
    parameter integer AgeBits = 14,              // see tdc_decoder; HitsLog2 + 1 or more
    parameter integer Cycle = 5120,              // see tdc_decoder
    parameter integer HitsLog2 = 13,             // hits of a calibration, as a power of two, 10 to 20
    parameter [15:0] CalibrationFrames = 16'd1,  // frames from one calibration to the next, 1 or more
    parameter [63:0] YoungestAge = 64'd365363,   // of the hits that have just reached tap 0 [1/256 unit]
    parameter [63:0] EdgeAge = 64'd1310720       // of a hit at the laser edge [1/256 unit]
) (
    input wire clk_sys,
    input wire rst,
    // frame_ctrl
    input wire clear,             // the histogram is being cleared
    input wire frame_done,        // a frame has ended
    output reg calibrating,       // the frame has to wait
    // Ring oscillator
    output reg ring_on,           // the TDC's hits are to come from it, and each counts
    // tdc_decoder
    input wire n_valid,                 // n is that of a new hit
    input wire [$clog2(Taps+1)-1:0] n,  // what the decoder made of its taps
    output reg [AgeBits-1:0] calibrated_age  // of the last hit's n [units]; a count while hits are counted
);
    localparam integer PlaceBits = $clog2(Taps + 1);
    // Of an age times twice the hits.
    localparam integer SumBits = AgeBits + HitsLog2 + 1;
    localparam [2:0] LastBeat = 3'd4;
    localparam [1:0] Idle = 2'd0, Zero = 2'd1, Count = 2'd2, Integrate = 2'd3;

    // verilator lint_off WIDTH
    localparam [PlaceBits-1:0] LastPlace = Taps;
    localparam [SumBits-1:0] FirstBegin = YoungestAge << (HitsLog2 - 7), EdgeSum = EdgeAge << (HitsLog2 - 7);
    localparam [AgeBits-1:0] Limit = (EdgeAge + 64'd128) >> 8;
    localparam [SumBits-1:0] CycleSum = Cycle;
    // verilator lint_on WIDTH
    localparam [SumBits-1:0] Half = {{SumBits - 1{1'b0}}, 1'b1} << HitsLog2;

    reg [1:0] state;            // what the block does
    reg due;                    // a calibration is due
    reg [15:0] frames;          // frames since the last one
    reg [PlaceBits-1:0] place;  // word that is set to zero, or turned into an age
    reg [HitsLog2:0] hits;      // hits counted
    reg counting;               // calibrated_age is the count of a hit
    reg [PlaceBits-1:0] hit_n;  // its n
    reg [2:0] beat;             // cycles that this word has taken
    reg [AgeBits-1:0] own_hits;  // the count of this word
    reg [SumBits-1:0] width;    // the count as a time
    reg [SumBits-1:0] begin_sum;  // where the ages of this word begin
    reg [SumBits-1:0] middle;   // the middle of them, and a half to round
    reg early;                  // they begin at the laser edge or before it

    reg calibrating_next, ring_on_next, due_next, counting_next, early_next;
    reg [1:0] state_next;
    reg [15:0] frames_next;
    reg [PlaceBits-1:0] place_next, hit_n_next;
    reg [HitsLog2:0] hits_next;
    reg [2:0] beat_next;
    reg [SumBits-1:0] width_next, begin_sum_next, middle_next;
    reg [AgeBits-1:0] own_hits_next;

    // Counts, and then ages.
    reg [AgeBits-1:0] ram [0:Taps];
    reg [PlaceBits-1:0] read_place, write_place;
    reg read, write;
    reg [AgeBits-1:0] write_word;

    wire full = hits[HitsLog2];
    wire [AgeBits-1:0] whole = middle[HitsLog2+1 +: AgeBits];  // the age without its fraction
    wire [AgeBits-1:0] limited = early && whole > Limit ? Limit : whole;

    integer i;
    initial begin
        {calibrating, ring_on, counting, early} = 4'd0;
        state = Idle;
        due = 1'b1;
        frames = 16'd0;
        {place, hit_n} = {2 * PlaceBits{1'b0}};
        hits = {HitsLog2 + 1{1'b0}};
        beat = 3'd0;
        {width, begin_sum, middle} = {3 * SumBits{1'b0}};
        {own_hits, calibrated_age} = {2 * AgeBits{1'b0}};
        for (i = 0; i <= Taps; i = i + 1) ram[i] = {AgeBits{1'b0}};
    end

    always @* begin
        state_next = state;
        calibrating_next = calibrating;
        ring_on_next = ring_on;
        due_next = due;
        frames_next = frames;
        place_next = place;
        hits_next = hits;
        counting_next = 1'b0;
        hit_n_next = hit_n;
        beat_next = beat;
        width_next = width;
        begin_sum_next = begin_sum;
        middle_next = middle;
        early_next = early;
        own_hits_next = own_hits;
        read = n_valid;
        read_place = n;
        write = counting;
        write_place = hit_n;
        write_word = calibrated_age + 1'b1;
        if (frame_done) begin
            due_next = due || frames == CalibrationFrames - 16'd1;
            frames_next = due_next ? 16'd0 : frames + 16'd1;
        end
        case (state)
            Idle: begin
                if (due && clear) begin
                    state_next = Zero;
                    due_next = 1'b0;
                    place_next = {PlaceBits{1'b0}};
                    ring_on_next = 1'b1;
                    calibrating_next = 1'b1;
                end
            end
            Zero: begin
                write = 1'b1;
                write_place = place;
                write_word = {AgeBits{1'b0}};
                if (place != LastPlace) begin
                    place_next = place + 1'b1;
                end else begin
                    state_next = Count;
                    hits_next = {HitsLog2 + 1{1'b0}};
                end
            end
            Count: begin
                if (n_valid && !full) begin
                    counting_next = 1'b1;
                    hit_n_next = n;
                    hits_next = hits + 1'b1;
                end else if (full && !counting) begin
                    state_next = Integrate;
                    ring_on_next = 1'b0;
                    place_next = {PlaceBits{1'b0}};
                    beat_next = 3'd0;
                    begin_sum_next = FirstBegin;
                end
            end
            Integrate: begin
                read = beat == 3'd0;
                read_place = place;
                write = beat == LastBeat;
                write_place = place;
                write_word = limited;
                beat_next = beat == LastBeat ? 3'd0 : beat + 3'd1;
                case (beat)
                    3'd0: ;
                    3'd1: own_hits_next = calibrated_age;
                    3'd2: width_next = {{SumBits - AgeBits{1'b0}}, own_hits} * CycleSum;
                    3'd3: begin
                        middle_next = begin_sum + width + Half;
                        early_next = begin_sum <= EdgeSum;
                    end
                    default: begin
                        begin_sum_next = begin_sum + (width << 1);
                        if (place == LastPlace) begin
                            state_next = Idle;
                            calibrating_next = 1'b0;
                        end else begin
                            place_next = place + 1'b1;
                        end
                    end
                endcase
            end
        endcase
    end

    always @(posedge clk_sys) begin
        if (write) ram[write_place] <= write_word;
        if (read) calibrated_age <= ram[read_place];
        if (rst) begin
            calibrating <= 1'b0;
            ring_on <= 1'b0;
            state <= Idle;
            due <= 1'b1;
            frames <= 16'd0;
            place <= {PlaceBits{1'b0}};
            hits <= {HitsLog2 + 1{1'b0}};
            counting <= 1'b0;
            hit_n <= {PlaceBits{1'b0}};
            beat <= 3'd0;
            width <= {SumBits{1'b0}};
            begin_sum <= {SumBits{1'b0}};
            middle <= {SumBits{1'b0}};
            early <= 1'b0;
            own_hits <= {AgeBits{1'b0}};
        end else begin
            calibrating <= calibrating_next;
            ring_on <= ring_on_next;
            state <= state_next;
            due <= due_next;
            frames <= frames_next;
            place <= place_next;
            hits <= hits_next;
            counting <= counting_next;
            hit_n <= hit_n_next;
            beat <= beat_next;
            width <= width_next;
            begin_sum <= begin_sum_next;
            middle <= middle_next;
            early <= early_next;
            own_hits <= own_hits_next;
        end
    end
endmodule
