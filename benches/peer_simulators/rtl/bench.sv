`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// The device with its photons and clocks, for Verilator: one evaluation runs all frames. The
// harness sets photons, shots and frames, then inverts tof_top.pll.clk_250, which sets it off.
module bench (
    input wire [1:0] laser_freq
);
    localparam [63:0] Never = 64'h4000000000000000;

    reg [63:0] photons [0:65535] /* verilator public_flat_rw */;  // from the laser edge [fs]
    reg [7:0] frames /* verilator public_flat_rw */;              // to run
    reg [35:0] depths [0:255] /* verilator public_flat_rd */;     // of each frame
    reg [15:0] shots [0:255] /* verilator public_flat_rd */;      // of each frame
    reg [63:0] ends [0:255] /* verilator public_flat_rd */;       // edge of algo_done
    reg [7:0] done;          // frames
    reg [63:0] cycle;        // edges of clk_125
    reg [15:0] shot;         // in this frame
    reg [63:0] avalanche_at; // [fs]

    wire spad_rst, laser_on, algo_done;
    wire signed [35:0] depth;

    initial begin
        {frames, done, shot} = 32'd0;
        cycle = 64'd0;
        avalanche_at = Never;
    end

    wire stop = done == frames;
    wire [63:0] edge_at = tof_top.pll.edge_at;
    wire tdc_stop = !spad_rst && avalanche_at <= edge_at;
    // When tdc_stop changed, if it has since the last edge: then spad_rst rose.
    wire [63:0] stop_at = tdc_stop ? avalanche_at : edge_at - 64'd8000000;

    always @(edge tof_top.clk_125 or edge tof_top.clk_250) begin
        if (laser_on) begin
            avalanche_at <= edge_at + photons[shot];
            shot <= shot + 16'd1;
        end else if (spad_rst) begin
            avalanche_at <= Never;
        end else if (algo_done) begin
            shot <= 16'd0;
        end
    end

    always @(edge tof_top.clk_125) begin
        cycle <= cycle + 64'd1;
        if (algo_done) begin
            depths[done] <= depth;
            shots[done] <= shot;
            ends[done] <= cycle - 64'd1;  // it rose at the edge before
            done <= done + 8'd1;
        end
    end

    tof_top tof_top (
        .clk_200(1'b0),
        .rst(1'b0),
        .locked(),
        .laser_on_lvds_p(laser_on),
        .laser_on_lvds_n(),
        .tdc_stop(tdc_stop),
        .spad_rst(spad_rst),
        .spad_sel(),
        .mode(1'b0),
        .laser_freq(laser_freq),
        .laser_en(1'b1),
        .dsp_en(1'b1),
        .dsp_rst(1'b0),
        .depth(depth),
        .algo_done(algo_done),
        .hist_valid(),
        .hist_bin(),
        .hist_count(),
        .frame_done()
    );
endmodule
