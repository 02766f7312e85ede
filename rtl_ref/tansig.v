`timescale 1ps / 1fs
`default_nettype none

// The activation of the hidden layer, from a table: all lookups side by side.
//
//   l1_in, tansig_en  ->  entry, found  ->  l1_out
module tansig #(
    parameter integer SumBits = 36,               // see forward1
    parameter [4:0] Neurons = 5'd8,               // hidden neurons, 1 to 16
    parameter integer AddressBits = 12,           // size of the table, which covers +-4
    parameter integer Shift = 14,                 // fraction bits of l1_in that the address drops
    parameter TansigFile = "rtl_ref/tansig.mem"   // by address as an unsigned number [2^-15]
) (
    input wire clk_sys,
    input wire rst,
    input wire tansig_en,  // looks up the activations
    // Sums of the neurons; not looked at past the last [2^-23]
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
    // Activations of the neurons; zero past the last [2^-15]
    output wire signed [15:0] l1_out_0,
    output wire signed [15:0] l1_out_1,
    output wire signed [15:0] l1_out_2,
    output wire signed [15:0] l1_out_3,
    output wire signed [15:0] l1_out_4,
    output wire signed [15:0] l1_out_5,
    output wire signed [15:0] l1_out_6,
    output wire signed [15:0] l1_out_7,
    output wire signed [15:0] l1_out_8,
    output wire signed [15:0] l1_out_9,
    output wire signed [15:0] l1_out_10,
    output wire signed [15:0] l1_out_11,
    output wire signed [15:0] l1_out_12,
    output wire signed [15:0] l1_out_13,
    output wire signed [15:0] l1_out_14,
    output wire signed [15:0] l1_out_15
);
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
    wire [SumBits*16-1:0] l1_in = {l1_in_15, l1_in_14, l1_in_13, l1_in_12, l1_in_11, l1_in_10, l1_in_9,
                              l1_in_8, l1_in_7, l1_in_6, l1_in_5, l1_in_4, l1_in_3, l1_in_2, l1_in_1,
                              l1_in_0};
    /* verilator lint_on UNUSED */
    wire [16*16-1:0] unit_entry, unit_l1_out;
    /* verilator lint_off UNUSED */
    wire signed [15:0] entry_0, entry_1, entry_2, entry_3, entry_4, entry_5, entry_6, entry_7, entry_8;
    wire signed [15:0] entry_9, entry_10, entry_11, entry_12, entry_13, entry_14, entry_15;
    /* verilator lint_on UNUSED */
    assign {entry_15, entry_14, entry_13, entry_12, entry_11, entry_10, entry_9, entry_8, entry_7,
            entry_6, entry_5, entry_4, entry_3, entry_2, entry_1, entry_0}
           = unit_entry;
    assign {l1_out_15, l1_out_14, l1_out_13, l1_out_12, l1_out_11, l1_out_10, l1_out_9, l1_out_8,
            l1_out_7, l1_out_6, l1_out_5, l1_out_4, l1_out_3, l1_out_2, l1_out_1, l1_out_0}
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
            reg signed [15:0] rom [0:(1 << AddressBits) - 1];
            initial $readmemh(TansigFile, rom);

            for (k = 2 * pair; k < 2 * pair + 2 && k < Neurons; k = k + 1) begin : unit
                wire [AddressBits-1:0] place = address(l1_in[SumBits*k +: SumBits]);

                reg signed [15:0] entry;   // output of the table
                reg signed [15:0] l1_out;

                initial begin
                    entry = 16'sd0;
                    l1_out = 16'sd0;
                end

                always @(posedge clk_sys) begin
                    if (tansig_en) entry <= rom[place];
                    if (rst) l1_out <= 16'sd0;
                    else if (found) l1_out <= entry;
                end

                assign unit_entry[16*k +: 16] = entry;
                assign unit_l1_out[16*k +: 16] = l1_out;
            end
        end
        for (k = 0; k < 16; k = k + 1) begin : past
            if (k >= Neurons) begin : last
                assign unit_entry[16*k +: 16] = 16'd0;
                assign unit_l1_out[16*k +: 16] = 16'd0;
            end
        end
    endgenerate
endmodule
