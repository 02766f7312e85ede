`timescale 1ps / 1fs
`default_nettype none

// What a bin says of a point, in the likelihood estimator: residual, what is expected, and the signal's share.
//
// A bin goes through nine registers, a beat of two cycles each; two multipliers work twice a beat.
// Words are extended and cut as what they are assigned to is wide; some bits are not needed.
// verilator lint_off WIDTH
// verilator lint_off UNUSEDSIGNAL
module likelihood_terms #(
    parameter [0:0] Used = 1'b1,                 // 0: nothing starts it, and it has no ROMs
    parameter integer BinBits = 8,               // 2 to the power of which are the bins, 4 to 10
    parameter integer CountBits = 16,            // of a word of the histogram, 8 to 24
    parameter integer StepLog2 = 1,              // step of the pulse is 2 to the power of this [units]
    parameter PulseFile = "rtl_ref/pulse.mem",   // part before, slope of the pulse, slope of the part, by time
    parameter HazardFile = "rtl_ref/hazard.mem"  // lambda / (1 - exp(-lambda)) each quarter, and what it grows by
) (
    input wire clk_sys,
    input wire phase,                            // second cycle of a beat
    input wire scan,                             // without signal
    input wire [BinBits+10:0] arrival,           // of the echo [units / 16]
    input wire [23:0] strength,                  // photons a shot [2^-14]
    input wire [23:0] ambient,                   // hazard of ambient light [2^-30 / unit]
    input wire word_bin,                         // the word is a bin
    input wire word_rest,                        // it stands for all other bins
    input wire word_edge,                        // it is an edge alone
    input wire word_slide,                       // a box goes on with it
    input wire word_first,                       // of bin 0
    input wire [CountBits+BinBits-1:0] word_ended,    // shots that end in it
    input wire [CountBits+BinBits-1:0] word_waiting,  // shots that wait when it begins
    input wire [9:0] word_width,                 // its width [units]
    input wire [BinBits+7:0] word_end,           // where it ends [half units]
    output reg signed [CountBits+8:0] residual,  // v [2^-4 counts], 0 of what is no bin
    output reg [CountBits+17:0] predicted,        // R lambda [2^-12 counts]
    output reg [12:0] gain,                      // lambda / (exp(lambda) - 1) [2^-12]
    output reg [12:0] share,                     // the signal's in the hazard [2^-12]
    output reg signed [8:0] slope,               // of the pulse's logarithm
    output reg [CountBits+BinBits:0] middle,     // twice the shots that wait in the middle of a bin
    output reg waits,                            // shots wait at it
    output reg single,                           // the residual is that of a single bin
    output reg slide                             // a box goes on with it
);
    localparam integer RestBits = CountBits + BinBits, TimeBits = BinBits + 12;
    localparam integer EndedBits = RestBits + 17, WaitingProductBits = RestBits + 14;
    localparam integer ExpectedBits = CountBits + 18, ResidualBits = CountBits + 9;
    localparam [25:0] LeastHazard = 26'd4, MostHazard = 26'h3ffffff;

    // Words on the way
    reg bin_0, bin_1, bin_2, bin_3, bin_4, bin_5, bin_6, bin_7;
    reg rest_0, rest_1, rest_2, rest_3, rest_4, rest_5, rest_6, rest_7;
    reg slides_0, slides_1, slides_2, slides_3, slides_4, slides_5, slides_6, slides_7;
    reg edge_alone, first;
    reg [RestBits-1:0] ended_0, ended_1, ended_2, ended_3, ended_4, ended_5, ended_6, ended_7;
    reg [RestBits-1:0] waiting_0, waiting_1, waiting_2, waiting_3, waiting_4, waiting_5, waiting_6, waiting_7;
    reg [9:0] width_0, width_1;
    reg [16:0] fetched_part, low_part;           // of the words of the pulse around a time
    reg signed [8:0] fetched_slope, fetched_first, low_slope, low_first;
    reg [3:0] sixteenths;                        // how far the time is from one to the other
    reg [16:0] pulse_part;                       // part of the pulse before the word's end
    reg signed [8:0] pulse_slope, pulse_first;   // slope there, and that of the part
    reg [16:0] last_part;                        // the same at the end of the bin before
    reg signed [8:0] last_slope;
    reg [16:0] part;                             // part of the pulse in the bin
    reg signed [8:0] z_0, z_1, z_2, z_3, z_4, z_5, z_6;
    reg [25:0] lit_first, lit, dim;              // hazards of the signal and of ambient light
    reg [25:0] hazard_0, hazard_1, hazard_2;     // of both, within its limits
    reg [25:0] signal_hazard;
    reg [4:0] bits_0, bits_1, bits_2;            // of the hazard
    reg [13:0] mantissa_0, mantissa_1;           // the hazard's
    reg [13:0] aligned;                          // the signal's hazard, as it is shifted
    reg [16:0] k;                                // lambda / (1 - exp(-lambda)) [2^-12]
    reg [12:0] gains_0, gains_1;
    reg [12:0] shares_0, shares_1, shares_2;
    reg [EndedBits-1:0] ended_k_first, ended_k_0, ended_k_1;
    reg [WaitingProductBits-1:0] product;        // R times the mantissa
    reg [ExpectedBits-1:0] product_shifted;      // R lambda

