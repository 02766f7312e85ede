`timescale 1ps / 1fs
`default_nettype none

// Steps the estimator through its pipeline. B are the bins, P the pairs of neurons. The depth is there in
// cycle D, the larger of B + 3 + Neurons and B + 7 + P: 267 with 256 bins and eight neurons.
//
//   registers    read_addr     word, weight  product      l1_in        entry  l1_out
//   loaded at    e0 .. e(B-1)  e1 .. eB      .. e(B+1)    .. e(B+2)    e(B+3) e(B+4)
//   control                                  forward1_en               tansig_en
//
//   registers    activation, weight  product      sum          depth
//   loaded at    e(B+5) .. e(B+4+P)  .. e(B+5+P)  .. e(B+6+P)  D
//   control      pair                             forward2_en  depth_en, algo_done
module estimator_ctrl #(
    parameter integer BinBits = 8,  // 2 to the power of which are the bins, 4 to 10
    parameter integer Neurons = 8  // hidden neurons, 1 to 32
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,               // starts an estimation; ignored while busy
    output reg algo_done,                // the depth is ready; one cycle
    // Histogram
    output reg read_en,                  // the histogram's word at read_addr is being read
    output reg [BinBits-1:0] read_addr,  // word of the histogram
    // Layers
    output reg [BinBits-1:0] rom_addr,   // row of weights to fetch: that of the coming word
    output reg forward1_first,           // the sums of the hidden layer begin
    output reg forward1_en,              // the hidden layer accumulates
    output reg tansig_en,                // the activations are looked up
    output reg [(Neurons > 16 ? 3 : 2):0] pair,  // neurons whose activations become operands
    output reg forward2_first,           // the sums of the output layer begin
    output reg forward2_en,              // the output layer accumulates
    output reg depth_en                  // its sums become the depth
);
    // In cycles since e0; what is high in a cycle is decoded in the one before.
    localparam integer Bins = 1 << BinBits, PairsHere = (Neurons + 1) / 2;
    localparam integer AddAt = Neurons < 8 ? Bins + 6 + PairsHere : Bins + 2 + Neurons;
    localparam integer StepBits = $clog2(AddAt + 1), PairBits = Neurons > 16 ? 4 : 3;
    localparam [StepBits-1:0] LastWord = Bins[StepBits-1:0] - 1'b1;
    localparam [StepBits-1:0] Sums1 = 2, Tansig = LastWord + 3, Operands = LastWord + 5, Sums2 = LastWord + 7;
    localparam [StepBits-1:0] Pairs = PairsHere[StepBits-1:0], Add = AddAt[StepBits-1:0];

    reg busy;                 // an estimation is under way
    reg [StepBits-1:0] step;  // cycles since e0

    reg algo_done_next, read_en_next, forward1_first_next, forward1_en_next, tansig_en_next;
    reg forward2_first_next, forward2_en_next, depth_en_next, busy_next;
    reg [BinBits-1:0] read_addr_next, rom_addr_next;
    reg [PairBits-1:0] pair_next;
    reg [StepBits-1:0] step_next;

    initial begin
        {algo_done, read_en, forward1_first, forward1_en, tansig_en, busy} = 6'd0;
        {forward2_first, forward2_en, depth_en} = 3'd0;
        {read_addr, rom_addr} = {2 * BinBits{1'b0}};
        pair = {PairBits{1'b0}};
        step = {StepBits{1'b0}};
    end

    always @* begin
        algo_done_next = 1'b0;
        read_en_next = 1'b0;
        read_addr_next = {BinBits{1'b0}};
        rom_addr_next = {BinBits{1'b0}};
        forward1_first_next = 1'b0;
        forward1_en_next = 1'b0;
        tansig_en_next = 1'b0;
        pair_next = {PairBits{1'b0}};
        forward2_first_next = 1'b0;
        forward2_en_next = 1'b0;
        depth_en_next = 1'b0;
        busy_next = busy;
        step_next = {StepBits{1'b0}};
        if (busy) begin
            step_next = step + 1'b1;
            if (step < LastWord) begin
                read_en_next = 1'b1;
                read_addr_next = step[BinBits-1:0] + 1'b1;
            end
            if (step < LastWord - 1'b1) rom_addr_next = step[BinBits-1:0] + Sums1[BinBits-1:0];
            forward1_first_next = step == Sums1 - 1'b1;
            forward1_en_next = step >= Sums1 - 1'b1 && step < Tansig - 1'b1;
            tansig_en_next = step == Tansig - 1'b1;
            if (step >= Operands - 1'b1 && step < Operands - 1'b1 + Pairs)
                pair_next = step[PairBits-1:0] - Operands[PairBits-1:0] + 1'b1;
            forward2_first_next = step == Sums2 - 1'b1;
            forward2_en_next = step >= Sums2 - 1'b1 && step < Sums2 - 1'b1 + Pairs;
            depth_en_next = step == Add - 1'b1;
            if (step == Add) begin
                algo_done_next = 1'b1;
                busy_next = 1'b0;
                step_next = {StepBits{1'b0}};
            end
        end else if (algo_start) begin
            read_en_next = 1'b1;
            rom_addr_next = {{BinBits - 1{1'b0}}, 1'b1};
            busy_next = 1'b1;
        end
    end

    always @(posedge clk_sys) begin
        if (rst) begin
            algo_done <= 1'b0;
            read_en <= 1'b0;
            read_addr <= {BinBits{1'b0}};
            rom_addr <= {BinBits{1'b0}};
            forward1_first <= 1'b0;
            forward1_en <= 1'b0;
            tansig_en <= 1'b0;
            pair <= {PairBits{1'b0}};
            forward2_first <= 1'b0;
            forward2_en <= 1'b0;
            depth_en <= 1'b0;
            busy <= 1'b0;
            step <= {StepBits{1'b0}};
        end else begin
            algo_done <= algo_done_next;
            read_en <= read_en_next;
            read_addr <= read_addr_next;
            rom_addr <= rom_addr_next;
            forward1_first <= forward1_first_next;
            forward1_en <= forward1_en_next;
            tansig_en <= tansig_en_next;
            pair <= pair_next;
            forward2_first <= forward2_first_next;
            forward2_en <= forward2_en_next;
            depth_en <= depth_en_next;
            busy <= busy_next;
            step <= step_next;
        end
    end
endmodule
