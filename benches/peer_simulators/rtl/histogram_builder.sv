`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// Touches the RAM only when a port asks for it.
module histogram_builder (
    input wire clk_125,
    input wire clear,
    input wire [7:0] clear_addr,
    input wire tdc_valid,
    input wire [7:0] tdc_code,
    input wire read_en,
    input wire [7:0] read_addr,
    output wire [15:0] count
);
    reg [15:0] ram [0:255];

    // verilator tracing_off
    integer i;
    initial for (i = 0; i < 256; i = i + 1) ram[i] = 16'd0;
    // verilator tracing_on

    assign count = !read_en ? 16'd0 : ram[clear ? clear_addr : tdc_valid ? tdc_code : read_addr];

    always @(`RISE_125) begin
        if (clear) ram[clear_addr] <= 16'd0;
        else if (tdc_valid) ram[tdc_code] <= ram[tdc_code] + 16'd1;
    end
endmodule
