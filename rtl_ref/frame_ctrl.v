`timescale 1ps / 1fs
`default_nettype none

// Runs a frame: clear the histograms, acquire, let the TDCs drain, estimate column by column, again. In an array a
// frame is a row, and with two banks of histograms one is read while the other is filled.
module frame_ctrl #(
    parameter integer BinBits = 8,  // see histogram_builder
    parameter integer CountBits = 16,
    parameter [23:0] ShotsPerFrame = 24'd30000,  // [shots]
    parameter [0:0] Preloaded = 1'b0,            // skips Acquire and Drain
    parameter [16:0] DrainCycles = 17'd16,       // longer than a photon's way to its word
    parameter [0:0] Calibrated = 1'b0,           // looks at calibrating
    parameter integer Rows = 1,                  // of the array, 1 to 40
    parameter integer Columns = 1,               // of the array, 1 to 64
    parameter integer Banks = 1                  // of histograms, 1 or 2
) (
    input wire clk_sys,
    input wire rst,
    // vcsel_driver
    input wire start,                     // a shot begins
    output reg acquire,                   // lets the laser's counter run
    // Acquisition computer
    input wire dsp_rst,                   // abandons the frame
    input wire dsp_en,                    // lets the estimator start
    output reg frame_done,                // the frame has ended; one cycle
    // tdc_calibration
    // verilator lint_off UNUSEDSIGNAL
    input wire calibrating,               // holds the last cycle of Clear
    // verilator lint_on UNUSEDSIGNAL
    // histogram_builder
    output reg clear,                     // sets a word of the histogram to zero
    output reg [BinBits-1:0] clear_addr,  // which word
    output reg bank,                      // bank that is filled
    output reg [5:0] depth_column,        // column that is read
    // spad_control
    output reg [5:0] row,                 // row that acquires
    // depth_estimator
    output reg [5:0] depth_row,           // row whose depths are estimated
    output reg algo_start,                // starts the estimator; one cycle
    input wire algo_done                  // the estimator has finished
);
    localparam integer DrainBits = $clog2(DrainCycles);
    localparam [16:0] LastDrain = DrainCycles - 17'd1;
    localparam integer LastRow = Rows - 1, LastColumn = Columns - 1;
    localparam [0:0] Banked = Banks > 1;
    localparam [1:0] Clear = 2'd0, Acquire = 2'd1, Drain = 2'd2, Estimate = 2'd3;

    wire waits = Calibrated && calibrating;
    reg [1:0] state;            // state of the frame
    reg [CountBits-1:0] shots;  // shots begun in this frame
    reg [DrainBits-1:0] drain;  // cycles spent in Drain
    reg estimating;             // the other bank is being read

    reg acquire_next, frame_done_next, clear_next, algo_start_next;
    reg [BinBits-1:0] clear_addr_next;
    reg [1:0] state_next;
    reg [CountBits-1:0] shots_next;
    reg [DrainBits-1:0] drain_next;
    reg bank_next, estimating_next;
    reg [5:0] row_next, depth_row_next, depth_column_next;

    initial begin
        {acquire, frame_done, algo_start} = 3'd0;
        clear = 1'b1;
        clear_addr = {BinBits{1'b0}};
        state = Clear;
        shots = {CountBits{1'b0}};
        drain = {DrainBits{1'b0}};
        {bank, estimating} = 2'd0;
        {row, depth_row, depth_column} = 18'd0;
    end

    always @* begin
        acquire_next = acquire;
        frame_done_next = 1'b0;
        clear_next = clear;
        clear_addr_next = clear_addr;
        algo_start_next = 1'b0;
        state_next = state;
        shots_next = shots;
        drain_next = drain;
        bank_next = bank;
        estimating_next = estimating;
        row_next = row;
        depth_row_next = depth_row;
        depth_column_next = depth_column;
        case (state)
            Clear: begin
                if (!(&clear_addr)) begin
                    clear_addr_next = clear_addr + 1'b1;
                end else if (!Preloaded && !waits) begin
                    clear_next = 1'b0;
                    clear_addr_next = {BinBits{1'b0}};
                    acquire_next = 1'b1;
                    shots_next = {CountBits{1'b0}};
                    state_next = Acquire;
                end else if (dsp_en && !waits) begin
                    clear_next = 1'b0;
                    clear_addr_next = {BinBits{1'b0}};
                    algo_start_next = 1'b1;
                    state_next = Estimate;
                end
            end
            Acquire: begin
                if (start) begin
                    shots_next = shots + 1'b1;
                    if (shots_next == ShotsPerFrame[CountBits-1:0]) begin
                        acquire_next = 1'b0;
                        drain_next = {DrainBits{1'b0}};
                        state_next = Drain;
                    end
                end
            end
            Drain: begin
                if (drain != LastDrain[DrainBits-1:0]) begin
                    drain_next = drain + 1'b1;
                end else if (dsp_en && !estimating) begin
                    algo_start_next = 1'b1;
                    depth_row_next = row;
                    row_next = Rows == 1 || row == LastRow[5:0] ? 6'd0 : row + 6'd1;
                    estimating_next = Banked;
                    bank_next = Banked && !bank;
                    clear_next = Banked;
                    state_next = Banked ? Clear : Estimate;
                end
            end
            Estimate: begin
                if (algo_done && (Columns == 1 || depth_column == LastColumn[5:0])) begin
                    clear_next = 1'b1;
                    state_next = Clear;
                end
            end
        endcase
        if (algo_done && (estimating || state == Estimate)) begin
            if (Columns > 1 && depth_column != LastColumn[5:0]) begin
                depth_column_next = depth_column + 6'd1;
                algo_start_next = 1'b1;
            end else begin
                depth_column_next = 6'd0;
                estimating_next = 1'b0;
                frame_done_next = 1'b1;
            end
        end
    end

    always @(posedge clk_sys) begin
        if (rst || dsp_rst) begin
            acquire <= 1'b0;
            frame_done <= 1'b0;
            clear <= 1'b1;
            clear_addr <= {BinBits{1'b0}};
            algo_start <= 1'b0;
            state <= Clear;
            shots <= {CountBits{1'b0}};
            drain <= {DrainBits{1'b0}};
            {bank, estimating} <= 2'd0;
            {row, depth_row, depth_column} <= 18'd0;
        end else begin
            acquire <= acquire_next;
            frame_done <= frame_done_next;
            clear <= clear_next;
            clear_addr <= clear_addr_next;
            algo_start <= algo_start_next;
            state <= state_next;
            shots <= shots_next;
            drain <= drain_next;
            {bank, estimating} <= {bank_next, estimating_next};
            {row, depth_row, depth_column} <= {row_next, depth_row_next, depth_column_next};
        end
    end
endmodule
