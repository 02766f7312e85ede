`timescale 1ps / 1fs
`default_nettype none

// The histogram: 256 words of 16 bits in distributed RAM, read and counted up in the same cycle.
module histogram_builder (
    input wire clk_125,
    // frame_ctrl
    input wire clear,             // sets the word at clear_addr to zero
    input wire [7:0] clear_addr,  // word to clear
    // tdc
    input wire tdc_valid,         // counts a hit
    input wire [7:0] tdc_code,    // word of the hit
    // depth_estimator
    input wire read_en,           // shows a word at count
    input wire [7:0] read_addr,   // word to show
    output wire [15:0] count      // word of the histogram [hits]
);
    (* ram_style = "distributed" *) reg [15:0] ram [0:255];

    integer i;
    initial for (i = 0; i < 256; i = i + 1) ram[i] = 16'd0;

    // One address for all three, so that a bit is one RAM256X1S.
    wire [7:0] addr = clear ? clear_addr : tdc_valid ? tdc_code : read_addr;
    wire [15:0] word = ram[addr];
    wire [15:0] word_next = clear ? 16'd0 : word + 16'd1;

    assign count = read_en ? word : 16'd0;

    always @(posedge clk_125) if (clear || tdc_valid) ram[addr] <= word_next;
endmodule
