`default_nettype none

// What holds of the laser pulse in every half cycle of clk_laser, whatever the inputs do. One step
// of the proof is such a half cycle, `HALF; `HOLDS names the property to prove. It is the output
// register of synthesis that is proven; the one of simulation is what the bench measures.
module check_pulse #(
    parameter Expected = 2000  // the number to prove [ps]
) (
    input wire rst,
    input wire rst_laser,
    input wire acquire,
    input wire laser_en,
    input wire [`RATE_BITS-1:0] laser_freq
);
    (* gclk *) wire step;
    reg [1:0] half = 2'd3;  // half cycles since clk_sys rose; both clocks rise together
    always @(posedge step) half <= half + 2'd1;
    wire clk_sys = !half[1];
    wire clk_laser = !half[0];
    wire start, laser_on;

    vcsel_driver `LASER dut (
        .clk_sys(clk_sys),
        .clk_laser(clk_laser),
        .rst(rst),
        .rst_laser(rst_laser),
        .acquire(acquire),
        .laser_en(laser_en),
        .laser_freq(laser_freq),
        .start(start),
        .laser_on(laser_on)
    );

    reg first = 1'b1;           // the first cycle of clk_sys
    // The last three edges of clk_sys found acquire high and rst low.
    reg [2:0] undisturbed = 3'd0;
    reg [1:0] resets = 2'd3;     // the last two edges of clk_laser found rst_laser high
    reg [31:0] width = 32'd0;   // time for which laser_on had been high [ps]

    always @(posedge clk_sys) begin
        first <= 1'b0;
        undisturbed <= {undisturbed[1:0], acquire && !rst};
    end
    always @(posedge clk_laser) resets <= {resets[0], rst_laser};
    always @(posedge step) width <= laser_on ? width + `HALF : 32'd0;

    // Whatever the edges find, but that rst_laser cuts a pulse short that is longer than a cycle of clk_laser.
    wire is_cut = Expected > 2 * `HALF && |resets;
    wire laser_on_width = width <= Expected && (laser_on || width == 0 || width == Expected || is_cut);
    // If neither rst nor the end of acquire comes between the request and the laser edge.
    wire laser_on_lag = !(laser_on && width == 0 && &undisturbed) || start && `HALF * half == Expected;

    always @* begin
        if (first) assume (rst && rst_laser);
        else assert (`HOLDS);
    end
endmodule

// The output register of 7-series parts in its SAME_EDGE mode, after Xilinx UG471.
module ODDR #(
    parameter DDR_CLK_EDGE = "SAME_EDGE",
    parameter INIT = 1'b0,
    parameter SRTYPE = "SYNC"
) (
    input wire C,
    input wire CE,
    input wire D1,
    input wire D2,
    input wire R,
    input wire S,
    output wire Q
);
    reg q1 = INIT, q2 = INIT;
    always @(posedge C) begin
        if (R) {q1, q2} <= 2'b00;
        else if (S) {q1, q2} <= 2'b11;
        else if (CE) {q1, q2} <= {D1, D2};
    end
    assign Q = C ? q1 : q2;
endmodule
