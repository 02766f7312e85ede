`timescale 1ps / 1fs
`default_nettype none

// Prints the cycles of rows and of an image, and those from the fall of acquire to the last depth of a row.
module bench_scan;
    reg clk_sys = 1'b0, rst = 1'b1;
    wire acquire, clear, algo_start;
    wire [$clog2(`BINS)-1:0] clear_addr;
    wire [5:0] row, depth_row, depth_column;
    integer since = 0, working = 0;
    wire start = acquire && since == `PERIOD;
    wire algo_done = working == `ESTIMATE + 1;

    frame_ctrl #(
        .BinBits($clog2(`BINS)),
        .ShotsPerFrame(`SHOTS),
        .DrainCycles(`DRAIN),
        .Rows(`ROWS),
        .Columns(`COLUMNS),
        .Banks(`BANKS)
    ) dut (
        .clk_sys(clk_sys),
        .rst(rst),
        .start(start),
        .acquire(acquire),
        .dsp_rst(1'b0),
        .dsp_en(1'b1),
        .calibrating(1'b0),
        .clear(clear),
        .clear_addr(clear_addr),
        .depth_column(depth_column),
        .row(row),
        .depth_row(depth_row),
        .algo_start(algo_start),
        .algo_done(algo_done)
    );

    integer k = 0, rows = 0, row_at = 0, image_at = 0, image_row = 0, ended = 0, handed = 0;
    reg acquired = 1'b0;

    // Each cycle is looked at in its middle, in which the next edge takes the inputs.
    always @(negedge clk_sys) if (!rst) begin
        if (clear && clear_addr == 0) begin
            // With two banks the first row waits for no other.
            if (rows > 1) $display("count row_cycles %0d", k - row_at);
            if (rows == 1) {image_at, image_row} = {k, 26'd0, row};
            if (rows == `ROWS + 1) begin
                $display("count image_cycles %0d", row == image_row ? k - image_at : 0);
                $finish;
            end
            row_at = k;
            rows = rows + 1;
        end
        if (acquired && !acquire) ended = k;
        acquired = acquire;
        if (algo_start && depth_column == 0) handed = ended;
        if (algo_done && depth_column == `COLUMNS - 1 && (`BANKS == 1 || rows > 2))
            $display("count depth_latency %0d", k - handed);
        k = k + 1;
    end

    always @(posedge clk_sys) begin
        since <= !acquire ? 0 : start ? 1 : since + 1;
        working <= rst || algo_done ? 0 : algo_start || working != 0 ? working + 1 : 0;
    end

    initial begin
        repeat (3) begin
            #4000 clk_sys = 1'b1;
            #4000 clk_sys = 1'b0;
        end
        rst = 1'b0;
        repeat (`ROWS * `ROW + 3 * `ROW) begin
            #4000 clk_sys = 1'b1;
            #4000 clk_sys = 1'b0;
        end
        $finish;
    end
endmodule
