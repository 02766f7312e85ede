
// Compares the outputs of {name} with those of the model just before each edge, as the module of that name in
// SystemVerilog does.
module tofsim_{name} (
{ports}
);
  // Icarus gives no numbers of $time itself.
  reg [63:0] tofsim_model, tofsim_now;
  reg tofsim_begun = 1'b0, tofsim_stays;
  reg [{high_in}:0] tofsim_inputs;
  reg [{high_out}:0] tofsim_outputs;

  task tofsim_start;
    begin
      tofsim_begun = 1'b1;
      tofsim_model = $tofsim_new(`TOFSIM_VERSION, `TOFSIM_SCENARIO, "{name}");
      if (tofsim_model == 64'd0) begin
        $tofsim_report(64'd0);
        $fatal(1, "tofsim: {name} has no model");
      end
      tofsim_stays = $test$plusargs("tofsim_go_on");
      if ($test$plusargs("tofsim_from_power_up")) $tofsim_from_power_up(tofsim_model);
    end
  endtask

  task tofsim_check(input integer what);
    begin
      if (!tofsim_begun) tofsim_start;
      tofsim_now = $time;
      tofsim_inputs = {inputs};
      tofsim_outputs = {outputs};
      // At power-up signals change from x.
      if (tofsim_now != 0)
        if ($tofsim_step(tofsim_model, what, tofsim_now, tofsim_inputs, tofsim_outputs) == 0) begin
        $tofsim_report(tofsim_model);
        if (!tofsim_stays) $fatal(1, "tofsim: {name} is not as the model has it");
      end
    end
  endtask

  initial if (!tofsim_begun) tofsim_start;
{stops}{edges}endmodule
