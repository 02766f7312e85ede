`timescale 1ps / 1fs
`default_nettype none

// The hidden layer: one multiply-accumulate unit, one DSP48E1, for each neuron.
//
//   word (A), weight (B)  ->  product (M)  ->  l1_in (P), which begins with the bias (C)
module forward1 #(
    parameter integer BinBits = 8,      // 2 to the power of which are the words of the histogram
    parameter integer CountBits = 16,   // of a word
    parameter integer SumBits = 36,     // 36, or what product, bias and tansig need
    parameter integer W1Bits = 16,      // of a weight, and how many are fraction
    parameter integer W1Fraction = 23,
    parameter integer B1Bits = 16,      // of a bias, and how many are fraction, W1Fraction at most
    parameter integer B1Fraction = 13,
    parameter integer Neurons = 8,     // hidden neurons, 1 to 32
    parameter W1File = "rtl_ref/w1.mem",  // a row for each word, a weight for each neuron [2^-W1Fraction]
    parameter B1File = "rtl_ref/b1.mem"   // one row, a bias for each neuron [2^-B1Fraction]
) (
    input wire clk_sys,
    input wire rst,
    // estimator_ctrl
    input wire forward1_first,          // the sums begin
    input wire forward1_en,             // accumulates
    input wire [BinBits-1:0] rom_addr,  // row to fetch: that of the coming word
    // Histogram
    input wire [CountBits-1:0] count,   // word of the histogram [hits]
    // Sums of the neurons; zero past the last [2^-W1Fraction]
    output wire signed [SumBits-1:0] l1_in_0,
    output wire signed [SumBits-1:0] l1_in_1,
    output wire signed [SumBits-1:0] l1_in_2,
    output wire signed [SumBits-1:0] l1_in_3,
    output wire signed [SumBits-1:0] l1_in_4,
    output wire signed [SumBits-1:0] l1_in_5,
    output wire signed [SumBits-1:0] l1_in_6,
    output wire signed [SumBits-1:0] l1_in_7,
    output wire signed [SumBits-1:0] l1_in_8,
    output wire signed [SumBits-1:0] l1_in_9,
    output wire signed [SumBits-1:0] l1_in_10,
    output wire signed [SumBits-1:0] l1_in_11,
    output wire signed [SumBits-1:0] l1_in_12,
    output wire signed [SumBits-1:0] l1_in_13,
    output wire signed [SumBits-1:0] l1_in_14,
    output wire signed [SumBits-1:0] l1_in_15,
    output wire signed [SumBits-1:0] l1_in_16,
    output wire signed [SumBits-1:0] l1_in_17,
    output wire signed [SumBits-1:0] l1_in_18,
    output wire signed [SumBits-1:0] l1_in_19,
    output wire signed [SumBits-1:0] l1_in_20,
    output wire signed [SumBits-1:0] l1_in_21,
    output wire signed [SumBits-1:0] l1_in_22,
    output wire signed [SumBits-1:0] l1_in_23,
    output wire signed [SumBits-1:0] l1_in_24,
    output wire signed [SumBits-1:0] l1_in_25,
    output wire signed [SumBits-1:0] l1_in_26,
    output wire signed [SumBits-1:0] l1_in_27,
    output wire signed [SumBits-1:0] l1_in_28,
    output wire signed [SumBits-1:0] l1_in_29,
    output wire signed [SumBits-1:0] l1_in_30,
    output wire signed [SumBits-1:0] l1_in_31
);
    localparam integer ProductBits = CountBits + W1Bits + 1, BiasShift = W1Fraction - B1Fraction;

    // Block RAM, or LUTs for gate-level simulation, since Yosys has no model of a block RAM.
`ifdef ROM_IN_LUTS
    (* rom_style = "logic" *)
`else
    (* rom_style = "block" *)
`endif
    reg [W1Bits*Neurons-1:0] rom [0:(1 << BinBits) - 1];
    reg [B1Bits*Neurons-1:0] bias_rom [0:0];
    initial begin
        $readmemh(W1File, rom);
        $readmemh(B1File, bias_rom);
    end

    wire [W1Bits*Neurons-1:0] row = rom[rom_addr];
    wire [B1Bits*Neurons-1:0] biases = bias_rom[0];

    // The word of the histogram [hits], once for each four units: one net to all is too long for an ECP5.
    genvar group;
    generate
        for (group = 0; 4 * group < Neurons; group = group + 1) begin : groups
            reg [CountBits-1:0] word;

            initial word = {CountBits{1'b0}};

`ifdef ECP5
            (* keep *)
