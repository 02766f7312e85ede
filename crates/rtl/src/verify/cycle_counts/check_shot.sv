`default_nettype none

// What holds of vcsel_driver and spad_control in every cycle, whatever their inputs do, once they
// have been reset in the first. `HOLDS names the property to prove.
module check_shot #(
    parameter Code = 0,      // the laser_freq of the property
    parameter Expected = 25  // the number to prove [cycles of clk_sys]
) (
    input wire clk_sys,
    input wire clk_laser,
    input wire rst,
    input wire rst_laser,
    input wire acquire,
    input wire laser_en,
    input wire [`RATE_BITS-1:0] laser_freq,
    input wire mode
);
    wire pre_start, start, spad_rst;

    vcsel_driver `LASER vcsel_driver (
        .clk_sys(clk_sys),
        .clk_laser(clk_laser),
        .rst(rst),
        .rst_laser(rst_laser),
        .acquire(acquire),
        .laser_en(laser_en),
        .laser_freq(laser_freq),
        .pre_start(pre_start),
        .start(start)
    );

    spad_control spad_control (
        .clk_sys(clk_sys),
        .rst(rst),
        .mode(mode),
        .pre_start(pre_start),
        .spad_rst(spad_rst)
    );

    // A period begins with a start, or at an edge that finds acquire low. The laser_freq that this
    // edge finds is the code in force, whatever comes later.
    reg first = 1'b1;            // the first cycle
    reg [`RATE_BITS-1:0] found = 0;  // the laser_freq that the last edge found
    reg known = 1'b0;            // a period has begun since the reset
    reg shot = 1'b0;             // with a start
    reg [`RATE_BITS-1:0] code = 0;   // in force
    reg [`PERIOD_BITS:0] k = 0;      // cycles since the period began
    localparam [`PERIOD_BITS:0] zero = 0, one = 1;
    // The two edges before this cycle, the later one first
    reg [1:0] undisturbed = 2'd0;  // found acquire high and rst low
    reg [1:0] mode_1 = 2'd0;       // found mode high
    // The three cycles before this, the last first
    reg [2:0] pre_starts = 3'd0, spad_rsts = 3'd0;
    reg [1:0] width = 2'd0;      // cycles for which spad_rst had been high, 3 at most
    reg [1:0] in_mode_1 = 2'd0;  // cycles of spad_rst since the last start or MODE 0, 3 at most

    always @(posedge clk_sys) begin
        first <= 1'b0;
        found <= laser_freq;
        undisturbed <= {undisturbed[0], acquire && !rst};
        mode_1 <= {mode_1[0], mode};
        pre_starts <= {pre_starts[1:0], pre_start};
        spad_rsts <= {spad_rsts[1:0], spad_rst};
        width <= !spad_rst ? 2'd0 : &width ? width : width + 2'd1;
        if (start || !mode) in_mode_1 <= 2'd0;
        else if (spad_rst && mode_1[0] && !(&in_mode_1)) in_mode_1 <= in_mode_1 + 2'd1;
        if (rst) known <= 1'b0;
        else if (!acquire) {known, shot, code, k} <= {2'b10, laser_freq, zero};
        else if (start) {known, shot, code, k} <= {2'b11, found, one};
        else if (!(&k)) k <= k + one;
    end

    // The period in force has had no start so far, and has one in cycle Expected.
    wire on_time = k <= Expected && start == (k == Expected);
    wire laser_period = !(known && shot && code == Code) || on_time;
    wire first_shot = !(known && !shot && code == Code) || on_time;

    // If the two edges before it find neither a reset nor the end of acquire.
    wire [3:0] since_pre_start = {pre_starts, pre_start};
    wire pre_start_lead = !(&undisturbed) || start == since_pre_start[Expected];
    wire [3:0] since_spad_rst = {spad_rsts, spad_rst};
    wire spad_rst_lead = !(&undisturbed) || mode_1[1] || start == since_spad_rst[Expected];

    // Whatever the edges find.
    wire spad_rst_width = width <= Expected && (spad_rst || width == 0 || width == Expected);
    // In a cycle whose edge finds MODE 1; if a whole shot does, not fewer either.
    wire spad_rst_mode_1 = in_mode_1 + (spad_rst && mode_1[0]) <= Expected
        && !(start && &mode_1 && in_mode_1 != Expected);

    // Of a laser with parameters the registers are known; they make the induction go through without unrolling
    // a period.
`ifdef PERIODS
    (* hierconn *) wire [`PERIOD_BITS-1:0] \vcsel_driver.count ;
    (* hierconn *) wire [`PERIOD_BITS-1:0] \vcsel_driver.last ;
    localparam [127:0] Periods = `PERIODS;
    wire [15:0] last_found = Periods[16*found +: 16] - 16'd1, last_code = Periods[16*code +: 16] - 16'd1;
    wire in_step = !known || (start
        ? \vcsel_driver.count == 0 && \vcsel_driver.last == last_found
        : \vcsel_driver.count == k && \vcsel_driver.last == last_code && k <= last_code);
`else
    wire in_step = 1'b1;
`endif
