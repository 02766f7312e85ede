`timescale 1ps / 1fs
`default_nettype none

// Stands in for the histogram: a ROM with the same read port, not clocked.
module histogram_preload #(
    parameter HistogramFile = "rtl_ref/histogram.mem"  // [hits]
) (
    input wire [7:0] read_addr,  // word to show
    output wire [15:0] count     // word of the histogram [hits]
);
    reg [15:0] rom [0:255];
    initial $readmemh(HistogramFile, rom);

    assign count = rom[read_addr];
endmodule
