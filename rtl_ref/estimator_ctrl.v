`timescale 1ps / 1fs
`default_nettype none

// Steps the estimator through its cycles: 267 with eight neurons, one more for each more.
//
//   cycle         e0 .. e255   e256     e257     e258 .. e265  e266     e267
//   next edge     product      bias     tansig   product       bias     -
//   forward1_en   ^^^^^^^^^^^^^^^^^^^^
//   read_en       ^^^^^^^^^^^
//   tansig_en                           ^^^^^^
//   forward2_en                                  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
//   algo_done                                                           ^^^^^^^^
module estimator_ctrl #(
    parameter [4:0] Neurons = 5'd8  // hidden neurons, 1 to 16
) (
    input wire clk_125,
    input wire rst,
    input wire algo_start,       // starts an estimation; ignored while busy
    output reg algo_done,        // the depth is ready; one cycle
    // Histogram
    output reg read_en,          // the histogram's word at read_addr is being read
    output reg [7:0] read_addr,  // word of the histogram
    // Layers
    output reg [8:0] rom_addr,   // row of weights to fetch for the cycle after; 256 is the bias
    output reg forward1_en,      // the hidden layer accumulates
    output reg tansig_en,        // the activations are looked up
    output reg forward2_en,      // the output layer accumulates, or holds its result
    // Neuron to add; the one past the last is the bias, then none
    output reg [$clog2(Neurons + 2)-1:0] neuron
);
    localparam integer Width = $clog2(Neurons + 2);
    localparam [8:0] Bias1 = 9'd256, Tansig = 9'd257, Neuron0 = 9'd258;
    localparam [8:0] Bias2 = Neuron0 + {4'd0, Neurons};
    localparam [8:0] None = {4'd0, Neurons} + 9'd1;

    reg busy;        // an estimation is under way
    reg [8:0] step;  // cycles since e0

    reg algo_done_next, read_en_next, forward1_en_next, tansig_en_next, forward2_en_next;
    reg busy_next;
    reg [7:0] read_addr_next;
    reg [8:0] rom_addr_next, step_next;
    reg [Width-1:0] neuron_next;

    initial begin
        {algo_done, read_en, forward1_en, tansig_en, forward2_en, busy} = 6'd0;
        read_addr = 8'd0;
        {rom_addr, step} = 18'd0;
        neuron = {Width{1'b0}};
    end

    always @* begin
        algo_done_next = 1'b0;
        read_en_next = 1'b0;
        read_addr_next = 8'd0;
        rom_addr_next = 9'd0;
        forward1_en_next = 1'b0;
        tansig_en_next = 1'b0;
        forward2_en_next = 1'b0;
        neuron_next = {Width{1'b0}};
        busy_next = busy;
        step_next = 9'd0;
        if (!busy) begin
            busy_next = algo_start;
        end else if (step == Bias2) begin
            busy_next = 1'b0;
            algo_done_next = 1'b1;
            forward2_en_next = 1'b1;
            neuron_next = None[Width-1:0];
        end else begin
            step_next = step + 9'd1;
        end
        if (busy_next) begin
            forward1_en_next = step_next <= Bias1;
            tansig_en_next = step_next == Tansig;
            if (step_next < Bias1) begin
                read_en_next = 1'b1;
                read_addr_next = step_next[7:0];
                rom_addr_next = step_next + 9'd1;
            end
            if (step_next >= Neuron0) begin
                forward2_en_next = 1'b1;
                neuron_next = step_next[Width-1:0] - Neuron0[Width-1:0];
            end
        end
    end

    always @(posedge clk_125) begin
        if (rst) begin
            algo_done <= 1'b0;
            read_en <= 1'b0;
            read_addr <= 8'd0;
            rom_addr <= 9'd0;
            forward1_en <= 1'b0;
            tansig_en <= 1'b0;
            forward2_en <= 1'b0;
            neuron <= {Width{1'b0}};
            busy <= 1'b0;
            step <= 9'd0;
        end else begin
            algo_done <= algo_done_next;
            read_en <= read_en_next;
            read_addr <= read_addr_next;
            rom_addr <= rom_addr_next;
            forward1_en <= forward1_en_next;
            tansig_en <= tansig_en_next;
            forward2_en <= forward2_en_next;
            neuron <= neuron_next;
            busy <= busy_next;
            step <= step_next;
        end
    end
endmodule
