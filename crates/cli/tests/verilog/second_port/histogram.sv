`timescale 1ns/1ps

// A histogram with an address of its own for reading, and registers that are not set at power-up.
module read_apart (
    input  logic        clk,
    input  logic        clear,
    input  logic [7:0]  clear_word,
    input  logic        hit,
    input  logic [7:0]  code,
    input  logic        shows,
    input  logic [7:0]  word,
    output logic [15:0] hits
);
    logic [15:0] ram [0:255];

    always_ff @(posedge clk)
        if (clear) ram[clear_word] <= 16'd0;
        else if (hit) ram[code] <= ram[code] + 16'd1;

    // While it counts, ours shows the word that it counts; this one always shows its own.
    assign hits = ram[word];
endmodule
