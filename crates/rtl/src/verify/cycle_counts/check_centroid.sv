    (* hierconn *) wire \dut.busy ;
    (* hierconn *) wire [$clog2(`LATENCY)-1:0] \dut.step ;

    centroid_estimator `CENTROID dut (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .count(count),
        .algo_done(algo_done)
    );

    wire centroid_latency = algo_done == done;

    wire in_step = \dut.busy == under_way
        && \dut.step == (under_way ? k : 16'd0)
        && k <= Latency && (under_way || done || k == 16'd0) && done == (k == Latency);
