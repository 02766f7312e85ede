`timescale 1ps / 1fs
`default_nettype none

// Turns a hit into a code: counts its high taps in steps, or finds the highest, then looks up and subtracts the time.
//   edge      e+1       e+2       e+3       e+4  e+5  e+6  e+7
//   register  hit_taps  sixteens  hundreds  n    age  t    tdc_code, tdc_valid
module tdc_decoder #(
    parameter integer Taps = 800,  // of the chain, 16 to 2000
    parameter integer CoarseBits = 3,
    parameter integer BinBits = 8,   // of a code
    parameter integer Cycle = 5120,  // a period of clk_sys [units, 25/16 ps]
    parameter integer Digits = 4,    // of a time below a bin, in binary
    parameter integer AgeBits = 14,  // of a word of CalFile
    parameter CalFile = "rtl_ref/tdc_cal.mem",  // age of a hit for each n [units]
    parameter [1:0] CountStages = 2'd3,  // registers from the taps to n; 2: n comes of the sixteens
    parameter [1:0] Decoder = 2'd0,  // 0: ones count, 1: highest tap that is one, 2: the same once taps are in Order
    parameter [0:0] Calibrated = 1'b0,  // ages come from tdc_calibration and not from CalFile
    parameter [16*Taps-1:0] Order = 0  // tap that is reached at each place less the place, in words of 16 bits
) (
    input wire clk_sys,
    input wire rst,
    // tdc_latch
    input wire hit,                          // hit_taps are those of a new hit
    input wire [CoarseBits-1:0] hit_coarse,  // its coarse count
    input wire [Taps-1:0] hit_taps,          // its taps
    // tdc_calibration
    // verilator lint_off UNUSEDSIGNAL
    input wire [AgeBits-1:0] calibrated_age,  // its age for n, a cycle later [units]
    // verilator lint_on UNUSEDSIGNAL
    output reg n_valid,                      // n is new; one cycle
    output reg [$clog2(Taps+1)-1:0] n,       // taps that the hit had run through, by the decoder
    // The code
    output reg tdc_valid,                    // tdc_code is new; one cycle
    output reg [BinBits-1:0] tdc_code        // time of the hit [bins]
);
    // Groups of 16 and of 128 taps, and bits of what counts all of them and of a time.
    localparam integer Sixteens = (Taps + 15) / 16, Hundreds = (Taps + 127) / 128;
    localparam integer OnesBits = $clog2(Taps + 1), EdgeBits = $clog2(Cycle + 1) + CoarseBits;
    // A time is shorter than an edge's number of cycles, and than what it is compared with.
    localparam integer CodeBits = BinBits + Digits, LongBits = EdgeBits > AgeBits ? EdgeBits : AgeBits;
    localparam integer TimeBits = 1 + (LongBits > CodeBits ? LongBits : CodeBits);

    // Each holds its last hit, is new for one cycle, and has that hit's coarse count.
    reg [5*Sixteens-1:0] sixteens;  // ones among 16 taps each, or the place of the highest
    reg [8*Hundreds-1:0] hundreds;  // ones among 128 taps each, or the place of the highest
    reg [AgeBits-1:0] age;          // the time for that [units]
    // Its lowest bits are for the borrow.
    // verilator lint_off UNUSEDSIGNAL
    reg signed [TimeBits-1:0] t;  // time from the begin of bin 0 [units]
    // verilator lint_on UNUSEDSIGNAL
    reg sixteens_valid, hundreds_valid, age_valid, t_valid;
    reg [CoarseBits-1:0] sixteens_coarse, hundreds_coarse, n_coarse, age_coarse;
    reg [5*Sixteens-1:0] sixteens_next;
    reg [8*Hundreds-1:0] hundreds_next;
    reg tdc_valid_next;
    reg [BinBits-1:0] tdc_code_next;

    // Block RAM, or LUTs for gate-level simulation, since Yosys has no model of a block RAM.
