// tofsim {version}, scenario {name}: what its checkers and photons import. `tofsim dpi` wrote it.
package tofsim_pkg;
  localparam string Version = "{version}";
  // The scenario, and a line for each key that was set.
  localparam string Scenario = "{scenario}";

  // A block of the model; null if there is none, and the last error of null says why.
  import "DPI-C" function chandle tofsim_new(input string version, input string scenario, input string block);
  import "DPI-C" function int tofsim_port(input chandle model, input string name, input int bits);
  import "DPI-C" function void tofsim_from_power_up(input chandle model);
  import "DPI-C" function void tofsim_stop(input chandle model, input longint time_fs, input int level);
  // An edge: 1 of the block's clock, 2 of clk_laser alone, 3 its fall, 0 a look without one. 0 if outputs differ.
  import "DPI-C" function int tofsim_step(input chandle model, input int what, input longint time_fs,
                                          input {inputs} inputs, input {outputs} outputs);
  // How often the outputs of a block have been compared so far.
  import "DPI-C" function longint tofsim_get_num_compared(input string block);
  // The model's outputs before an edge, for a bench that wants them.
  import "DPI-C" function int tofsim_outputs(input chandle model, input longint time_fs,
                                             input {inputs} inputs, output {outputs} outputs);

  import "DPI-C" function chandle tofsim_photons_new(input string version, input string scenario);
  import "DPI-C" function void tofsim_photons_edge(input chandle photons, input longint time_fs, input int start,
                                                   input int laser, input int spad_rst, input int mode,
                                                   input int ring_on, input int frame_done);
  // When tdc_stop changes next before the coming edge or on it [fs], or -1.
  import "DPI-C" function longint tofsim_photons_next(input chandle photons);
  import "DPI-C" function int tofsim_photons_level(input chandle photons);

  import "DPI-C" function int tofsim_get_num_errors(input chandle handle);
  import "DPI-C" function string tofsim_get_error(input chandle handle, input int number);
  import "DPI-C" function void tofsim_clear_errors(input chandle handle);
  import "DPI-C" function void tofsim_delete(input chandle handle);
  import "DPI-C" function string tofsim_version();
endpackage
