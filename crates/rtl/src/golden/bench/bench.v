// Golden vectors for {name} by tofsim {version}: scenario {source}, seed {seed}.
// Line k of stimulus.mem is taken by edge k, line k of expected.mem seen just before it.
// Define REGISTERS to compare registers inside too; +from_power_up compares before the first reset
// too; +got=FILE writes what was seen, +progress how far it is; +first ends it at a mismatch.
`timescale 1ps/1fs
`default_nettype none

module tb_{name};
  localparam Cycles = {cycles};
  localparam [63:0] FirstEdge = 64'd{first_edge}; // [fs]
  localparam [63:0] Period = 64'd{period}; // [fs]

{signals}
  {module} {parameters}dut (
{ports}
  );

  reg {line_in}stimulus [0:Cycles-1];
  reg {line_out}expected [0:Cycles-1];
  reg {line_out}got;
  reg {line_out}want;
  integer cycle;
  integer mismatches = 0;
  integer quiet = {quiet};  // lines not compared yet; below 0: until a reset
  reg first_only = 1'b0;
  integer got_file = 0;
  reg [8191:0] got_name;
{looks}
  task compare;
  begin
{allowances}    if (quiet == 0 && (got !== want || past !== 1'b0)) begin
      if (mismatches == 0) show;
      mismatches = mismatches + 1;
    end
    if (got_file != 0) $fdisplay(got_file, {got});
    if (quiet > 0) quiet = quiet - 1;
{resets}  end
  endtask

  task show;
  begin
{show}  end
  endtask

  initial begin
    $readmemh("stimulus.mem", stimulus);
    $readmemh("expected.mem", expected);
    if ($value$plusargs("got=%s", got_name)) got_file = $fopen(got_name, "w");
    if ($test$plusargs("from_power_up")) quiet = 0;
    first_only = $test$plusargs("first");
{before}    for (cycle = 0; cycle < Cycles && !(first_only && mismatches != 0); cycle = cycle + 1) begin
      if (cycle % {beat} == 0 && $test$plusargs("progress")) begin
        $display("cycle %0d", cycle);
        $fflush;
      end
      want = expected[cycle];
      got = want;
{steps}    end
    if (got_file != 0) $fclose(got_file);
    if (mismatches == 0) begin
      $display("tb_{name}: PASS, %0d cycles, 0 mismatches", Cycles);
      $finish;
    end else begin
      $display("tb_{name}: FAIL, %0d cycles, %0d mismatches", cycle, mismatches);
      $fatal(1, "tb_{name}: %0d mismatches", mismatches);
    end
  end
endmodule

`default_nettype wire
