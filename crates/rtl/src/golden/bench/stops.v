
  reg [63:0] tdc_stop_at [0:{last}]; // [fs]
  reg [63:0] now;
  integer change;
  initial begin
    $readmemh("tdc_stop.mem", tdc_stop_at);
    now = 64'd0;
    for (change = 0; change <= {last}; change = change + 1) begin
      while (tdc_stop_at[change] - now > 64'd1000000000) begin
        #1000000 now = now + 64'd1000000000;
      end
      #((tdc_stop_at[change] - now + 0.2) / 1000.0) tdc_stop = !tdc_stop;
      now = tdc_stop_at[change];
    end
  end
