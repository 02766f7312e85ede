
    // Each cycle is looked at in its middle, where the inputs of the next edge are set.
    task edge_with(input start);
        begin
            algo_start = start;
            #4000 clk_sys = 1'b1;
            #4000 clk_sys = 1'b0;
        end
    endtask

    // From the edge that takes a start to algo_done, or for longer than any estimation takes.
    task estimation(input hold);
        begin
            k = -1;
            while (k < 8000 + 32 * `BINS && (k < 0 || algo_done !== 1'b1)) begin
                edge_with(k < 0 || hold);
                k = k + 1;
                look;
            end
            report;
        end
    endtask

    initial begin
        repeat (3) edge_with(1'b0);
        rst = 1'b0;
        repeat (3) edge_with(1'b0);
        estimation(1'b0);
        repeat (3) edge_with(1'b0);
        count = 16'd65535;
        estimation(1'b1);
        count = 16'd40;
        estimation(1'b1);
        $finish;
    end
endmodule
