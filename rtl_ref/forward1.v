`timescale 1ps / 1fs
`default_nettype none

// The hidden layer: one multiply-accumulate unit, one DSP48E1, for each neuron.
module forward1 #(
    parameter W1File = "rtl_ref/w1.mem",  // 256 rows of eight weights [2^-23]
    parameter B1File = "rtl_ref/b1.mem"   // one row of eight biases [2^-13]
) (
    input wire clk_125,
    input wire rst,
    // estimator_ctrl
    input wire forward1_en,      // accumulates
    input wire read_en,          // count is a word of the histogram; if not, the bias is added
    input wire [7:0] read_addr,  // which word; 0 begins the sum
    input wire [8:0] rom_addr,   // row to fetch; from 256 on, the biases
    // Histogram
    input wire [15:0] count,     // word of the histogram [hits]
    // Sums of the neurons [2^-23]
    output reg signed [35:0] l1_in_0,
    output reg signed [35:0] l1_in_1,
    output reg signed [35:0] l1_in_2,
    output reg signed [35:0] l1_in_3,
    output reg signed [35:0] l1_in_4,
    output reg signed [35:0] l1_in_5,
    output reg signed [35:0] l1_in_6,
    output reg signed [35:0] l1_in_7
);
    // Weights of this cycle, fetched in the one before so that the ROM can be a block RAM.
    reg signed [15:0] weight_0, weight_1, weight_2, weight_3;
    reg signed [15:0] weight_4, weight_5, weight_6, weight_7;

    reg signed [35:0] l1_in_0_next, l1_in_1_next, l1_in_2_next, l1_in_3_next;
    reg signed [35:0] l1_in_4_next, l1_in_5_next, l1_in_6_next, l1_in_7_next;
    reg signed [15:0] weight_0_next, weight_1_next, weight_2_next, weight_3_next;
    reg signed [15:0] weight_4_next, weight_5_next, weight_6_next, weight_7_next;

    // Block RAM, or LUTs for gate-level simulation, since Yosys has no model of a block RAM.
`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg [127:0] rom [0:256];
    initial begin
        $readmemh(W1File, rom, 0, 255);
        $readmemh(B1File, rom, 256, 256);
    end

    wire [8:0] row = rom_addr[8] ? 9'd256 : rom_addr;
    wire [127:0] weights = rom[row];

    // The bias is a product too, 1024 x B1, so that nothing is added outside the DSP48E1.
    wire signed [16:0] operand = read_en ? {1'b0, count} : 17'd1024;
    wire first = read_en && read_addr == 8'd0;

    initial begin
        l1_in_0 = 36'sd0;
        l1_in_1 = 36'sd0;
        l1_in_2 = 36'sd0;
        l1_in_3 = 36'sd0;
        l1_in_4 = 36'sd0;
        l1_in_5 = 36'sd0;
        l1_in_6 = 36'sd0;
        l1_in_7 = 36'sd0;
        weight_0 = 16'sd0;
        weight_1 = 16'sd0;
        weight_2 = 16'sd0;
        weight_3 = 16'sd0;
        weight_4 = 16'sd0;
        weight_5 = 16'sd0;
        weight_6 = 16'sd0;
        weight_7 = 16'sd0;
    end

    always @* begin
        {weight_7_next, weight_6_next, weight_5_next, weight_4_next,
         weight_3_next, weight_2_next, weight_1_next, weight_0_next} = weights;
        l1_in_0_next = l1_in_0;
        l1_in_1_next = l1_in_1;
        l1_in_2_next = l1_in_2;
        l1_in_3_next = l1_in_3;
        l1_in_4_next = l1_in_4;
        l1_in_5_next = l1_in_5;
        l1_in_6_next = l1_in_6;
        l1_in_7_next = l1_in_7;
        if (forward1_en) begin
            l1_in_0_next = (first ? 36'sd0 : l1_in_0) + weight_0 * operand;
            l1_in_1_next = (first ? 36'sd0 : l1_in_1) + weight_1 * operand;
            l1_in_2_next = (first ? 36'sd0 : l1_in_2) + weight_2 * operand;
            l1_in_3_next = (first ? 36'sd0 : l1_in_3) + weight_3 * operand;
            l1_in_4_next = (first ? 36'sd0 : l1_in_4) + weight_4 * operand;
            l1_in_5_next = (first ? 36'sd0 : l1_in_5) + weight_5 * operand;
            l1_in_6_next = (first ? 36'sd0 : l1_in_6) + weight_6 * operand;
            l1_in_7_next = (first ? 36'sd0 : l1_in_7) + weight_7 * operand;
        end
    end

    always @(posedge clk_125) begin
        if (rst) begin
            l1_in_0 <= 36'sd0;
            l1_in_1 <= 36'sd0;
            l1_in_2 <= 36'sd0;
            l1_in_3 <= 36'sd0;
            l1_in_4 <= 36'sd0;
            l1_in_5 <= 36'sd0;
            l1_in_6 <= 36'sd0;
            l1_in_7 <= 36'sd0;
            weight_0 <= 16'sd0;
            weight_1 <= 16'sd0;
            weight_2 <= 16'sd0;
            weight_3 <= 16'sd0;
            weight_4 <= 16'sd0;
            weight_5 <= 16'sd0;
            weight_6 <= 16'sd0;
            weight_7 <= 16'sd0;
        end else begin
            l1_in_0 <= l1_in_0_next;
            l1_in_1 <= l1_in_1_next;
            l1_in_2 <= l1_in_2_next;
            l1_in_3 <= l1_in_3_next;
            l1_in_4 <= l1_in_4_next;
            l1_in_5 <= l1_in_5_next;
            l1_in_6 <= l1_in_6_next;
            l1_in_7 <= l1_in_7_next;
            weight_0 <= weight_0_next;
            weight_1 <= weight_1_next;
            weight_2 <= weight_2_next;
            weight_3 <= weight_3_next;
            weight_4 <= weight_4_next;
            weight_5 <= weight_5_next;
            weight_6 <= weight_6_next;
            weight_7 <= weight_7_next;
        end
    end
endmodule
