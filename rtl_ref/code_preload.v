`timescale 1ps / 1fs
`default_nettype none

// Stands in for the TDC: a code from a ROM for every shot.
module code_preload #(
    parameter integer BinBits = 8,    // of a code
    parameter integer Codes = 27756,  // words of the ROM, 1 to 65536
    parameter CodeFile = "rtl_ref/codes.mem"  // [bins]
) (
    input wire clk_sys,
    input wire rst,
    input wire start,                  // a shot begins
    output reg tdc_valid,              // tdc_code is new; one cycle
    output reg [BinBits-1:0] tdc_code  // code of the shot [bins]
);
    localparam [15:0] LastCode = Codes[15:0] - 16'd1;
    localparam integer AddressBits = Codes > 1 ? $clog2(Codes) : 1;

    reg pending;          // start, an edge later
    reg [15:0] rom_addr;  // next word of the ROM

    reg tdc_valid_next, pending_next;
    reg [BinBits-1:0] tdc_code_next;
    reg [15:0] rom_addr_next;

    reg [BinBits-1:0] rom [0:Codes-1];
    initial $readmemh(CodeFile, rom);

    wire [BinBits-1:0] code = rom[rom_addr[AddressBits-1:0]];

    initial begin
        {tdc_valid, pending} = 2'd0;
        tdc_code = {BinBits{1'b0}};
        rom_addr = 16'd0;
    end

    always @* begin
        pending_next = start;
        tdc_valid_next = pending;
        tdc_code_next = tdc_code;
        rom_addr_next = rom_addr;
        if (pending) begin
            tdc_code_next = code;
            rom_addr_next = rom_addr == LastCode ? 16'd0 : rom_addr + 16'd1;
        end
    end

    always @(posedge clk_sys) begin
        if (rst) begin
            tdc_valid <= 1'b0;
            tdc_code <= {BinBits{1'b0}};
            pending <= 1'b0;
            rom_addr <= 16'd0;
        end else begin
            tdc_valid <= tdc_valid_next;
            tdc_code <= tdc_code_next;
            pending <= pending_next;
            rom_addr <= rom_addr_next;
        end
    end
endmodule
