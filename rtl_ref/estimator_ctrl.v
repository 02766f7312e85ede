`timescale 1ps / 1fs
`default_nettype none

// Steps the estimator through its pipeline. P are the pairs of neurons. The depth is there in cycle D, the
// larger of 259 + Neurons and 263 + P: 267 with eight neurons.
//
//   registers    read_addr   word, weight  product      l1_in        entry  l1_out
//   loaded at    e0 .. e255  e1 .. e256    e2 .. e257   e3 .. e258   e259   e260
//   control                                forward1_en               tansig_en
//
//   registers    activation, weight  product         sum             depth
//   loaded at    e261 .. e260+P      e262 .. e261+P  e263 .. e262+P  D
//   control      pair                                forward2_en     depth_en, algo_done
module estimator_ctrl #(
    parameter [4:0] Neurons = 5'd8  // hidden neurons, 1 to 16
) (
    input wire clk_sys,
    input wire rst,
    input wire algo_start,       // starts an estimation; ignored while busy
    output reg algo_done,        // the depth is ready; one cycle
    // Histogram
    output reg read_en,          // the histogram's word at read_addr is being read
    output reg [7:0] read_addr,  // word of the histogram
    // Layers
    output reg [7:0] rom_addr,   // row of weights to fetch: that of the coming word
    output reg forward1_first,   // the sums of the hidden layer begin
    output reg forward1_en,      // the hidden layer accumulates
    output reg tansig_en,        // the activations are looked up
    output reg [2:0] pair,       // neurons whose activations become operands
    output reg forward2_first,   // the sums of the output layer begin
    output reg forward2_en,      // the output layer accumulates
    output reg depth_en          // its sums become the depth
);
    // In cycles since e0; what is high in a cycle is decoded in the one before.
    localparam [8:0] Sums1 = 9'd2, Tansig = 9'd258, Operands = 9'd260, Sums2 = 9'd262;
    localparam [8:0] Pairs = {5'd0, Neurons[4:1]} + {8'd0, Neurons[0]};
    localparam [8:0] Add = Neurons < 5'd8 ? Sums2 + Pairs : 9'd258 + {4'd0, Neurons};

    reg busy;        // an estimation is under way
    reg [8:0] step;  // cycles since e0

    reg algo_done_next, read_en_next, forward1_first_next, forward1_en_next, tansig_en_next;
    reg forward2_first_next, forward2_en_next, depth_en_next, busy_next;
    reg [7:0] read_addr_next, rom_addr_next;
    reg [2:0] pair_next;
    reg [8:0] step_next;

    initial begin
        {algo_done, read_en, forward1_first, forward1_en, tansig_en, busy} = 6'd0;
        {forward2_first, forward2_en, depth_en} = 3'd0;
        {read_addr, rom_addr} = 16'd0;
        pair = 3'd0;
        step = 9'd0;
    end

    always @* begin
        algo_done_next = 1'b0;
        read_en_next = 1'b0;
        read_addr_next = 8'd0;
        rom_addr_next = 8'd0;
        forward1_first_next = 1'b0;
        forward1_en_next = 1'b0;
        tansig_en_next = 1'b0;
        pair_next = 3'd0;
        forward2_first_next = 1'b0;
        forward2_en_next = 1'b0;
        depth_en_next = 1'b0;
        busy_next = busy;
        step_next = 9'd0;
        if (busy) begin
            step_next = step + 9'd1;
            if (step < 9'd255) begin
                read_en_next = 1'b1;
                read_addr_next = step[7:0] + 8'd1;
            end
            if (step < 9'd254) rom_addr_next = step[7:0] + 8'd2;
            forward1_first_next = step == Sums1 - 9'd1;
            forward1_en_next = step >= Sums1 - 9'd1 && step < Tansig - 9'd1;
            tansig_en_next = step == Tansig - 9'd1;
            if (step >= Operands - 9'd1 && step < Operands - 9'd1 + Pairs)
                pair_next = step[2:0] - Operands[2:0] + 3'd1;
            forward2_first_next = step == Sums2 - 9'd1;
            forward2_en_next = step >= Sums2 - 9'd1 && step < Sums2 - 9'd1 + Pairs;
            depth_en_next = step == Add - 9'd1;
            if (step == Add) begin
                algo_done_next = 1'b1;
                busy_next = 1'b0;
                step_next = 9'd0;
            end
        end else if (algo_start) begin
            read_en_next = 1'b1;
            rom_addr_next = 8'd1;
            busy_next = 1'b1;
        end
    end

    always @(posedge clk_sys) begin
        if (rst) begin
            algo_done <= 1'b0;
            read_en <= 1'b0;
            read_addr <= 8'd0;
            rom_addr <= 8'd0;
            forward1_first <= 1'b0;
            forward1_en <= 1'b0;
            tansig_en <= 1'b0;
            pair <= 3'd0;
            forward2_first <= 1'b0;
            forward2_en <= 1'b0;
            depth_en <= 1'b0;
            busy <= 1'b0;
            step <= 9'd0;
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
