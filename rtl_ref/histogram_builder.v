`timescale 1ps / 1fs
`default_nettype none

// The histogram: words in distributed RAM. A hit takes the two cycles after that of
// tdc_valid: its word is read in the first, and written back, one more, in the second. Clear goes before
// it, and a hit that meets it is lost. In an array it is filled or read when it is the turn of its bank and column.
module histogram_builder #(
    parameter integer BinBits = 8,    // 2 to the power of which are the words, 4 to 10
    parameter integer CountBits = 16, // of a word, 8 to 24
    parameter integer Columns = 1,    // of the array, 1 to 64
    parameter integer Banks = 1,      // of histograms, 1 or 2
    parameter [5:0] Column = 6'd0,    // column of this histogram
    parameter [0:0] Bank = 1'b0       // its bank
) (
    input wire clk_sys,
    // frame_ctrl
    input wire clear,                     // sets the word at clear_addr to zero
    input wire [BinBits-1:0] clear_addr,  // word to clear
    // verilator lint_off UNUSEDSIGNAL
    input wire bank,                      // bank that is filled
    input wire [5:0] depth_column,        // column that is read
    // verilator lint_on UNUSEDSIGNAL
    // tdc
    input wire tdc_valid,                 // counts a hit; low for the next two cycles
    input wire [BinBits-1:0] tdc_code,    // word of the hit; holds for the next two cycles
    // depth_estimator
    input wire read_en,                   // shows a word at count
    input wire [BinBits-1:0] read_addr,   // word to show
    output wire [CountBits-1:0] count     // word of the histogram [hits]
);
    (* ram_style = "distributed" *) reg [CountBits-1:0] ram [0:(1 << BinBits) - 1];
    reg counting;                  // either cycle of a hit: what the address waits for is one register
    reg writing;                   // the second
    reg [CountBits-1:0] hit_word;  // the word of the hit before it is counted [hits]

    integer i;
    initial begin
        for (i = 0; i < 1 << BinBits; i = i + 1) ram[i] = {CountBits{1'b0}};
        {counting, writing} = 2'd0;
        hit_word = {CountBits{1'b0}};
    end

    wire fills = Banks == 1 || bank == Bank;
    wire shows = (Banks == 1 || bank != Bank) && (Columns == 1 || depth_column == Column);
    wire clears = clear && fills;

    // One address for all three, so that a bit of 256 words is one RAM256X1S.
    wire [BinBits-1:0] addr = clears ? clear_addr : counting ? tdc_code : read_addr;
    wire [CountBits-1:0] word = ram[addr];
    wire [CountBits-1:0] word_next = clears ? {CountBits{1'b0}} : hit_word + 1'b1;
    wire reading = counting && !writing;

    assign count = read_en && shows ? word : {CountBits{1'b0}};

    always @(posedge clk_sys) begin
        counting <= (tdc_valid && fills || reading) && !clears;
        writing <= reading && !clears;
        if (reading) hit_word <= word;
        if (clears || writing) ram[addr] <= word_next;
    end
endmodule
