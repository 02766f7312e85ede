`timescale 1ps / 1fs
`default_nettype none

// The histogram: 256 words of 16 bits in distributed RAM. A hit takes the two cycles after that of
// tdc_valid: its word is read in the first, and written back, one more, in the second. Clear goes before
// it, and a hit that meets it is lost.
module histogram_builder (
    input wire clk_sys,
    // frame_ctrl
    input wire clear,             // sets the word at clear_addr to zero
    input wire [7:0] clear_addr,  // word to clear
    // tdc
    input wire tdc_valid,         // counts a hit; low for the next two cycles
    input wire [7:0] tdc_code,    // word of the hit; holds for the next two cycles
    // depth_estimator
    input wire read_en,           // shows a word at count
    input wire [7:0] read_addr,   // word to show
    output wire [15:0] count      // word of the histogram [hits]
);
    (* ram_style = "distributed" *) reg [15:0] ram [0:255];
    reg counting;         // either cycle of a hit: what the address waits for is one register
    reg writing;          // the second
    reg [15:0] hit_word;  // the word of the hit before it is counted [hits]

    integer i;
    initial begin
        for (i = 0; i < 256; i = i + 1) ram[i] = 16'd0;
        {counting, writing} = 2'd0;
        hit_word = 16'd0;
    end

    // One address for all three, so that a bit is one RAM256X1S.
    wire [7:0] addr = clear ? clear_addr : counting ? tdc_code : read_addr;
    wire [15:0] word = ram[addr];
    wire [15:0] word_next = clear ? 16'd0 : hit_word + 16'd1;
    wire reading = counting && !writing;

    assign count = read_en ? word : 16'd0;

    always @(posedge clk_sys) begin
        counting <= (tdc_valid || reading) && !clear;
        writing <= reading && !clear;
        if (reading) hit_word <= word;
        if (clear || writing) ram[addr] <= word_next;
    end
endmodule
