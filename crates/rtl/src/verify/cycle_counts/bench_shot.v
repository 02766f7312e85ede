`timescale 1ps / 1fs
`default_nettype none

// Prints the laser's and the SPAD reset's cycle counts and the pulse's times, for each of `CODES codes and
// either mode, from five shots each.
module bench_shot;
    reg clk_sys = 1'b0, clk_laser = 1'b0, rst = 1'b1, acquire = 1'b0, mode = 1'b0;
    reg [`RATE_BITS-1:0] laser_freq = 0;
    wire pre_start, start, laser_on, spad_rst;

    vcsel_driver `LASER vcsel_driver (
        .clk_sys(clk_sys),
        .clk_laser(clk_laser),
        .rst(rst),
        .rst_laser(rst),
        .acquire(acquire),
        .laser_en(1'b1),
        .laser_freq(laser_freq),
        .pre_start(pre_start),
        .start(start),
        .laser_on(laser_on)
    );

    spad_control spad_control (
        .clk_sys(clk_sys),
        .rst(rst),
        .mode(mode),
        .pre_start(pre_start),
        .spad_rst(spad_rst)
    );

    // In cycles since acquire rose; each is looked at in its middle.
    integer k, shots, start_at, pre_start_at, spad_rst_at, spad_rst_cycles;

    task look;
        begin
            if (pre_start === 1'b1) pre_start_at = k;
            if (spad_rst === 1'b1) begin
                spad_rst_at = k;
                spad_rst_cycles = spad_rst_cycles + 1;
            end
            if (start === 1'b1) begin
                if (shots == 0) $display("count first_shot_%0d %0d", laser_freq, k);
                else $display("count laser_period_%0d %0d", laser_freq, k - start_at);
                $display("count pre_start_lead %0d", k - pre_start_at);
                if (mode) $display("count spad_rst_mode_1 %0d", spad_rst_cycles);
                else begin
                    $display("count spad_rst_lead %0d", k - spad_rst_at);
                    $display("count spad_rst_width %0d", spad_rst_cycles);
                end
                shots = shots + 1;
                start_at = k;
                spad_rst_cycles = 0;
            end
        end
    endtask

    task cycle;
        begin
            {clk_sys, clk_laser} = 2'b11;
            #`HALF clk_laser = 1'b0;
            #`HALF {clk_sys, clk_laser} = 2'b01;
            look;
            k = k + 1;
            #`HALF clk_laser = 1'b0;
            #`HALF;
        end
    endtask

    time laser_on_at, start_rose_at;
    always @(posedge start) start_rose_at = $time;
    always @(posedge laser_on) laser_on_at = $time;
    always @(negedge laser_on) if (!rst) begin
        $display("count laser_on_width %0d", $time - laser_on_at);
        $display("count laser_on_lag %0d", laser_on_at - start_rose_at);
    end

    integer setting;
    initial begin
        for (setting = 0; setting < 2 * `CODES; setting = setting + 1) begin
            mode = setting >= `CODES;
            laser_freq = setting % `CODES;
            {rst, acquire} = 2'b10;
            repeat (3) cycle;
            rst = 1'b0;
            repeat (3) cycle;
            // The cycle that the last edge began is cycle 0 of acquire.
            acquire = 1'b1;
            k = 1;
            {shots, start_at, pre_start_at, spad_rst_at, spad_rst_cycles} = 160'd0;
            while (k < `PATIENCE && shots < 5) cycle;
        end
        $finish;
    end
endmodule
