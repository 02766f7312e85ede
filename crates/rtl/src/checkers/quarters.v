  // A look 1 ps before the end of each part of a cycle of clk_sys.
  localparam [63:0] Cycle = 64'd{cycle};  // [fs]
  reg [63:0] tofsim_look = 64'd0;
  initial
    forever begin
      tofsim_look = tofsim_look + 1;
      #(tofsim_look * Cycle / {looks} - 1000 - $time);
      tofsim_check(tofsim_look % {looks} == 0 ? 1 : 0);
    end
