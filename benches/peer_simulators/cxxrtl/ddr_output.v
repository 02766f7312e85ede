`default_nettype none

// Two flip-flops whose difference is the output, because CXXRTL has none for both edges.
module ddr_output (
    input wire clk_250,
    input wire d,
    output wire q
);
    reg rising, falling;
    initial {rising, falling} = 2'b00;

    always @(posedge clk_250) rising <= falling ^ d;
    always @(negedge clk_250) falling <= rising;

    assign q = rising ^ falling;
endmodule
