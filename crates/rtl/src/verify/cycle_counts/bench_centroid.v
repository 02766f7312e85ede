    centroid_estimator `CENTROID dut (
        .clk_sys(clk_sys),
        .rst(rst),
        .algo_start(algo_start),
        .count(count),
        .algo_done(algo_done)
    );

    task look;
        begin
        end
    endtask

    task report;
        if (algo_done === 1'b1) $display("count centroid_latency %0d", k);
    endtask
