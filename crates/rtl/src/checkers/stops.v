  always @(tdc_stop) begin
    if (!tofsim_begun) tofsim_start;
    tofsim_now = $time;
    $tofsim_stop(tofsim_model, tofsim_now, tdc_stop);
  end
