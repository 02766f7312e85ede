`timescale 1ns/1ps
`default_nettype none

// Somebody else's coarse counter: other names, reset active low, the window as `closed`, and all
// outputs a clock later.
module shot_clock (
    input wire clk,
    input wire reset_n,
    input wire go,
    output reg [2:0] cycles,
    output reg closed
);
    reg [3:0] age = 4'd8;

    always @(posedge clk) begin
        cycles <= last;
        closed <= age[3];
        if (!reset_n) age <= 4'd8;
        else if (go) age <= 4'd0;
        else if (!age[3]) age <= age + 4'd1;
    end

    // What the counter has shown last: it stops at 7, but is 0 after a reset.
    reg [2:0] last = 3'd0;
    always @(posedge clk)
        if (!reset_n || go) last <= 3'd0;
        else if (!age[3] && age != 4'd7) last <= age[2:0] + 3'd1;

    initial begin
        cycles = 3'd0;
        closed = 1'b1;
    end
endmodule

`default_nettype wire
