`timescale 1ns/1ps

// A histogram as the thesis's Listing 6.1 declares it: an array of words at a port.
module histogram (
    input  logic        clk,
    input  logic        clear,
    input  logic [7:0]  clear_word,
    input  logic        hit,
    input  logic [7:0]  code,
    output logic [15:0] Histogram [0:255]
);
    always_ff @(posedge clk)
        if (clear) Histogram[clear_word] <= 16'd0;
        else if (hit) Histogram[code] <= Histogram[code] + 16'd1;
endmodule
