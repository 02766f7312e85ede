`timescale 1ns/1ps

// A frame of 300 shots, a constant here: clear, shoot, wait for the TDC, estimate.
module frame_machine
    import shot_pkg::*;
(
    input  logic       clk,
    input  logic       rst_n,
    input  logic       shot,
    input  logic       abandon,
    input  logic       may_solve,
    input  logic       solved,
    output logic       acquire,
    output logic       frame_done,
    output logic       clear,
    output logic [7:0] clear_word,
    output logic       estimate
);
    phase_t phase;
    logic [$clog2(SHOTS+1)-1:0] left;
    logic [3:0] wait_left;

    assign clear = phase == CLEARING;
    assign acquire = phase == SHOOTING;

    always_ff @(posedge clk) begin
        frame_done <= 1'b0;
        estimate <= 1'b0;
        unique case (phase)
            CLEARING: begin
                clear_word <= clear_word + 1'b1;
                if (&clear_word) begin
                    phase <= SHOOTING;
                    left <= SHOTS;
                end
            end
            SHOOTING: if (shot) begin
                left <= left - 1'b1;
                if (left == 1) begin
                    phase <= WAITING;
                    wait_left <= '1;
                end
            end
            WAITING: begin
                if (wait_left != 0) wait_left <= wait_left - 1'b1;
                else if (may_solve) begin
                    phase <= SOLVING;
                    estimate <= 1'b1;
                end
            end
            SOLVING: if (solved) begin
                phase <= CLEARING;
                frame_done <= 1'b1;
            end
        endcase
        if (!rst_n || abandon) begin
            phase <= CLEARING;
            clear_word <= '0;
            frame_done <= 1'b0;
            estimate <= 1'b0;
        end
    end
endmodule
