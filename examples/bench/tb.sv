`timescale 1ps / 1fs

// The reference design with photons of the simulator's: frames to their depth. docs/bench.md runs it.
module tb;
  parameter int Shots = 300;
  parameter int Frames = 1;

  bit clk_in, rst;
  wire tdc_stop, ring_on, spad_rst, laser_on_p, algo_done, frame_done;
  wire signed [35:0] depth;
  int frame;

  tof_top #(
      .ShotsPerFrame(Shots)
  ) dut (
      .clk_in(clk_in),
      .rst(rst),
      .locked(),
      .laser_on_lvds_p(laser_on_p),
      .laser_on_lvds_n(),
      .tdc_stop(tdc_stop),
      .ring_on(ring_on),
      .spad_rst(spad_rst),
      .spad_sel(),
      .mode(1'b0),
      .laser_freq(2'd3),
      .laser_en(1'b1),
      .dsp_en(1'b1),
      .dsp_rst(1'b0),
      .depth(depth),
      .sigma(),
      .status(),
      .valid(),
      .algo_done(algo_done),
      .hist_valid(),
      .hist_bin(),
      .hist_count(),
      .frame_done(frame_done)
  );

  tofsim_photons photons (
      .clk_sys(dut.clk_sys),
      .start(dut.start),
      .laser_on(laser_on_p),
      .spad_rst(spad_rst),
      .mode(dut.mode_sync),
      .ring_on(ring_on),
      .frame_done(frame_done),
      .tdc_stop(tdc_stop)
  );

  always #2500 clk_in = !clk_in;

  always @(posedge dut.clk_sys)
    if (frame_done) begin
      $display("frame %0d: depth %0d", frame, depth);
      frame = frame + 1;
      if (frame == Frames) $finish;
    end
endmodule
