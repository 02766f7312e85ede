`timescale 1ps / 1fs
`default_nettype none

// The hidden layer: one multiply-accumulate unit, one DSP48E1, for each neuron.
module forward1 #(
    parameter [4:0] Neurons = 5'd8,       // hidden neurons, 1 to 16
    parameter W1File = "rtl_ref/w1.mem",  // 256 rows, a weight for each neuron [2^-23]
    parameter B1File = "rtl_ref/b1.mem"   // one row, a bias for each neuron [2^-13]
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
    // Sums of the neurons; zero past the last [2^-23]
    output wire signed [35:0] l1_in_0,
    output wire signed [35:0] l1_in_1,
    output wire signed [35:0] l1_in_2,
    output wire signed [35:0] l1_in_3,
    output wire signed [35:0] l1_in_4,
    output wire signed [35:0] l1_in_5,
    output wire signed [35:0] l1_in_6,
    output wire signed [35:0] l1_in_7,
    output wire signed [35:0] l1_in_8,
    output wire signed [35:0] l1_in_9,
    output wire signed [35:0] l1_in_10,
    output wire signed [35:0] l1_in_11,
    output wire signed [35:0] l1_in_12,
    output wire signed [35:0] l1_in_13,
    output wire signed [35:0] l1_in_14,
    output wire signed [35:0] l1_in_15
);
    // Block RAM, or LUTs for gate-level simulation, since Yosys has no model of a block RAM.
`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg [16*Neurons-1:0] rom [0:256];
    initial begin
        $readmemh(W1File, rom, 0, 255);
        $readmemh(B1File, rom, 256, 256);
    end

    wire [8:0] row = rom_addr[8] ? 9'd256 : rom_addr;
    wire [16*Neurons-1:0] weights = rom[row];

    // The bias is a product too, 1024 x B1, so that nothing is added outside the DSP48E1.
    wire signed [16:0] operand = read_en ? {1'b0, count} : 17'd1024;
    wire first = read_en && read_addr == 8'd0;

    // The registers of the units below, by their names; those of the weights are for waveforms.
    /* verilator lint_off UNUSED */
    wire signed [15:0] weight_0, weight_1, weight_2, weight_3, weight_4, weight_5, weight_6, weight_7;
    wire signed [15:0] weight_8, weight_9, weight_10, weight_11, weight_12, weight_13, weight_14;
    wire signed [15:0] weight_15;
    /* verilator lint_on UNUSED */
    wire [16*16-1:0] unit_weight;
    wire [36*16-1:0] unit_l1_in;
    assign {weight_15, weight_14, weight_13, weight_12, weight_11, weight_10, weight_9, weight_8,
            weight_7, weight_6, weight_5, weight_4, weight_3, weight_2, weight_1, weight_0}
           = unit_weight;
    assign {l1_in_15, l1_in_14, l1_in_13, l1_in_12, l1_in_11, l1_in_10, l1_in_9, l1_in_8,
            l1_in_7, l1_in_6, l1_in_5, l1_in_4, l1_in_3, l1_in_2, l1_in_1, l1_in_0}
           = unit_l1_in;

    genvar k;
    generate
        for (k = 0; k < 16; k = k + 1) begin : unit
            if (k < Neurons) begin : used
                // Weight of this cycle, fetched in the one before so that the ROM can be a block RAM.
                reg signed [15:0] weight;
                reg signed [35:0] l1_in;

                wire signed [15:0] weight_next = weights[16*k +: 16];
                reg signed [35:0] l1_in_next;

                initial begin
                    weight = 16'sd0;
                    l1_in = 36'sd0;
                end

                always @* begin
                    l1_in_next = l1_in;
                    if (forward1_en) l1_in_next = (first ? 36'sd0 : l1_in) + weight * operand;
                end

                always @(posedge clk_125) begin
                    if (rst) begin
                        weight <= 16'sd0;
                        l1_in <= 36'sd0;
                    end else begin
                        weight <= weight_next;
                        l1_in <= l1_in_next;
                    end
                end

                assign unit_weight[16*k +: 16] = weight;
                assign unit_l1_in[36*k +: 36] = l1_in;
            end else begin : unused
                assign unit_weight[16*k +: 16] = 16'd0;
                assign unit_l1_in[36*k +: 36] = 36'd0;
            end
        end
    endgenerate
endmodule
