`timescale 1fs / 1fs

// The target, its light and the detector of scenario {name}: tdc_stop for a design that fires the laser and holds the
// SPAD. Its statistics are the simulator's, and with firmware that does as the model does its photons are, too.
module tofsim_photons #(
    parameter longint Settles = 1  // from an edge of clk_sys until its registers have their values [fs]
) (
    input bit clk_sys,
    input bit start,       // a shot begins
    input bit laser_on,    // the laser pulse
    input bit spad_rst,    // recharges the SPAD and keeps it off
    input bit mode,        // SPAD quench mode, as the SPAD has it
    input bit ring_on,     // tdc_stop is to come from a ring oscillator
    input bit frame_done,  // the frame has ended; one cycle
    output bit tdc_stop
);
  // In Verilator 5.006 the delays of a module that is inlined are those of the module around it.
  /* verilator no_inline_module */
  import tofsim_pkg::*;

  chandle photons;
  longint now, due, lit;
  int asked, served;

  initial begin
    photons = tofsim_photons_new(Version, Scenario);
    if (photons == null) $fatal(1, "%m: %s", tofsim_get_error(null, tofsim_get_num_errors(null) - 1));
    asked = 1;
  end

  always @(posedge laser_on) lit = longint'($time);

  always @(posedge clk_sys) begin
    now = longint'($time);
    #(Settles);
    tofsim_photons_edge(photons, now, int'(start), int'(laser_on && lit >= now), int'(spad_rst), int'(mode),
                        int'(ring_on), int'(frame_done));
    if (tofsim_get_num_errors(photons) != 0) $fatal(1, "%m: %s", tofsim_get_error(photons, 0));
    tdc_stop = tofsim_photons_level(photons) != 0;
    asked = asked + 1;
  end

  // What comes before the next edge.
  initial
    forever begin
      wait (asked != served);
      served = asked;
      due = tofsim_photons_next(photons);
      while (due >= 0) begin
        if (due > longint'($time)) #(due - longint'($time));
        tdc_stop = tofsim_photons_level(photons) != 0;
        due = tofsim_photons_next(photons);
      end
    end
endmodule