`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg [AgeBits-1:0] cal [0:Taps];
    initial $readmemh(CalFile, cal);

    initial begin
        tdc_valid = 1'b0;
        tdc_code = {BinBits{1'b0}};
        {sixteens_valid, hundreds_valid, n_valid, age_valid, t_valid} = 5'd0;
        {sixteens_coarse, hundreds_coarse, n_coarse, age_coarse} = {4 * CoarseBits{1'b0}};
        sixteens = {5 * Sixteens{1'b0}};
        hundreds = {8 * Hundreds{1'b0}};
        n = {OnesBits{1'b0}};
        age = {AgeBits{1'b0}};
        t = {TimeBits{1'b0}};
    end

    // Ones and their sums, as balanced trees. All taps count, so bubbles do no harm.
    function [2:0] ones_of_4;
        input [3:0] taps;
        ones_of_4 = {2'd0, taps[0]} + {2'd0, taps[1]} + {2'd0, taps[2]} + {2'd0, taps[3]};
    endfunction

    function [4:0] ones_of_16;
        input [15:0] taps;
        ones_of_16 = ({2'd0, ones_of_4(taps[3:0])} + {2'd0, ones_of_4(taps[7:4])})
            + ({2'd0, ones_of_4(taps[11:8])} + {2'd0, ones_of_4(taps[15:12])});
    endfunction

    function [7:0] sum_of_8;
        input [5*8-1:0] s;
        sum_of_8 = (({3'd0, s[0 +: 5]} + {3'd0, s[5 +: 5]}) + ({3'd0, s[10 +: 5]} + {3'd0, s[15 +: 5]}))
            + (({3'd0, s[20 +: 5]} + {3'd0, s[25 +: 5]}) + ({3'd0, s[30 +: 5]} + {3'd0, s[35 +: 5]}));
    endfunction

    function [11:0] sum_of_4;
        input [8*4-1:0] s;
        sum_of_4 = ({4'd0, s[0 +: 8]} + {4'd0, s[8 +: 8]}) + ({4'd0, s[16 +: 8]} + {4'd0, s[24 +: 8]});
    endfunction

    function [11:0] sum_of_16;
        input [8*16-1:0] s;
        sum_of_16 = (sum_of_4(s[0 +: 32]) + sum_of_4(s[32 +: 32]))
            + (sum_of_4(s[64 +: 32]) + sum_of_4(s[96 +: 32]));
    endfunction

    // Past the last tap stand zeros.
    // verilator lint_off UNUSEDSIGNAL
    wire [16*Sixteens:0] all_taps = {{16 * Sixteens + 1 - Taps{1'b0}}, hit_taps};
    wire [40*Hundreds:0] all_sixteens = {{40 * Hundreds + 1 - 5 * Sixteens{1'b0}}, sixteens};
    wire [8*16:0] last_sums;
    // verilator lint_on UNUSEDSIGNAL

    integer i;
    generate if (Decoder == 2'd0) always @* begin
        for (i = 0; i < Sixteens; i = i + 1) sixteens_next[5*i +: 5] = ones_of_16(all_taps[16*i +: 16]);
        for (i = 0; i < Hundreds; i = i + 1) hundreds_next[8*i +: 8] = sum_of_8(all_sixteens[40*i +: 40]);
    end endgenerate

    wire counted;
    wire [CoarseBits-1:0] counted_coarse;
    generate
        if (CountStages == 2'd2) begin : two_stages
            wire [8*Hundreds-1:0] unregistered = hundreds_next;
            assign counted = sixteens_valid;
            assign last_sums = {{129 - 8 * Hundreds{1'b0}}, unregistered};
            assign counted_coarse = sixteens_coarse;
        end else begin : three_stages
            assign counted = hundreds_valid;
            assign last_sums = {{129 - 8 * Hundreds{1'b0}}, hundreds};
            assign counted_coarse = hundreds_coarse;
        end
    endgenerate
    // 2000 taps at most.
    // verilator lint_off UNUSEDSIGNAL
    wire [11:0] count;
    generate if (Decoder == 2'd0) assign count = sum_of_16(last_sums[127:0]); endgenerate
    // verilator lint_on UNUSEDSIGNAL

    // The bits of Cycle say which multiples of the edge's number make its time.
    wire [TimeBits-1:0] edge_number = {{TimeBits - CoarseBits{1'b0}}, age_coarse} + 1'b1;
    reg signed [TimeBits-1:0] edge_time;

    integer bit_of_cycle;
    always @* begin
        edge_time = {TimeBits{1'b0}};
        for (bit_of_cycle = 0; bit_of_cycle < 31; bit_of_cycle = bit_of_cycle + 1)
            if (Cycle[bit_of_cycle]) edge_time = edge_time + (edge_number << bit_of_cycle);
    end

    always @* begin
        // Within the bins; the highest bit is the sign.
        tdc_valid_next = t_valid && t[TimeBits-1:CodeBits] == {TimeBits - CodeBits{1'b0}};
        tdc_code_next = tdc_code;
        if (tdc_valid_next) tdc_code_next = t[Digits +: BinBits];
    end

    always @(posedge clk_sys) begin
        if (hit) begin
            sixteens <= sixteens_next;
            sixteens_coarse <= hit_coarse;
        end
        if (sixteens_valid) begin
            hundreds <= hundreds_next;
            hundreds_coarse <= sixteens_coarse;
        end
        if (counted) begin
            n <= count[OnesBits-1:0];
            n_coarse <= counted_coarse;
        end
        if (n_valid) begin
            age <= cal[n];
            age_coarse <= n_coarse;
        end
        if (age_valid) t <= edge_time - {{TimeBits - AgeBits{1'b0}}, Calibrated ? calibrated_age : age};
        if (rst) begin
            tdc_valid <= 1'b0;
            tdc_code <= {BinBits{1'b0}};
            sixteens_valid <= 1'b0;
            hundreds_valid <= 1'b0;
            n_valid <= 1'b0;
            age_valid <= 1'b0;
            t_valid <= 1'b0;
        end else begin
            tdc_valid <= tdc_valid_next;
            tdc_code <= tdc_code_next;
            sixteens_valid <= hit;
            hundreds_valid <= sixteens_valid;
            n_valid <= counted;
            age_valid <= n_valid;
            t_valid <= age_valid;
        end
    end

    // In the place of counts: places from 1 on of the highest one, or 0 where there is none.
    generate
        if (Decoder != 2'd0) begin : leading
            wire [16*Sixteens-1:0] in_order;
            if (Decoder == 2'd1) assign in_order = all_taps[16*Sixteens-1:0];
            genvar place;
            for (place = 0; place < 16 * Sixteens; place = place + 1) if (Decoder == 2'd2) begin : places
                if (place >= Taps) assign in_order[place] = 1'b0;
                else assign in_order[place] = hit_taps[(Order[16*place +: 16] + place) % 65536];
            end

            always @* begin
                for (i = 0; i < Sixteens; i = i + 1)
                    sixteens_next[5*i +: 5] = highest_of_16(in_order[16*i +: 16]);
                for (i = 0; i < Hundreds; i = i + 1)
                    hundreds_next[8*i +: 8] = highest_of_8_groups(all_sixteens[40*i +: 40]);
            end
            assign count = highest_of_16_groups(last_sums[127:0]);
        end
    endgenerate

    function [2:0] highest_of_4;
        input [3:0] taps;
        highest_of_4 = taps[3] ? 3'd4 : taps[2] ? 3'd3 : taps[1] ? 3'd2 : {2'd0, taps[0]};
    endfunction

    function [4:0] highest_of_16;
        input [15:0] taps;
        highest_of_16 = taps[15:12] != 4'd0 ? 5'd12 + {2'd0, highest_of_4(taps[15:12])}
            : taps[11:8] != 4'd0 ? 5'd8 + {2'd0, highest_of_4(taps[11:8])}
            : taps[7:4] != 4'd0 ? 5'd4 + {2'd0, highest_of_4(taps[7:4])}
            : {2'd0, highest_of_4(taps[3:0])};
    endfunction

    // Of groups, the places in the highest group that has one.
    function [5:0] highest_of_2_groups;
        input [5*2-1:0] s;
        highest_of_2_groups = s[5 +: 5] != 5'd0 ? 6'd16 + {1'b0, s[5 +: 5]} : {1'b0, s[0 +: 5]};
    endfunction

    function [7:0] highest_of_8_groups;
        input [5*8-1:0] s;
        highest_of_8_groups = s[30 +: 10] != 10'd0 ? 8'd96 + {2'd0, highest_of_2_groups(s[30 +: 10])}
            : s[20 +: 10] != 10'd0 ? 8'd64 + {2'd0, highest_of_2_groups(s[20 +: 10])}
            : s[10 +: 10] != 10'd0 ? 8'd32 + {2'd0, highest_of_2_groups(s[10 +: 10])}
            : {2'd0, highest_of_2_groups(s[0 +: 10])};
    endfunction

    function [9:0] highest_of_4_groups;
        input [8*4-1:0] s;
        highest_of_4_groups = s[24 +: 8] != 8'd0 ? 10'd384 + {2'd0, s[24 +: 8]}
            : s[16 +: 8] != 8'd0 ? 10'd256 + {2'd0, s[16 +: 8]}
            : s[8 +: 8] != 8'd0 ? 10'd128 + {2'd0, s[8 +: 8]}
            : {2'd0, s[0 +: 8]};
    endfunction

    function [11:0] highest_of_16_groups;
        input [8*16-1:0] s;
        highest_of_16_groups = s[96 +: 32] != 32'd0 ? 12'd1536 + {2'd0, highest_of_4_groups(s[96 +: 32])}
            : s[64 +: 32] != 32'd0 ? 12'd1024 + {2'd0, highest_of_4_groups(s[64 +: 32])}
            : s[32 +: 32] != 32'd0 ? 12'd512 + {2'd0, highest_of_4_groups(s[32 +: 32])}
            : {2'd0, highest_of_4_groups(s[0 +: 32])};
    endfunction
endmodule
