`timescale 1ps / 1fs
`default_nettype none

// The activation of the hidden layer, from a table: all lookups side by side.
//
//   l1_in, tansig_en  ->  entry, found  ->  l1_out
module tansig #(
    parameter integer SumBits = 36,               // see forward1
    parameter integer W1Fraction = 23,            // fraction bits of l1_in
    parameter integer AddressBits = 12,           // size of the table, 4 to 16
    parameter integer RangeLog2 = 2,              // which covers +- 2 to this power
    parameter integer ActivationBits = 16,        // of an entry
    parameter integer Neurons = 8,               // hidden neurons, 1 to 32
    parameter TansigFile = "rtl_ref/tansig.mem"   // by address as an unsigned number
) (
    input wire clk_sys,
    input wire rst,
    input wire tansig_en,  // looks up the activations
    // Sums of the neurons; not looked at past the last [2^-W1Fraction]
    input wire signed [SumBits-1:0] l1_in_0,
    input wire signed [SumBits-1:0] l1_in_1,
    input wire signed [SumBits-1:0] l1_in_2,
    input wire signed [SumBits-1:0] l1_in_3,
    input wire signed [SumBits-1:0] l1_in_4,
    input wire signed [SumBits-1:0] l1_in_5,
    input wire signed [SumBits-1:0] l1_in_6,
    input wire signed [SumBits-1:0] l1_in_7,
    input wire signed [SumBits-1:0] l1_in_8,
    input wire signed [SumBits-1:0] l1_in_9,
    input wire signed [SumBits-1:0] l1_in_10,
    input wire signed [SumBits-1:0] l1_in_11,
    input wire signed [SumBits-1:0] l1_in_12,
    input wire signed [SumBits-1:0] l1_in_13,
    input wire signed [SumBits-1:0] l1_in_14,
    input wire signed [SumBits-1:0] l1_in_15,
    input wire signed [SumBits-1:0] l1_in_16,
    input wire signed [SumBits-1:0] l1_in_17,
    input wire signed [SumBits-1:0] l1_in_18,
    input wire signed [SumBits-1:0] l1_in_19,
    input wire signed [SumBits-1:0] l1_in_20,
    input wire signed [SumBits-1:0] l1_in_21,
    input wire signed [SumBits-1:0] l1_in_22,
    input wire signed [SumBits-1:0] l1_in_23,
    input wire signed [SumBits-1:0] l1_in_24,
    input wire signed [SumBits-1:0] l1_in_25,
    input wire signed [SumBits-1:0] l1_in_26,
    input wire signed [SumBits-1:0] l1_in_27,
    input wire signed [SumBits-1:0] l1_in_28,
    input wire signed [SumBits-1:0] l1_in_29,
    input wire signed [SumBits-1:0] l1_in_30,
    input wire signed [SumBits-1:0] l1_in_31,
    // Activations of the neurons; zero past the last
    output wire signed [ActivationBits-1:0] l1_out_0,
    output wire signed [ActivationBits-1:0] l1_out_1,
    output wire signed [ActivationBits-1:0] l1_out_2,
    output wire signed [ActivationBits-1:0] l1_out_3,
    output wire signed [ActivationBits-1:0] l1_out_4,
    output wire signed [ActivationBits-1:0] l1_out_5,
    output wire signed [ActivationBits-1:0] l1_out_6,
    output wire signed [ActivationBits-1:0] l1_out_7,
    output wire signed [ActivationBits-1:0] l1_out_8,
    output wire signed [ActivationBits-1:0] l1_out_9,
    output wire signed [ActivationBits-1:0] l1_out_10,
    output wire signed [ActivationBits-1:0] l1_out_11,
    output wire signed [ActivationBits-1:0] l1_out_12,
    output wire signed [ActivationBits-1:0] l1_out_13,
    output wire signed [ActivationBits-1:0] l1_out_14,
    output wire signed [ActivationBits-1:0] l1_out_15,
    output wire signed [ActivationBits-1:0] l1_out_16,
    output wire signed [ActivationBits-1:0] l1_out_17,
    output wire signed [ActivationBits-1:0] l1_out_18,
    output wire signed [ActivationBits-1:0] l1_out_19,
    output wire signed [ActivationBits-1:0] l1_out_20,
    output wire signed [ActivationBits-1:0] l1_out_21,
    output wire signed [ActivationBits-1:0] l1_out_22,
    output wire signed [ActivationBits-1:0] l1_out_23,
    output wire signed [ActivationBits-1:0] l1_out_24,
    output wire signed [ActivationBits-1:0] l1_out_25,
    output wire signed [ActivationBits-1:0] l1_out_26,
    output wire signed [ActivationBits-1:0] l1_out_27,
    output wire signed [ActivationBits-1:0] l1_out_28,
    output wire signed [ActivationBits-1:0] l1_out_29,
    output wire signed [ActivationBits-1:0] l1_out_30,
    output wire signed [ActivationBits-1:0] l1_out_31
);
    localparam integer Shift = W1Fraction + 1 + RangeLog2 - AddressBits;  // fraction bits that the address drops
    localparam integer Sign = AddressBits + Shift - 1;  // bit of l1_in that is the address's sign

    // The sum, rounded half up and saturated: the only rounding in the datapath. What saturates is
    // told from the bits of the sum, beside the addition and not after it: a sum that fits has equal bits
    // from the sign on, and no half step carries it out of the range.
    function [AddressBits-1:0] address;
        input signed [SumBits-1:0] l1_in;
        reg carries, high, low;
        begin
            carries = &l1_in[Sign-1:Shift-1];
            high = !l1_in[SumBits-1] && (|l1_in[SumBits-1:Sign] || carries);
            low = l1_in[SumBits-1] && !(&l1_in[SumBits-1:Sign]);
            address = l1_in[Sign:Shift] + {{AddressBits - 1{1'b0}}, l1_in[Shift-1]};
            if (high) address = {1'b0, {AddressBits - 1{1'b1}}};
            if (low) address = {1'b1, {AddressBits - 1{1'b0}}};
        end
    endfunction

    // The ports side by side.
    /* verilator lint_off UNUSED */
    wire [SumBits*32-1:0] l1_in = {l1_in_31, l1_in_30, l1_in_29, l1_in_28, l1_in_27, l1_in_26, l1_in_25,
        l1_in_24, l1_in_23, l1_in_22, l1_in_21, l1_in_20, l1_in_19, l1_in_18, l1_in_17, l1_in_16, l1_in_15,
        l1_in_14, l1_in_13, l1_in_12, l1_in_11, l1_in_10, l1_in_9, l1_in_8, l1_in_7, l1_in_6, l1_in_5,
        l1_in_4, l1_in_3, l1_in_2, l1_in_1, l1_in_0};
    /* verilator lint_on UNUSED */
    wire [ActivationBits*32-1:0] unit_entry, unit_l1_out;
    /* verilator lint_off UNUSED */
    wire signed [ActivationBits-1:0] entry_0, entry_1, entry_2, entry_3, entry_4, entry_5, entry_6, entry_7;
    wire signed [ActivationBits-1:0] entry_8, entry_9, entry_10, entry_11, entry_12, entry_13, entry_14;
    wire signed [ActivationBits-1:0] entry_15, entry_16, entry_17, entry_18, entry_19, entry_20, entry_21;
    wire signed [ActivationBits-1:0] entry_22, entry_23, entry_24, entry_25, entry_26, entry_27, entry_28;
    wire signed [ActivationBits-1:0] entry_29, entry_30, entry_31;
    /* verilator lint_on UNUSED */
    assign {entry_31, entry_30, entry_29, entry_28, entry_27, entry_26, entry_25, entry_24, entry_23,
            entry_22, entry_21, entry_20, entry_19, entry_18, entry_17, entry_16, entry_15, entry_14,
            entry_13, entry_12, entry_11, entry_10, entry_9, entry_8, entry_7, entry_6, entry_5, entry_4,
            entry_3, entry_2, entry_1, entry_0}
           = unit_entry;
    assign {l1_out_31, l1_out_30, l1_out_29, l1_out_28, l1_out_27, l1_out_26, l1_out_25, l1_out_24, l1_out_23,
            l1_out_22, l1_out_21, l1_out_20, l1_out_19, l1_out_18, l1_out_17, l1_out_16, l1_out_15, l1_out_14,
            l1_out_13, l1_out_12, l1_out_11, l1_out_10, l1_out_9, l1_out_8, l1_out_7, l1_out_6, l1_out_5,
            l1_out_4, l1_out_3, l1_out_2, l1_out_1, l1_out_0}
           = unit_l1_out;

    reg found;  // the entries are new

    initial found = 1'b0;

    always @(posedge clk_sys) begin
        if (rst) found <= 1'b0;
        else found <= tansig_en;
    end

    // A block RAM has two ports, so each two neurons have a copy of the table.
    genvar pair, k;
    generate
        for (pair = 0; 2 * pair < Neurons; pair = pair + 1) begin : pairs
            // Block RAM, or LUTs for gate-level simulation, since Yosys has no model of a block RAM.
