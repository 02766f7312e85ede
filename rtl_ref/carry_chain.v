`timescale 1ps / 1fs
`default_nettype none

// The tapped delay line of the TDC: taps of carry logic, all registered at every edge.
module carry_chain #(
    parameter integer Taps = 800,                    // 16 to 2000
    parameter DelaysFile = "rtl_ref/tap_delays.mem"  // for simulation: tdc_stop to each tap [fs]
) (
    input wire clk_sys,
    input wire tdc_stop,         // output of the SPAD, asynchronous
    output reg [Taps-1:0] taps  // level of each tap at the last edge
);
    initial taps = {Taps{1'b0}};

`ifdef SYNTHESIS
`ifdef ECP5
    // The inverse of tdc_stop runs up the chain, and each sum output inverts it again: a sum output
    // reaches the flip-flop beside it without passing through logic, and the carry itself reaches none.
    localparam integer Slices = (Taps + 1) / 2;

    wire [Slices:0] carry;
    wire [2*Slices-1:0] level;

    // Second half: COUT = !A1, whatever comes in.
    (* keep = "true" *)
    CCU2C #(
        .INIT0(16'h0000),
        .INIT1(16'h0005),
        .INJECT1_0("NO"),
        .INJECT1_1("NO")
    ) entry (
        .CIN(1'b0),
        .A0(1'b1), .B0(1'b1), .C0(1'b1), .D0(1'b1),
        .A1(tdc_stop), .B1(1'b1), .C1(1'b1), .D1(1'b1),
        .S0(), .S1(),
        .COUT(carry[0])
    );

    genvar k;
    generate
        for (k = 0; k < Slices; k = k + 1) begin : slice
            (* keep = "true" *)
            CCU2C #(
                .INIT0(16'hFFFF),
                .INIT1(16'hFFFF),
                .INJECT1_0("NO"),
                .INJECT1_1("NO")
            ) ccu2c (
                .CIN(carry[k]),
                .A0(1'b1), .B0(1'b1), .C0(1'b1), .D0(1'b1),
                .A1(1'b1), .B1(1'b1), .C1(1'b1), .D1(1'b1),
                .S0(level[2*k]), .S1(level[2*k+1]),
                .COUT(carry[k+1])
            );
        end
    endgenerate

    always @(posedge clk_sys) taps <= level[Taps-1:0];
`else
    // Every carry bit passes the one before it on, so tdc_stop runs up the column of slices.
    localparam integer Slices = (Taps + 3) / 4;

    wire [4*Slices-1:0] carry;

    genvar k;
    generate
        for (k = 0; k < Slices; k = k + 1) begin : slice
            (* keep = "true", DONT_TOUCH = "true" *)
            CARRY4 carry4 (
                .CI(k == 0 ? 1'b0 : carry[(k == 0 ? 0 : 4*k - 1)]),
                .CYINIT(k == 0 ? tdc_stop : 1'b0),
                .DI(4'b0000),
                .S(4'b1111),
                .CO(carry[4*k +: 4]),
                .O()
            );
        end
    endgenerate

    always @(posedge clk_sys) taps <= carry[Taps-1:0];
`endif
`else
    reg [39:0] arrival [0:Taps-1];    // time to each tap [fs]
    reg [39:0] sorted [0:Taps-1];     // the same, earliest first [fs]
    integer order [0:Taps-1];         // the taps in that order
    reg [Taps-1:0] reached [0:Taps];  // the taps that an edge has reached first, by their number

    reg level;                    // tdc_stop, as far as its changes are noted
    reg [63:0] changed [0:7];     // its last changes, a ring [fs after Epoch]
    reg [2:0] newest;             // the last of them

    // So long before time 0 are the changes that never were [fs].
    localparam [63:0] Epoch = 64'd1000000000000;

    integer i, place;
    initial begin
        $readmemh(DelaysFile, arrival);
        for (i = 0; i < Taps; i = i + 1) begin
            place = i;
            while (place > 0 && sorted[place-1] > arrival[i]) begin
                sorted[place] = sorted[place-1];
                order[place] = order[place-1];
                place = place - 1;
            end
            sorted[place] = arrival[i];
            order[place] = i;
        end
        reached[0] = {Taps{1'b0}};
        for (i = 0; i < Taps; i = i + 1) begin
            reached[i+1] = reached[i];
            reached[i+1][order[i]] = 1'b1;
        end
    end

    // Number of taps that a change of this age has reached; one that it reaches just now counts.
    function integer rank;
        input [63:0] age;
        integer low, high, middle;
        begin
            low = 0;
            high = Taps;
            while (low < high) begin
                middle = (low + high) / 2;
                if ({24'd0, sorted[middle]} <= age) low = middle + 1;
                else high = middle;
            end
            rank = low;
        end
    endfunction

    // Rounds to the nearest femtosecond. A variable for the time, because Verilator 5.006 cuts a
    // $realtime inside an expression down to whole picoseconds.
    function [63:0] fs_after_epoch;
        input real time_ps;
        // verilator lint_off REALCVT
        fs_after_epoch = time_ps * 1000.0 + Epoch;
        // verilator lint_on REALCVT
    endfunction

    integer k;
    initial begin
        level = 1'b0;
        newest = 3'd0;
        for (k = 0; k < 8; k = k + 1) changed[k] = 64'd0;
    end

    // A second change in the same instant has to see the first.
    // verilator lint_off BLKSEQ
    always @(tdc_stop) if (tdc_stop != level) begin
        level = tdc_stop;
        newest = newest + 3'd1;
        changed[newest] = fs_after_epoch($realtime);
    end
    // verilator lint_on BLKSEQ

    // Each tap shows the present level, turned over by every change that has not reached it. A
    // change of this very instant has reached none, so it does not matter which block runs first.
    always @(posedge clk_sys) begin : sample
        reg [63:0] now, age;
        reg [Taps-1:0] levels;
        reg [2:0] change;  // a name of its own, so that it wraps in every simulator
        integer n;
        now = fs_after_epoch($realtime);
        levels = {Taps{level}};
        change = newest;
        age = now - changed[change];
        n = 1;
        while (n <= 8 && age < {24'd0, sorted[Taps-1]}) begin
            levels = levels ^ ~reached[rank(age)];
            change = change - 3'd1;
            age = now - changed[change];
            n = n + 1;
        end
        taps <= levels;
    end
`endif
endmodule
