`timescale 1ps / 1ps
`default_nettype none
`include "edge.svh"

// As in rtl_ref, without a wire for every next value.
module frame_ctrl #(
    parameter [15:0] ShotsPerFrame = 16'd30000,
    parameter [0:0] Preloaded = 1'b0
) (
    input wire clk_125,
    input wire rst,
    input wire start,
    output reg acquire,
    input wire dsp_rst,
    input wire dsp_en,
    output reg frame_done,
    output reg clear,
    output reg [7:0] clear_addr,
    output reg algo_start,
    input wire algo_done
);
    localparam [1:0] Clear = 2'd0, Acquire = 2'd1, Drain = 2'd2, Estimate = 2'd3;

    reg [1:0] state;
    reg [15:0] shots;
    reg [3:0] drain;

    initial begin
        {acquire, frame_done, algo_start} = 3'd0;
        clear = 1'b1;
        clear_addr = 8'd0;
        state = Clear;
        shots = 16'd0;
        drain = 4'd0;
    end

    always @(`RISE_125) begin
        if (rst || dsp_rst) begin
            {acquire, frame_done, algo_start} <= 3'd0;
            clear <= 1'b1;
            clear_addr <= 8'd0;
            state <= Clear;
            shots <= 16'd0;
            drain <= 4'd0;
        end else if (state == Acquire) begin
            if (start) begin
                shots <= shots + 16'd1;
                if (shots + 16'd1 == ShotsPerFrame) begin
                    acquire <= 1'b0;
                    drain <= 4'd0;
                    state <= Drain;
                end
            end
        end else begin
            frame_done <= 1'b0;
            algo_start <= 1'b0;
            case (state)
                Clear: begin
                    if (clear_addr != 8'd255) begin
                        clear_addr <= clear_addr + 8'd1;
                    end else if (!Preloaded) begin
                        clear <= 1'b0;
                        clear_addr <= 8'd0;
                        acquire <= 1'b1;
                        shots <= 16'd0;
                        state <= Acquire;
                    end else if (dsp_en) begin
                        clear <= 1'b0;
                        clear_addr <= 8'd0;
                        algo_start <= 1'b1;
                        state <= Estimate;
                    end
                end
                Drain: begin
                    if (drain != 4'd15) begin
                        drain <= drain + 4'd1;
                    end else if (dsp_en) begin
                        algo_start <= 1'b1;
                        state <= Estimate;
                    end
                end
                default: begin
                    if (algo_done) begin
                        frame_done <= 1'b1;
                        clear <= 1'b1;
                        state <= Clear;
                    end
                end
            endcase
        end
    end
endmodule
