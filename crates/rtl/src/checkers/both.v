  reg tofsim_middle = 1'b0;
  always @(negedge clk_laser) begin
    tofsim_middle = clk_sys;
    tofsim_check(3);
  end
  always @(posedge clk_laser) tofsim_check(tofsim_middle ? 2 : 1);
