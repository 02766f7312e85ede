`define COARSE_BITS 3
`define LAST_COARSE 3'd7
