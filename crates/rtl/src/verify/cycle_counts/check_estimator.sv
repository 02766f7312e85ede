    parameter Forward1 = `BINS;               // cycles of forward1_en, from e2 on
    parameter Tansig = 1;                     // cycles of tansig_en, from e(BINS + 2) on
    parameter Forward2 = (`NEURONS + 1) / 2;  // cycles of forward2_en, from e(BINS + 6) on

    (* hierconn *) wire \dut.estimator_ctrl.busy ;
    (* hierconn *) wire [$clog2(`LATENCY)-1:0] \dut.estimator_ctrl.step ;
    (* hierconn *) wire \dut.estimator_ctrl.forward1_en ;
    (* hierconn *) wire \dut.estimator_ctrl.tansig_en ;
    (* hierconn *) wire \dut.estimator_ctrl.forward2_en ;

    depth_estimator `NETWORK dut (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .count(count),
        .algo_done(algo_done)
    );

    wire shown = under_way || done;
    wire latency = algo_done == done;
    wire forward1_cycles =
        \dut.estimator_ctrl.forward1_en == (shown && k >= 2 && k < 2 + Forward1);
    wire tansig_cycles =
        \dut.estimator_ctrl.tansig_en == (shown && k >= `BINS + 2 && k < `BINS + 2 + Tansig);
    wire forward2_cycles =
        \dut.estimator_ctrl.forward2_en == (shown && k >= `BINS + 6 && k < `BINS + 6 + Forward2);

    wire in_step = \dut.estimator_ctrl.busy == under_way
        && \dut.estimator_ctrl.step == (under_way ? k : 16'd0)
        && k <= Latency && (shown || k == 16'd0) && done == (k == Latency);
