`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// As in rtl_ref, without a wire for every next value.
module vcsel_driver (
    input wire clk_125,
    input wire clk_250,
    input wire rst,
    input wire rst_250,
    input wire acquire,
    input wire laser_en,
    input wire [1:0] laser_freq,
    output reg pre_start,
    output reg start,
    output wire laser_on
);
    reg fire;
    reg [4:0] count;
    reg [4:0] last;
    reg enable;
    reg laser_pulse;

    initial begin
        {pre_start, start, fire, enable, laser_pulse} = 5'd0;
        {count, last} = 10'd0;
    end

    always @(`RISE_125) begin
        if (rst) begin
            {pre_start, start, fire, enable} <= 4'd0;
            {count, last} <= 10'd0;
        end else begin
            pre_start <= acquire && count + 5'd2 == last;
            fire <= acquire && count + 5'd1 == last && enable;
            start <= acquire && count == last;
            count <= count + 5'd1;
            if (!acquire || count == last) begin
                count <= 5'd0;
                case (laser_freq)
                    2'd0: last <= 5'd24;
                    2'd1: last <= 5'd12;
                    2'd2: last <= 5'd7;
                    default: last <= 5'd5;
                endcase
                enable <= laser_en;
            end
        end
    end

`ifdef SELF_CLOCKED
    always @(edge clk_250)
        if (tof_top.pll.rises) laser_pulse <= !rst_250 && fire && !laser_pulse;
`else
    always @(posedge clk_250) laser_pulse <= !rst_250 && fire && !laser_pulse;
`endif

    ddr_output ddr_output (
        .clk_250(clk_250),
        .d(laser_pulse),
        .q(laser_on)
    );
endmodule
