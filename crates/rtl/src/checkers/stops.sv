  always @(tdc_stop) begin
    if (!tofsim_begun) tofsim_start();
    tofsim_stop(tofsim_model, longint'($time), int'(tdc_stop));
  end
