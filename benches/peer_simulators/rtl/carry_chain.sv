`timescale 1ps / 1fs
`default_nettype none
`include "edge.svh"

// The chain works only while a transition travels in it, and looks its taps up by rank.
module carry_chain #(
    parameter DelaysFile = "rtl_ref/tap_delays.mem"  // tdc_stop to each tap [fs]
) (
    input wire clk_125,
    input wire tdc_stop,
    output reg [799:0] taps
);
    // verilator tracing_off
    localparam integer Cell = 13;  // ages that share an entry of the guide, as a power of two

    reg [63:0] sorted [0:1023];   // time to each tap, earliest first; the rest never [fs]
    reg [799:0] reached [0:1023]; // the taps that an edge has reached first, by their number
    reg [9:0] guide [0:4095];     // how many of them at the begin of a cell of ages

    reg level;                    // tdc_stop, as far as its changes are noted
    reg [63:0] changed [0:7];     // its last changes, a ring [fs]
    reg [2:0] newest;             // the last of them
    reg [3:0] travelling;         // how many have not left the chain

    integer order [0:799];
    integer i, place;
    initial begin
        taps = 800'd0;
        $readmemh(DelaysFile, sorted, 0, 799);
        for (i = 0; i < 800; i = i + 1) order[i] = i;
        for (i = 1; i < 800; i = i + 1) begin : insert
            reg [63:0] at;
            at = sorted[i];
            place = i;
            while (place > 0 && sorted[place-1] > at) begin
                sorted[place] = sorted[place-1];
                order[place] = order[place-1];
                place = place - 1;
            end
            sorted[place] = at;
            order[place] = i;
        end
        for (i = 800; i < 1024; i = i + 1) sorted[i] = ~64'd0;
        reached[0] = 800'd0;
        for (i = 0; i < 1023; i = i + 1) reached[i+1] = 800'd0;
        for (i = 0; i < 800; i = i + 1) reached[i+1] = reached[i] | (800'd1 << order[i]);
        place = 0;
        for (i = 0; i < 4096; i = i + 1) begin
            while (sorted[place] < {20'd0, i, 12'd0} << (Cell - 12)) place = place + 1;
            guide[i] = place[9:0];
        end
        level = 1'b0;
        newest = 3'd0;
        travelling = 4'd0;
        for (i = 0; i < 8; i = i + 1) changed[i] = 64'd0;
    end

`ifdef SELF_CLOCKED
    wire [63:0] edge_at = tof_top.pll.edge_at;
    wire [63:0] stop_at = bench.stop_at;
`elsif VERILATOR
    // The harness hands the times in: of this edge, and of the change of tdc_stop since the last
    // one, of which there is one at most in MODE 0.
    reg [63:0] edge_at /* verilator public_flat_rw */ = 64'd0;  // [fs]
    reg [63:0] stop_at /* verilator public_flat_rw */ = 64'd0;  // [fs]
`else
    reg [63:0] edge_at, stop_at;
    always @(tdc_stop) begin
        stop_at = $realtime * 1000.0;
    end
`endif

    // verilator lint_off BLKSEQ
    always @(`RISE_125) begin : sample
        reg [799:0] levels;
        reg [63:0] age;
        reg [9:0] rank;
        reg [2:0] change;
        reg [3:0] n;
        if (tdc_stop != level) begin
            level = tdc_stop;
            newest = newest + 3'd1;
            changed[newest] = stop_at;
            if (travelling != 4'd8) travelling = travelling + 4'd1;
        end
        if (travelling != 4'd0) begin
`ifndef VERILATOR
            edge_at = $realtime * 1000.0;
`endif
            change = newest;
            for (n = 4'd0; n < travelling; n = n + 4'd1) begin
                age = edge_at - changed[change];
                if (age < sorted[799]) begin
                    rank = guide[age[Cell+11:Cell]];
                    while (sorted[rank] <= age) rank = rank + 10'd1;
                    levels = n == 4'd0 ? {800{!level}} ^ reached[rank] : levels ^ ~reached[rank];
                    change = change - 3'd1;
                end else begin
                    if (n == 4'd0) levels = {800{level}};
                    travelling = n;
                end
            end
            taps <= levels;
        end
    end
    // verilator lint_on BLKSEQ
    // verilator tracing_on
endmodule
