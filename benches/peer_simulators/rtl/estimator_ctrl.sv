`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// Sleeps while it is idle: then all its registers are 0.
module estimator_ctrl (
    input wire clk_125,
    input wire rst,
    input wire algo_start,
    output reg algo_done,
    output reg read_en,
    output reg [7:0] read_addr,
    output reg [8:0] rom_addr,
    output reg forward1_en,
    output reg tansig_en,
    output reg forward2_en,
    output reg [3:0] neuron
);
    localparam [8:0] Bias1 = 9'd256, Tansig = 9'd257, Neuron0 = 9'd258, Bias2 = 9'd266;

    reg busy;
    reg [8:0] step;

    initial begin
        {algo_done, read_en, forward1_en, tansig_en, forward2_en, busy} = 6'd0;
        read_addr = 8'd0;
        {rom_addr, step} = 18'd0;
        neuron = 4'd0;
    end

    // verilator tracing_off
    always @(`RISE_AWAKE) if (rst || busy || algo_start || algo_done) begin : work
        reg busy_next;
        reg [8:0] step_next;
        busy_next = busy ? step != Bias2 : algo_start;
        step_next = busy && busy_next ? step + 9'd1 : 9'd0;
        {algo_done, read_en, forward1_en, tansig_en, forward2_en, busy} <= 6'd0;
        read_addr <= 8'd0;
        {rom_addr, step} <= 18'd0;
        neuron <= 4'd0;
        if (!rst) begin
            busy <= busy_next;
            step <= step_next;
            if (busy_next) begin
                forward1_en <= step_next <= Bias1;
                tansig_en <= step_next == Tansig;
                if (step_next < Bias1) begin
                    read_en <= 1'b1;
                    read_addr <= step_next[7:0];
                    rom_addr <= step_next + 9'd1;
                end
                if (step_next >= Neuron0) begin
                    forward2_en <= 1'b1;
                    neuron <= step_next[3:0] - Neuron0[3:0];
                end
            end else if (busy) begin
                algo_done <= 1'b1;
                forward2_en <= 1'b1;
                neuron <= 4'd9;
            end
        end
    end
    // verilator tracing_on
endmodule