`endif
            always @(posedge clk_sys) word <= count;
        end
    endgenerate

    // The registers of the units below, by their names; but for the sums they are for waveforms.
    /* verilator lint_off UNUSED */
    wire [CountBits-1:0] word = groups[0].word;
    wire signed [W1Bits-1:0] fetched_0, fetched_1, fetched_2, fetched_3, fetched_4, fetched_5, fetched_6;
    wire signed [W1Bits-1:0] fetched_7, fetched_8, fetched_9, fetched_10, fetched_11, fetched_12, fetched_13;
    wire signed [W1Bits-1:0] fetched_14, fetched_15, fetched_16, fetched_17, fetched_18, fetched_19;
    wire signed [W1Bits-1:0] fetched_20, fetched_21, fetched_22, fetched_23, fetched_24, fetched_25;
    wire signed [W1Bits-1:0] fetched_26, fetched_27, fetched_28, fetched_29, fetched_30, fetched_31;
    wire signed [W1Bits-1:0] weight_0, weight_1, weight_2, weight_3, weight_4, weight_5, weight_6, weight_7;
    wire signed [W1Bits-1:0] weight_8, weight_9, weight_10, weight_11, weight_12, weight_13, weight_14;
    wire signed [W1Bits-1:0] weight_15, weight_16, weight_17, weight_18, weight_19, weight_20, weight_21;
    wire signed [W1Bits-1:0] weight_22, weight_23, weight_24, weight_25, weight_26, weight_27, weight_28;
    wire signed [W1Bits-1:0] weight_29, weight_30, weight_31;
    wire signed [ProductBits-1:0] product_0, product_1, product_2, product_3, product_4, product_5, product_6;
    wire signed [ProductBits-1:0] product_7, product_8, product_9, product_10, product_11, product_12;
    wire signed [ProductBits-1:0] product_13, product_14, product_15, product_16, product_17, product_18;
    wire signed [ProductBits-1:0] product_19, product_20, product_21, product_22, product_23, product_24;
    wire signed [ProductBits-1:0] product_25, product_26, product_27, product_28, product_29, product_30;
    wire signed [ProductBits-1:0] product_31;
    /* verilator lint_on UNUSED */
    wire [W1Bits*32-1:0] unit_fetched, unit_weight;
    wire [ProductBits*32-1:0] unit_product;
    wire [SumBits*32-1:0] unit_l1_in;
    assign {fetched_31, fetched_30, fetched_29, fetched_28, fetched_27, fetched_26, fetched_25, fetched_24,
            fetched_23, fetched_22, fetched_21, fetched_20, fetched_19, fetched_18, fetched_17, fetched_16,
            fetched_15, fetched_14, fetched_13, fetched_12, fetched_11, fetched_10, fetched_9, fetched_8,
            fetched_7, fetched_6, fetched_5, fetched_4, fetched_3, fetched_2, fetched_1, fetched_0}
           = unit_fetched;
    assign {weight_31, weight_30, weight_29, weight_28, weight_27, weight_26, weight_25, weight_24, weight_23,
            weight_22, weight_21, weight_20, weight_19, weight_18, weight_17, weight_16, weight_15, weight_14,
            weight_13, weight_12, weight_11, weight_10, weight_9, weight_8, weight_7, weight_6, weight_5,
            weight_4, weight_3, weight_2, weight_1, weight_0}
           = unit_weight;
    assign {product_31, product_30, product_29, product_28, product_27, product_26, product_25, product_24,
            product_23, product_22, product_21, product_20, product_19, product_18, product_17, product_16,
            product_15, product_14, product_13, product_12, product_11, product_10, product_9, product_8,
            product_7, product_6, product_5, product_4, product_3, product_2, product_1, product_0}
           = unit_product;
    assign {l1_in_31, l1_in_30, l1_in_29, l1_in_28, l1_in_27, l1_in_26, l1_in_25, l1_in_24, l1_in_23,
            l1_in_22, l1_in_21, l1_in_20, l1_in_19, l1_in_18, l1_in_17, l1_in_16, l1_in_15, l1_in_14,
            l1_in_13, l1_in_12, l1_in_11, l1_in_10, l1_in_9, l1_in_8, l1_in_7, l1_in_6, l1_in_5, l1_in_4,
            l1_in_3, l1_in_2, l1_in_1, l1_in_0}
           = unit_l1_in;

    genvar k;
    generate
        for (k = 0; k < 32; k = k + 1) begin : unit
            if (k < Neurons) begin : used
                reg signed [W1Bits-1:0] fetched;       // output of the ROM
                reg signed [W1Bits-1:0] weight;        // weight of the word
                reg signed [ProductBits-1:0] product;  // their product, a cycle later
                reg signed [SumBits-1:0] l1_in;

                wire signed [B1Bits-1:0] bias_word = biases[B1Bits*k +: B1Bits];
                wire signed [SumBits-1:0] bias
                    = {{SumBits - B1Bits{bias_word[B1Bits-1]}}, bias_word} <<< BiasShift;
                reg signed [SumBits-1:0] l1_in_next;

                initial begin
                    fetched = {W1Bits{1'b0}};
                    weight = {W1Bits{1'b0}};
                    product = {ProductBits{1'b0}};
                    l1_in = {SumBits{1'b0}};
                end

                always @* begin
                    l1_in_next = l1_in;
                    if (forward1_en)
                        l1_in_next = (forward1_first ? bias : l1_in)
                                     + {{SumBits - ProductBits{product[ProductBits-1]}}, product};
                end

                always @(posedge clk_sys) begin
                    fetched <= row[W1Bits*k +: W1Bits];
                    weight <= fetched;
                    product <= weight * $signed({1'b0, groups[k / 4].word});
                    if (rst) l1_in <= {SumBits{1'b0}};
                    else l1_in <= l1_in_next;
                end

                assign unit_fetched[W1Bits*k +: W1Bits] = fetched;
                assign unit_weight[W1Bits*k +: W1Bits] = weight;
                assign unit_product[ProductBits*k +: ProductBits] = product;
                assign unit_l1_in[SumBits*k +: SumBits] = l1_in;
            end else begin : unused
                assign unit_fetched[W1Bits*k +: W1Bits] = {W1Bits{1'b0}};
                assign unit_weight[W1Bits*k +: W1Bits] = {W1Bits{1'b0}};
                assign unit_product[ProductBits*k +: ProductBits] = {ProductBits{1'b0}};
                assign unit_l1_in[SumBits*k +: SumBits] = {SumBits{1'b0}};
            end
        end
    endgenerate
endmodule
