`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// Fetches a row only when the address has changed, and multiplies only when it accumulates.
module forward1 #(
    parameter W1File = "rtl_ref/w1.mem",
    parameter B1File = "rtl_ref/b1.mem"
) (
    input wire clk_125,
    input wire rst,
    input wire forward1_en,
    input wire read_en,
    input wire [7:0] read_addr,
    input wire [8:0] rom_addr,
    input wire [15:0] count,
    output reg signed [35:0] l1_in_0,
    output reg signed [35:0] l1_in_1,
    output reg signed [35:0] l1_in_2,
    output reg signed [35:0] l1_in_3,
    output reg signed [35:0] l1_in_4,
    output reg signed [35:0] l1_in_5,
    output reg signed [35:0] l1_in_6,
    output reg signed [35:0] l1_in_7
);
    reg signed [15:0] weight_0, weight_1, weight_2, weight_3;
    reg signed [15:0] weight_4, weight_5, weight_6, weight_7;

    // verilator tracing_off
    reg [8:0] fetched;  // the row in the weights; 511: none

    reg [127:0] rom [0:256];
    initial begin
        $readmemh(W1File, rom, 0, 255);
        $readmemh(B1File, rom, 256, 256);
        fetched = 9'd511;
        {weight_0, weight_1, weight_2, weight_3} = 64'd0;
        {weight_4, weight_5, weight_6, weight_7} = 64'd0;
        l1_in_0 = 36'sd0;
        l1_in_1 = 36'sd0;
        l1_in_2 = 36'sd0;
        l1_in_3 = 36'sd0;
        l1_in_4 = 36'sd0;
        l1_in_5 = 36'sd0;
        l1_in_6 = 36'sd0;
        l1_in_7 = 36'sd0;
    end

    always @(`RISE_AWAKE) if (rst || forward1_en || rom_addr != fetched) begin : work
        reg signed [16:0] operand;
        reg first;
        if (rst) begin
            fetched <= 9'd511;
            {weight_0, weight_1, weight_2, weight_3} <= 64'd0;
            {weight_4, weight_5, weight_6, weight_7} <= 64'd0;
            l1_in_0 <= 36'sd0;
            l1_in_1 <= 36'sd0;
            l1_in_2 <= 36'sd0;
            l1_in_3 <= 36'sd0;
            l1_in_4 <= 36'sd0;
            l1_in_5 <= 36'sd0;
            l1_in_6 <= 36'sd0;
            l1_in_7 <= 36'sd0;
        end else begin
            fetched <= rom_addr;
            {weight_7, weight_6, weight_5, weight_4, weight_3, weight_2, weight_1, weight_0}
                <= rom[rom_addr[8] ? 9'd256 : rom_addr];
            operand = read_en ? {1'b0, count} : 17'd1024;
            first = read_en && read_addr == 8'd0;
            if (forward1_en) begin
                l1_in_0 <= (first ? 36'sd0 : l1_in_0) + weight_0 * operand;
                l1_in_1 <= (first ? 36'sd0 : l1_in_1) + weight_1 * operand;
                l1_in_2 <= (first ? 36'sd0 : l1_in_2) + weight_2 * operand;
                l1_in_3 <= (first ? 36'sd0 : l1_in_3) + weight_3 * operand;
                l1_in_4 <= (first ? 36'sd0 : l1_in_4) + weight_4 * operand;
                l1_in_5 <= (first ? 36'sd0 : l1_in_5) + weight_5 * operand;
                l1_in_6 <= (first ? 36'sd0 : l1_in_6) + weight_6 * operand;
                l1_in_7 <= (first ? 36'sd0 : l1_in_7) + weight_7 * operand;
            end
        end
    end
    // verilator tracing_on
endmodule
