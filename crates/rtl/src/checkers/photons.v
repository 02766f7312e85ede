
// The target, its light and the detector, as the module of that name in SystemVerilog.
module tofsim_photons #(
    parameter Settles = 1  // from an edge of clk_sys until its registers have their values [fs]
) (
    input clk_sys,
    input start,
    input laser_on,
    input spad_rst,
    input mode,
    input ring_on,
    input frame_done,
    output reg tdc_stop = 1'b0
);
  reg [63:0] photons, now, lit = 64'd0;
  reg signed [63:0] due;
  integer asked = 0, served = 0;

  initial begin
    photons = $tofsim_photons_new(`TOFSIM_VERSION, `TOFSIM_SCENARIO);
    if (photons == 64'd0) begin
      $tofsim_report(64'd0);
      $fatal(1, "tofsim: no photons");
    end
    asked = 1;
  end

  always @(posedge laser_on) lit = $time;

  always @(posedge clk_sys) begin
    now = $time;
    #(Settles);
    $tofsim_photons_edge(photons, now, start, laser_on && lit >= now, spad_rst, mode, ring_on, frame_done);
    tdc_stop = $tofsim_photons_level(photons) != 0;
    asked = asked + 1;
  end

  // What comes before the next edge.
  initial
    forever begin
      wait (asked != served);
      served = asked;
      $tofsim_photons_next(photons, due);
      while (due >= 0) begin
        if (due > $time) #(due - $time);
        tdc_stop = $tofsim_photons_level(photons) != 0;
        $tofsim_photons_next(photons, due);
      end
    end
endmodule
