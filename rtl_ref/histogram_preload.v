`timescale 1ps / 1fs
`default_nettype none

// Stands in for the histogram: a ROM with the same read port, not clocked.
module histogram_preload #(
    parameter integer BinBits = 8,  // see histogram_builder
    parameter integer CountBits = 16,
    parameter HistogramFile = "rtl_ref/histogram.mem"  // [hits]
) (
    input wire [BinBits-1:0] read_addr,  // word to show
    output wire [CountBits-1:0] count    // word of the histogram [hits]
);
    reg [CountBits-1:0] rom [0:(1 << BinBits) - 1];
    initial $readmemh(HistogramFile, rom);

    assign count = rom[read_addr];
endmodule
