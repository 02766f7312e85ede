    wire ctrl_done, forward1_en, tansig_en, forward2_en;

    depth_estimator `NETWORK dut (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .count(count),
        .algo_done(algo_done)
    );

    estimator_ctrl `NETWORK estimator_ctrl (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .algo_done(ctrl_done),
        .forward1_en(forward1_en),
        .tansig_en(tansig_en),
        .forward2_en(forward2_en)
    );

    integer forward1, tansig, forward2;

    task look;
        begin
            if (k == 0) {forward1, tansig, forward2} = 96'd0;
            if (forward1_en === 1'b1) forward1 = forward1 + 1;
            if (tansig_en === 1'b1) tansig = tansig + 1;
            if (forward2_en === 1'b1) forward2 = forward2 + 1;
        end
    endtask

    task report;
        begin
            if (algo_done === 1'b1) $display("count latency %0d", k);
            $display("count forward1_cycles %0d", forward1);
            $display("count tansig_cycles %0d", tansig);
            $display("count forward2_cycles %0d", forward2);
        end
    endtask
