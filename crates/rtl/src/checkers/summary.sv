
// Prints at the end of a simulation how often each block was compared, and makes it fail if one that has a checker never
// was: a simulator may ignore a `bind` to a module that is not there. In tofsim_bind.sv it is bound to the bench.
module tofsim_summary;
  import tofsim_pkg::*;
  int missing;

  function automatic void tofsim_ran(input string block);
    longint compared = tofsim_get_num_compared(block);
    if (compared > 0) $display("tofsim: %s: compared %0d times", block, compared);
    else $display("tofsim: %s: never compared: no such module in the design, or its clock or its reset never came", block);
    missing += int'(compared == 0);
  endfunction

  final begin
{ran}
    if (missing != 0) $fatal(1, "tofsim: %0d of {count} checkers compared nothing", missing);
  end
endmodule
