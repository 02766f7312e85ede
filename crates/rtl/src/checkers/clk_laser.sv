  always @(negedge clk_laser) tofsim_check(3);
  always @(posedge clk_laser) tofsim_check(1);
