
  reg [63:0] column_stops [0:{last}]; // bit, 8 bits, and instant [fs]
  reg [63:0] column_stop_at, column_now;
  integer column_change;
  initial begin
    $readmemh("column_stop.mem", column_stops);
    column_now = 64'd0;
    for (column_change = 0; column_change <= {last}; column_change = column_change + 1) begin
      column_stop_at = {{8'd0, column_stops[column_change][55:0]}};
      while (column_stop_at - column_now > 64'd1000000000) begin
        #1000000 column_now = column_now + 64'd1000000000;
      end
      // As a whole, because Verilator 5.006 does not see that a bit of it changes here.
      #((column_stop_at - column_now + 0.2) / 1000.0)
      column_stop = column_stop ^ ({width}'d1 << column_stops[column_change][61:56]);
      column_now = column_stop_at;
    end
  end