`ifdef ROM_IN_LUTS
            (* rom_style = "logic" *)
`else
            (* rom_style = "block" *)
`endif
            reg signed [ActivationBits-1:0] rom [0:(1 << AddressBits) - 1];
            initial $readmemh(TansigFile, rom);

            for (k = 2 * pair; k < 2 * pair + 2 && k < Neurons; k = k + 1) begin : unit
                wire [AddressBits-1:0] place = address(l1_in[SumBits*k +: SumBits]);

                reg signed [ActivationBits-1:0] entry;   // output of the table
                reg signed [ActivationBits-1:0] l1_out;

                initial begin
                    entry = {ActivationBits{1'b0}};
                    l1_out = {ActivationBits{1'b0}};
                end

                always @(posedge clk_sys) begin
                    if (tansig_en) entry <= rom[place];
                    if (rst) l1_out <= {ActivationBits{1'b0}};
                    else if (found) l1_out <= entry;
                end

                assign unit_entry[ActivationBits*k +: ActivationBits] = entry;
                assign unit_l1_out[ActivationBits*k +: ActivationBits] = l1_out;
            end
        end
        for (k = 0; k < 32; k = k + 1) begin : past
            if (k >= Neurons) begin : last
                assign unit_entry[ActivationBits*k +: ActivationBits] = {ActivationBits{1'b0}};
                assign unit_l1_out[ActivationBits*k +: ActivationBits] = {ActivationBits{1'b0}};
            end
        end
    endgenerate
endmodule
