  // In Verilator 5.006 the delays of a module that is inlined are those of the module around it.
  /* verilator no_inline_module */
  // A look 1 ps before the end of each part of a cycle of clk_sys.
  localparam longint Cycle = {cycle};  // [fs]
  longint tofsim_look;
  initial
    forever begin
      tofsim_look = tofsim_look + 1;
      #(tofsim_look * Cycle / {looks} - 1000 - longint'($time));
      tofsim_check(tofsim_look % {looks} == 0 ? 1 : 0);
    end
