  // Whether clk_laser rises next in the middle of a cycle: clk_sys itself may change with it.
  bit tofsim_middle;
  always @(negedge clk_laser) begin
    tofsim_middle = clk_sys;
    tofsim_check(3);
  end
  always @(posedge clk_laser) tofsim_check(tofsim_middle ? 2 : 1);