`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg [34:0] pulse [0:2047];
    reg [27:0] hazards [0:63];
    reg [9:0] reciprocals [0:63];

    integer i;
    initial begin
        if (Used) $readmemh(PulseFile, pulse);
        if (Used) $readmemh(HazardFile, hazards);
        // 1024 over 1 + (i + 1/2) / 64, rounded
        for (i = 0; i < 64; i = i + 1) reciprocals[i] = (262144 + 129 + 2 * i) / (2 * (129 + 2 * i));
    end

    initial begin
        {residual, predicted, gain, share, slope, middle, waits, single, slide} = 0;
        {bin_0, bin_1, bin_2, bin_3, bin_4, bin_5, bin_6, bin_7} = 8'd0;
        {rest_0, rest_1, rest_2, rest_3, rest_4, rest_5, rest_6, rest_7} = 8'd0;
        {slides_0, slides_1, slides_2, slides_3, slides_4, slides_5, slides_6, slides_7} = 8'd0;
        {edge_alone, first} = 2'd0;
        {ended_0, ended_1, ended_2, ended_3, ended_4, ended_5, ended_6, ended_7} = 0;
        {waiting_0, waiting_1, waiting_2, waiting_3, waiting_4, waiting_5, waiting_6, waiting_7} = 0;
        {width_0, width_1} = 20'd0;
        {pulse_part, pulse_slope, pulse_first, last_part, last_slope, part} = 0;
        {fetched_part, fetched_slope, fetched_first, low_part, low_slope, low_first, sixteenths} = 0;
        {z_0, z_1, z_2, z_3, z_4, z_5, z_6} = 0;
        {lit_first, lit, dim, hazard_0, hazard_1, hazard_2, signal_hazard} = 0;
        {bits_0, bits_1, bits_2, mantissa_0, mantissa_1, aligned, k} = 0;
        {gains_0, gains_1, shares_0, shares_1, shares_2} = 0;
        {ended_k_first, ended_k_0, ended_k_1, product, product_shifted} = 0;
    end

    // The pulse at the word's end
    wire signed [TimeBits-1:0] time_from = $signed({1'b0, word_end, 3'd0}) - $signed({1'b0, arrival});
    wire signed [TimeBits-1:0] steps = time_from >>> (StepLog2 + 4);
    wire below = steps < -1024, above = steps > 1022;
    wire [10:0] place = below ? 11'd0 : above ? 11'd2046 : {!steps[10], steps[9:0]};
    wire [10:0] fetched_place = place + {10'd0, phase};
    wire signed [TimeBits-1:0] fine_steps = time_from >>> StepLog2;
    wire [16:0] rise = fetched_part - low_part;
    reg [20:0] risen;
    always @* begin
        risen = 21'd0;
        for (i = 0; i < 4; i = i + 1) if (sixteenths[i]) risen = risen + ({4'd0, rise} << i);
    end

    // What of it is in the bin, and the slope between its ends
    wire none = edge_alone && first;
    wire signed [9:0] slopes = {pulse_slope[8], pulse_slope} + {last_slope[8], last_slope};

    // Two multipliers
    wire [23:0] level = phase ? ambient : strength;
    wire [16:0] amount = phase ? {7'd0, width_1} : part;
    wire [40:0] light = level * amount;
    wire [40:0] light_rounded = phase ? (light >> 8) + {40'd0, light[7]} : (light >> 9) + {40'd0, light[8]};
    wire [25:0] light_limited = |light_rounded[40:26] ? MostHazard : light_rounded[25:0];
    wire [RestBits-1:0] shots = phase ? waiting_5 : ended_5;
    wire [16:0] factor = phase ? {3'd0, mantissa_1} : k;
    wire [EndedBits-1:0] times = shots * factor;

    // The hazard
    wire [26:0] sum = {1'b0, lit} + {1'b0, dim};
    wire [25:0] limited = sum[26] ? MostHazard : sum[25:0] < LeastHazard ? LeastHazard : sum[25:0];

    // Its mantissa
    reg [4:0] length;
    always @* begin
        length = 5'd0;
        for (i = 0; i < 26; i = i + 1) if (hazard_0[i]) length = i[4:0] + 5'd1;
    end
    wire [51:0] hazard_aligned = {hazard_0, 26'd0} >> length;
    wire [51:0] signal_aligned = {signal_hazard, 26'd0} >> length;

    // k and the share, in fabric
    wire [27:0] hazard_word = hazards[hazard_1[25:20]];
    reg [20:0] growth;
    always @* begin
        growth = 21'd0;
        for (i = 0; i < 10; i = i + 1) if (hazard_1[10 + i]) growth = growth + ({10'd0, hazard_word[10:0]} << i);
    end
    wire [9:0] reciprocal = reciprocals[mantissa_0[12:7]];
    reg [23:0] share_product;
    always @* begin
        share_product = 24'd1024;
        for (i = 0; i < 10; i = i + 1) if (reciprocal[i]) share_product = share_product + ({10'd0, aligned} << i);
    end

    // R lambda from its mantissa
    wire [4:0] down = bits_2 >= 5'd24 ? 5'd0 : 5'd24 - bits_2;
    wire [WaitingProductBits:0] down_shifted = {product, 1'b0} >> down;
    wire [WaitingProductBits+1:0] shifted
        = bits_2 > 5'd24 ? {2'd0, product} << (bits_2 - 5'd24)
        : {2'd0, down_shifted[WaitingProductBits:1]} + {{WaitingProductBits + 1{1'b0}}, down_shifted[0]};

    // The residual
    wire any = bin_7 || rest_7;
    wire signed [EndedBits:0] surplus
        = $signed({1'b0, ended_k_1}) - $signed({{EndedBits - ExpectedBits + 1{1'b0}}, product_shifted});
    wire signed [EndedBits-7:0] surplus_rounded
        = $signed({surplus[EndedBits], surplus[EndedBits:8]}) + $signed({{EndedBits - 7{1'b0}}, surplus[7]});
    wire surplus_fits = surplus_rounded[EndedBits-7:ResidualBits-1] == {EndedBits - 5 - ResidualBits{surplus_rounded[EndedBits-7]}};
    wire [ResidualBits-1:0] surplus_limited = surplus_fits ? surplus_rounded[ResidualBits-1:0]
        : {surplus_rounded[EndedBits-7], {ResidualBits - 1{!surplus_rounded[EndedBits-7]}}};
    wire [RestBits:0] twice = {waiting_7, 1'b0};

    always @(posedge clk_sys) begin
        {fetched_part, fetched_slope, fetched_first} <= pulse[fetched_place];
        if (!phase) begin
            pulse_part <= low_part + risen[20:4];
            {pulse_slope, pulse_first} <= {low_slope, low_first};
            lit_first <= light_limited;
            ended_k_first <= times;
        end else begin
            sixteenths <= fine_steps[3:0];
            {low_part, low_slope, low_first} <= {fetched_part, fetched_slope, fetched_first};
            {bin_7, bin_6, bin_5, bin_4, bin_3, bin_2, bin_1, bin_0}
                <= {bin_6, bin_5, bin_4, bin_3, bin_2, bin_1, bin_0, word_bin};
            {rest_7, rest_6, rest_5, rest_4, rest_3, rest_2, rest_1, rest_0}
                <= {rest_6, rest_5, rest_4, rest_3, rest_2, rest_1, rest_0, word_rest};
            {slides_7, slides_6, slides_5, slides_4, slides_3, slides_2, slides_1, slides_0}
                <= {slides_6, slides_5, slides_4, slides_3, slides_2, slides_1, slides_0, word_slide};
            {ended_7, ended_6, ended_5, ended_4, ended_3, ended_2, ended_1, ended_0}
                <= {ended_6, ended_5, ended_4, ended_3, ended_2, ended_1, ended_0, word_ended};
            {waiting_7, waiting_6, waiting_5, waiting_4, waiting_3, waiting_2, waiting_1, waiting_0}
                <= {waiting_6, waiting_5, waiting_4, waiting_3, waiting_2, waiting_1, waiting_0, word_waiting};
            {width_1, width_0} <= {width_0, word_width};
            edge_alone <= word_edge;
            first <= word_first;

            last_part <= none ? 17'd0 : pulse_part;
            last_slope <= pulse_slope;
            part <= bin_0 && !scan ? pulse_part - last_part : 17'd0;
            z_0 <= rest_0 ? 9'sd0 : first ? pulse_first : slopes[9:1];
            {z_6, z_5, z_4, z_3, z_2, z_1} <= {z_5, z_4, z_3, z_2, z_1, z_0};

            lit <= lit_first;
            dim <= light_limited;
            hazard_0 <= limited;
            {hazard_2, hazard_1} <= {hazard_1, hazard_0};
            signal_hazard <= lit < limited ? lit : limited;

            bits_0 <= length;
            {bits_2, bits_1} <= {bits_1, bits_0};
            mantissa_0 <= hazard_aligned[25:12];
            mantissa_1 <= mantissa_0;
            aligned <= signal_aligned[25:12];

            k <= hazard_word[27:11] + {6'd0, growth[20:10]};
            gains_0 <= {1'b0, hazard_2[25:10]} > k ? 13'd0 : k[12:0] - hazard_2[22:10];
            gains_1 <= gains_0;
            shares_0 <= share_product[23:11] > 13'd4096 ? 13'd4096 : share_product[23:11];
            {shares_2, shares_1} <= {shares_1, shares_0};

            ended_k_0 <= ended_k_first;
            ended_k_1 <= ended_k_0;
            product <= times[WaitingProductBits-1:0];
            product_shifted <= |shifted[WaitingProductBits+1:ExpectedBits] ? {ExpectedBits{1'b1}}
                : shifted[ExpectedBits-1:0];

            residual <= any ? surplus_limited : {ResidualBits{1'b0}};
            predicted <= any ? product_shifted : {ExpectedBits{1'b0}};
            gain <= gains_1;
            share <= shares_2;
            slope <= z_6;
            middle <= !any || twice < {1'b0, ended_7} ? {RestBits + 1{1'b0}} : twice - {1'b0, ended_7};
            waits <= any && |waiting_7;
            single <= bin_7;
            slide <= slides_7;
        end
    end
endmodule
// verilator lint_on UNUSEDSIGNAL
// verilator lint_on WIDTH
