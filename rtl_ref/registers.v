`timescale 1ps / 1fs
`default_nettype none

// The registers of the host: the control signals, the state of the firmware, the last finished frame with its histogram,
// and how often the TDC has given each n. A word that no register has reads 0.
//
// One bank of the histogram's copy takes what the estimator reads while the host reads the other; they change places
// when a frame ends, unless the host holds the frame that it reads.
module registers #(
    parameter [63:0] ParametersHash = 64'd0,
    parameter [31:0] SystemHz = 32'd125000000,    // clk_sys [Hz]
    parameter [31:0] HostTimeout = 32'd62500000,  // see laser_guard
    parameter integer BinBits = 8,
    parameter integer CountBits = 16,
    parameter integer RateBits = 2,
    parameter integer Taps = 800
) (
    input wire clk_sys,
    input wire rst,
    // uart_bridge
    input wire [31:0] address,            // [words]
    input wire write_en,
    input wire [31:0] write_data,
    output reg [31:0] read_data,          // the word at address, two edges after it
    // laser_guard
    input wire pins_selected,                // the switch selects the control pins
    input wire armed,                     // the laser may fire
    input wire interlock_sync,            // the interlock is open
    input wire host_silent,               // why the laser went off
    input wire unlocked,
    input wire interlocked,
    input wire pulse_too_long,
    input wire rate_too_high,
    output reg arm,                       // arms the laser; one cycle
    output reg disarm,                    // disarms it; one cycle
    // The firmware
    input wire start,                     // a shot begins
    input wire tdc_valid,                 // a hit has a code
    input wire n_valid,                   // n is that of a new hit
    input wire [$clog2(Taps+1)-1:0] n,
    input wire calibrating,
    input wire acquire,
    input wire hist_valid,                // a word of the histogram is being read
    input wire [BinBits-1:0] hist_bin,
    input wire [CountBits-1:0] hist_count,
    input wire frame_done,
    input wire signed [35:0] depth,
    input wire [35:0] sigma,
    input wire [6:0] status,
    input wire valid,
    input wire [3:0] code,
    output reg host_mode,                 // control signals, see control_sync
    output reg [RateBits-1:0] host_laser_freq,
    output reg host_laser_en,
    output reg host_dsp_en,
    output reg host_dsp_rst,
    output reg host_ring_on               // hits are to come from the ring oscillator
);
    localparam integer PlaceBits = $clog2(Taps + 1);
    localparam [PlaceBits-1:0] LastPlace = Taps[PlaceBits-1:0];
    localparam [31:0] IdentityValue = 32'h746f6673, MapVersionValue = 32'd1, ArmKey = 32'h4c415352;
    // Of src/firmware/registers/map.rs, from which they are made [words].
    localparam integer AddressBits = 14;
    localparam [13:0] IdentityAt = 14'h0000;
    localparam [13:0] MapVersionAt = 14'h0001;
    localparam [13:0] ParametersHashAt = 14'h0002;
    localparam [13:0] SystemHzAt = 14'h0004;
    localparam [13:0] HostTimeoutAt = 14'h0005;
    localparam [13:0] ScratchAt = 14'h0006;
    localparam [13:0] ControlAt = 14'h0008;
    localparam [13:0] FramesPermittedAt = 14'h0009;
    localparam [13:0] ArmAt = 14'h000a;
    localparam [13:0] StatusAt = 14'h000b;
    localparam [13:0] LaserFaultsAt = 14'h000c;
    localparam [13:0] FramesAt = 14'h0010;
    localparam [13:0] ShotsAt = 14'h0011;
    localparam [13:0] HitsAt = 14'h0012;
    localparam [13:0] HoldAt = 14'h0018;
    localparam [13:0] FrameAt = 14'h0019;
    localparam [13:0] DepthAt = 14'h001a;
    localparam [13:0] SigmaAt = 14'h001c;
    localparam [13:0] EstimateStatusAt = 14'h001e;
    localparam [13:0] EstimateValidAt = 14'h001f;
    localparam [13:0] DensityClearAt = 14'h0020;
    localparam [13:0] DensityHitsAt = 14'h0021;
    localparam [13:0] EstimateCodeAt = 14'h0022;
    localparam [13:0] HistogramAt = 14'h1000;
    localparam [13:0] CodeDensityAt = 14'h2000;

    reg [31:0] scratch;
    reg dsp_en_asked;                     // dsp_en as the host has it, whatever frames are permitted
    reg free_running;
    reg [31:0] frames_permitted;
    reg [31:0] frames;
    reg [31:0] shots;
    reg [31:0] hits;
    reg calibrating_last;
    reg calibrated;                       // a calibration has ended, and none is under way
    reg hold;
    reg bank;                             // half of histogram_ram that takes a frame's words
    reg hist_valid_last;                  // the word that was being read a cycle ago: its way here is long
    reg [BinBits-1:0] hist_bin_last;
    reg [CountBits-1:0] hist_count_last;
    reg [31:0] frame;
    reg signed [35:0] frame_depth;
    reg [35:0] frame_sigma;
    reg [6:0] frame_status;
    reg frame_valid;
    reg [3:0] frame_code;
    reg clearing;                         // counts are set to zero
    reg [PlaceBits-1:0] clear_place;
    reg counting;                         // the count of counted_n is in counted
    reg [PlaceBits-1:0] counted_n;
    reg [31:0] counted;
    reg [31:0] density_hits;
    reg [31:0] register_word;             // of a register
    reg [CountBits-1:0] histogram_word;
    reg [31:0] density_word;
    reg in_histogram;                     // the address is one of a bin
    reg in_density;                       // it is one of an n
    reg [CountBits-1:0] histogram_ram [0:(2 << BinBits)-1];
    reg [31:0] density_ram [0:Taps];

    wire is_known = address[31:AddressBits] == {32 - AddressBits{1'b0}};
    wire writes = write_en && is_known;
    wire [AddressBits-1:0] place = address[AddressBits-1:0];
    wire [AddressBits-1:0] density_place = place - CodeDensityAt;
    wire is_density = is_known && place >= CodeDensityAt && density_place <= {{AddressBits - PlaceBits{1'b0}}, LastPlace};
    wire counts = n_valid && !clearing && density_hits != 32'hffffffff;
    wire [31:0] control_word =
        {23'd0, free_running, host_ring_on, rate_word, host_mode, host_dsp_rst, dsp_en_asked, host_laser_en};
    wire [31:0] status_word = {26'd0, interlock_sync, armed, pins_selected, acquire, calibrated, 1'b1};
    wire [31:0] fault_word = {27'd0, rate_too_high, pulse_too_long, interlocked, unlocked, host_silent};
    wire [63:0] depth_word = {{28{frame_depth[35]}}, frame_depth}, sigma_word = {28'd0, frame_sigma};

    reg [2:0] rate_word;
    always @* begin
        rate_word = 3'd0;
        rate_word[RateBits-1:0] = host_laser_freq;
    end

    integer word;
    initial begin
        {host_mode, host_laser_en, host_dsp_en, host_ring_on, dsp_en_asked, free_running, arm, disarm, hold, bank} = 10'd0;
        host_dsp_rst = 1'b1;
        host_laser_freq = {RateBits{1'b0}};
        {scratch, frames_permitted, frames, shots, hits, frame} = 192'd0;
        {calibrating_last, calibrated, frame_valid, clearing, counting, in_histogram, in_density} = 7'd0;
        {frame_depth, frame_sigma, frame_status, frame_code} = 83'd0;
        {clear_place, counted_n} = {2 * PlaceBits{1'b0}};
        {counted, density_hits, register_word, density_word, read_data} = 160'd0;
        hist_valid_last = 1'b0;
        hist_bin_last = {BinBits{1'b0}};
        {hist_count_last, histogram_word} = {2 * CountBits{1'b0}};
        for (word = 0; word < 2 << BinBits; word = word + 1) histogram_ram[word] = {CountBits{1'b0}};
        for (word = 0; word <= Taps; word = word + 1) density_ram[word] = 32'd0;
    end

    // What is read has no side effects, so that every cycle reads.
    always @(posedge clk_sys) begin
        in_histogram <= is_known && place[AddressBits-1:BinBits] == HistogramAt[AddressBits-1:BinBits];
        in_density <= is_density;
        histogram_word <= histogram_ram[{!bank, place[BinBits-1:0]}];
        if (is_density) density_word <= density_ram[density_place[PlaceBits-1:0]];
        register_word <= 32'd0;
        if (is_known) case (place)
            IdentityAt: register_word <= IdentityValue;
            MapVersionAt: register_word <= MapVersionValue;
            ParametersHashAt: register_word <= ParametersHash[63:32];
            ParametersHashAt + 14'd1: register_word <= ParametersHash[31:0];
            SystemHzAt: register_word <= SystemHz;
            HostTimeoutAt: register_word <= HostTimeout;
            ScratchAt: register_word <= scratch;
            ControlAt: register_word <= control_word;
            FramesPermittedAt: register_word <= frames_permitted;
            ArmAt: register_word <= {31'd0, armed};
            StatusAt: register_word <= status_word;
            LaserFaultsAt: register_word <= fault_word;
            FramesAt: register_word <= frames;
            ShotsAt: register_word <= shots;
            HitsAt: register_word <= hits;
            HoldAt: register_word <= {31'd0, hold};
            FrameAt: register_word <= frame;
            DepthAt: register_word <= depth_word[63:32];
            DepthAt + 14'd1: register_word <= depth_word[31:0];
            SigmaAt: register_word <= sigma_word[63:32];
            SigmaAt + 14'd1: register_word <= sigma_word[31:0];
            EstimateStatusAt: register_word <= {25'd0, frame_status};
            EstimateValidAt: register_word <= {31'd0, frame_valid};
            EstimateCodeAt: register_word <= {28'd0, frame_code};
            DensityClearAt: register_word <= {31'd0, clearing};
            DensityHitsAt: register_word <= density_hits;
            default: ;
        endcase
        read_data <= in_histogram ? {{32 - CountBits{1'b0}}, histogram_word} : in_density ? density_word : register_word;
    end

    always @(posedge clk_sys) begin
        hist_bin_last <= hist_bin;
        hist_count_last <= hist_count;
        if (hist_valid_last) histogram_ram[{bank, hist_bin_last}] <= hist_count_last;
        counted <= density_ram[n];
        counted_n <= n;
        if (clearing) density_ram[clear_place] <= 32'd0;
        else if (counting) density_ram[counted_n] <= counted + 32'd1;
    end

    always @(posedge clk_sys) begin
        arm <= writes && place == ArmAt && write_data == ArmKey;
        disarm <= writes && place == ArmAt && write_data != ArmKey;
        hist_valid_last <= hist_valid;
        calibrating_last <= calibrating;
        if (calibrating) calibrated <= 1'b0;
        else if (calibrating_last) calibrated <= 1'b1;
        counting <= counts;
        if (counts) density_hits <= density_hits + 32'd1;
        if (clearing) begin
            clear_place <= clear_place + 1'b1;
            clearing <= clear_place != LastPlace;
        end
        frames <= frames + {31'd0, frame_done};
        shots <= shots + {31'd0, start};
        hits <= hits + {31'd0, tdc_valid};
        host_dsp_en <= dsp_en_asked && (free_running || frames_permitted != 32'd0);
        if (frame_done && frames_permitted != 32'd0) frames_permitted <= frames_permitted - 32'd1;
        if (frame_done && !hold) begin
            bank <= !bank;
            frame <= frames + 32'd1;
            frame_depth <= depth;
            frame_sigma <= sigma;
            frame_status <= status;
            frame_valid <= valid;
            frame_code <= code;
        end
        if (writes) case (place)
            ScratchAt: scratch <= write_data;
            ControlAt: begin
                {host_mode, host_dsp_rst, dsp_en_asked, host_laser_en} <= write_data[3:0];
                host_laser_freq <= write_data[4 +: RateBits];
                {free_running, host_ring_on} <= write_data[8:7];
            end
            FramesPermittedAt: frames_permitted <= write_data;
            HoldAt: hold <= write_data[0];
            DensityClearAt: if (write_data[0]) begin
                clearing <= 1'b1;
                clear_place <= {PlaceBits{1'b0}};
                density_hits <= 32'd0;
            end
            default: ;
        endcase
        if (rst) begin
            {host_mode, host_laser_en, host_dsp_en, host_ring_on, dsp_en_asked, free_running, arm, disarm, hold} <= 9'd0;
            host_dsp_rst <= 1'b1;
            host_laser_freq <= {RateBits{1'b0}};
            {scratch, frames_permitted, frames, shots, hits, frame} <= 192'd0;
            {hist_valid_last, calibrating_last, calibrated, clearing, counting} <= 5'd0;
            density_hits <= 32'd0;
        end
    end
endmodule
