`timescale 1ps / 1fs
`default_nettype none

// Brings the reset into one clock domain.
module reset_sync (
    input wire clk,       // clock of the domain
    input wire rst,       // reset button of the board, asynchronous
    input wire locked,    // the PLL has locked
    (* ASYNC_REG = "TRUE" *) output reg rst_sync  // synchronous reset of the domain, active high
);
    (* ASYNC_REG = "TRUE" *) reg meta;  // may go metastable

    // The reset holds from configuration on, before the first edge.
    initial {rst_sync, meta} = 2'b11;

    always @(posedge clk) begin
        meta <= rst | ~locked;
        rst_sync <= meta;
    end
endmodule
