`timescale 1ps / 1fs
`default_nettype none

// Resets the SPADs before each shot and selects a row of the array.
module spad_control #(
    parameter integer Rows = 1   // of the array, 1 to 40
) (
    input wire clk_sys,
    input wire rst,
    input wire mode,             // quench mode: 0 reset by the firmware, 1 by the SPAD itself
    input wire pre_start,        // two cycles before the laser edge
    // frame_ctrl
    // verilator lint_off UNUSEDSIGNAL
    input wire [5:0] row,        // row that acquires
    // verilator lint_on UNUSEDSIGNAL
    // SPAD array
    output reg spad_rst,         // recharges the SPAD and keeps it off
    output reg [39:0] spad_sel   // row of the array, one-hot
);
    reg spad_rst_next;
    reg [39:0] spad_sel_next;

    initial begin
        spad_rst = 1'b0;
        spad_sel = 40'd1;
    end

    always @* begin
        spad_rst_next = pre_start && !mode;
        spad_sel_next = Rows > 1 ? 40'd1 << row : 40'd1;
    end

    always @(posedge clk_sys) begin
        if (rst) begin
            spad_rst <= 1'b0;
            spad_sel <= 40'd1;
        end else begin
            spad_rst <= spad_rst_next;
            spad_sel <= spad_sel_next;
        end
    end
endmodule
