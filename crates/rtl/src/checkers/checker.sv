
// Compares the outputs of {name} with those of the model just before each edge. It compares from the first reset on, or
// with +tofsim_from_power_up from the first edge; a mismatch ends the simulation, unless +tofsim_go_on is given.
module tofsim_{name} #(
{widths}
) (
{ports}
);
  import tofsim_pkg::*;

  chandle tofsim_model;
  bit tofsim_begun, tofsim_stays;
  string tofsim_path = $sformatf("%m");

  function automatic void tofsim_report(input string what);
    for (int n = 0; n < tofsim_get_num_errors(tofsim_model); n++)
      $display("%s: %s", tofsim_path, tofsim_get_error(tofsim_model, n));
    tofsim_clear_errors(tofsim_model);
    if (!tofsim_stays) $fatal(1, "tofsim: {name} %s", what);
  endfunction

  function automatic void tofsim_check_ports();
    int wrong = 0;
{checks}
    if (wrong != 0) tofsim_report("does not fit the scenario");
  endfunction

  function automatic void tofsim_start();
    tofsim_begun = 1;
    tofsim_model = tofsim_new(Version, Scenario, "{name}");
    if (tofsim_model == null) $fatal(1, "%s: %s", tofsim_path, tofsim_get_error(null, tofsim_get_num_errors(null) - 1));
    tofsim_check_ports();
    tofsim_stays = $test$plusargs("tofsim_go_on") != 0;
    if ($test$plusargs("tofsim_from_power_up") != 0) tofsim_from_power_up(tofsim_model);
  endfunction

  function automatic void tofsim_check(input int what);
    if (!tofsim_begun) tofsim_start();
    if (tofsim_step(tofsim_model, what, longint'($time), {inputs},
                    {outputs}) == 0) tofsim_report("is not as the model has it");
  endfunction

  initial if (!tofsim_begun) tofsim_start();
{stops}{edges}endmodule
