`timescale 1ns/1ps
`default_nettype none

// An estimator that takes the whole histogram at once, as in the thesis's Fig. 6.18: everything in
// one clock, for simulation only, and shown 20 clocks after the start is taken.
module estimator #(
    parameter W1 = "",
    parameter B1 = "",
    parameter W2 = "",
    parameter B2 = "",
    parameter TABLE = ""
) (
    input wire clk,
    input wire rst,
    input wire start,
    input wire [4095:0] y,
    output reg signed [35:0] distance,
    output reg ready
);
    reg [127:0] w1 [0:255];
    reg [127:0] b1 [0:0];
    reg [127:0] w2 [0:0];
    reg [15:0] b2 [0:0];
    reg [15:0] tanh [0:4095];
    initial begin
        $readmemh(W1, w1);
        $readmemh(B1, b1);
        $readmemh(W2, w2);
        $readmemh(B2, b2);
        $readmemh(TABLE, tanh);
        distance = 36'd0;
        ready = 1'b0;
    end

    function signed [35:0] forward;
        input [4095:0] y;
        reg signed [35:0] sum, total;
        reg signed [36:0] rounded;
        reg [11:0] address;
        integer i, j;
        begin
            total = $signed(b2[0]) * 36'sd4096;
            for (j = 0; j < 8; j = j + 1) begin
                sum = $signed(b1[0][16 * j +: 16]) * 36'sd1024;
                for (i = 0; i < 256; i = i + 1)
                    sum = sum + $signed({20'd0, y[16 * i +: 16]}) * $signed(w1[i][16 * j +: 16]);
                rounded = (sum + 37'sd8192) >>> 14;
                if (rounded > 37'sd2047) rounded = 37'sd2047;
                if (rounded < -37'sd2048) rounded = -37'sd2048;
                address = rounded[11:0];
                total = total + $signed(tanh[address]) * $signed(w2[0][16 * j +: 16]);
            end
            forward = total;
        end
    endfunction

    reg [5:0] wait_for = 6'd0;
    always @(posedge clk) begin
        ready <= wait_for == 6'd1;
        if (start) begin
            distance <= forward(y);
            wait_for <= 6'd20;
        end else if (wait_for != 6'd0) wait_for <= wait_for - 6'd1;
        if (rst) begin
            ready <= 1'b0;
            wait_for <= 6'd0;
        end
    end
endmodule

`default_nettype wire
