`default_nettype none

// What holds of frame_ctrl in every cycle while it scans an array, whenever it is reset, once it has been in the first.
// It has the shots and the estimates that the other promises give it: a start each `PERIOD cycles, the first so long
// after acquire rises, and algo_done `ESTIMATE cycles after the edge that takes algo_start. `HOLDS names the property to
// prove.
module check_scan #(
    parameter RowCycles = `ROW,      // from Clear to Clear
    parameter ImageCycles = `IMAGE,  // from the Clear of row 0 to the next one
    parameter Latency = `LATENCY     // from the fall of acquire to the row's last algo_done
) (
    input wire clk_sys,
    input wire rst
);
    localparam [0:0] Banked = `BANKS > 1;
    localparam [31:0] Acquired = `BINS + `SHOTS * `PERIOD + 1;  // the first cycle of Drain
    localparam [31:0] Drained = Acquired + `DRAIN;
    localparam [31:0] Estimation = `COLUMNS * (`ESTIMATE + 2);
    localparam [5:0] LastRow = `ROWS - 1, LastColumn = `COLUMNS - 1;

    wire clear, acquire, algo_start, frame_done, bank;
    wire [$clog2(`BINS)-1:0] clear_addr;
    wire [5:0] row, depth_row, depth_column;
    (* hierconn *) wire [1:0] \dut.state ;
    (* hierconn *) wire [15:0] \dut.shots ;
    (* hierconn *) wire [$clog2(`DRAIN)-1:0] \dut.drain ;
    (* hierconn *) wire \dut.estimating ;

    reg first = 1'b1;
    reg [31:0] since = 32'd0;    // cycles since acquire rose or the last start
    reg [31:0] working = 32'd0;  // cycles since algo_start, 0 without an estimate
    wire start = acquire && since == `PERIOD;
    wire algo_done = working == `ESTIMATE + 1;

    frame_ctrl #(
        .BinBits($clog2(`BINS)),
        .ShotsPerFrame(`SHOTS),
        .DrainCycles(`DRAIN),
        .Rows(`ROWS),
        .Columns(`COLUMNS),
        .Banks(`BANKS)
    ) dut (
        .clk_sys(clk_sys),
        .rst(rst),
        .start(start),
        .acquire(acquire),
        .dsp_rst(1'b0),
        .dsp_en(1'b1),
        .frame_done(frame_done),
        .calibrating(1'b0),
        .clear(clear),
        .clear_addr(clear_addr),
        .bank(bank),
        .depth_column(depth_column),
        .row(row),
        .depth_row(depth_row),
        .algo_start(algo_start),
        .algo_done(algo_done)
    );

    // Counts by itself.
    reg [31:0] t = 32'd0;      // cycle of the row
    reg [31:0] total = 32'd0;  // cycle of the image, as if no row had been shorter
    reg [5:0] own_row = 6'd0, last_row = 6'd0;
    reg turned = 1'b0;         // there has been a row since the reset
    reg own_bank = 1'b0;
    // With two banks the first row waits for no other.
    localparam [31:0] Spared = Banked ? `ROW - Drained : 0;
    wire turns = t == (Banked && !turned ? Drained : RowCycles) - 1;

    always @(posedge clk_sys) begin
        first <= 1'b0;
        since <= !acquire ? 32'd0 : start ? 32'd1 : since + 32'd1;
        working <= rst || algo_done ? 32'd0 : algo_start || working != 32'd0 ? working + 32'd1 : 32'd0;
        total <= rst ? Spared : total == ImageCycles - 1 ? 32'd0 : total + 32'd1;
        t <= rst || turns ? 32'd0 : t + 32'd1;
        if (rst) {turned, own_row, last_row, own_bank} <= 14'd0;
        else if (turns) begin
            turned <= 1'b1;
            last_row <= own_row;
            own_row <= own_row == LastRow ? 6'd0 : own_row + 6'd1;
            own_bank <= own_bank ^ Banked;
        end
    end

    // The estimates of the row before, or with one bank of this row.
    wire estimates = Banked ? turned && t < Estimation : t >= Drained;
    wire [31:0] in_estimation = Banked ? t : t - Drained;
    wire in_step = t < RowCycles && own_row <= LastRow
        && \dut.state == (t < `BINS ? 0 : t < Acquired ? 1 : Banked || t < Drained ? 2 : 3)
        && clear == (t < `BINS) && clear_addr == (t < `BINS ? t : 0)
        && acquire == (t >= `BINS && t < Acquired)
        && (!acquire || \dut.shots * `PERIOD + since == t - `BINS && since <= `PERIOD
            && \dut.shots < `SHOTS && (since != 0 || \dut.shots == 0))
        && (\dut.state != 2 || \dut.drain == (t < Drained ? t - Acquired : `DRAIN - 1))
        && row == (!Banked && t >= Drained ? (own_row == LastRow ? 6'd0 : own_row + 6'd1) : own_row)
        && bank == own_bank && (Banked || !own_bank) && \dut.estimating == (Banked && estimates)
        && algo_start == (estimates && working == 0)
        && (estimates
            ? depth_column * (`ESTIMATE + 2) + working == in_estimation && working <= `ESTIMATE + 1
                && depth_column <= LastColumn && depth_row == (Banked ? last_row : own_row)
            : depth_column == 0 && working == 0)
        && frame_done == (turned && t == (Banked ? Estimation : 0))
        && last_row <= LastRow && (!turned || own_row == (last_row == LastRow ? 6'd0 : last_row + 6'd1));

    wire row_cycles = 1'b1;
    wire image_cycles = total == own_row * `ROW + t + (turned ? 0 : Spared);
    wire depth_latency = !(algo_done && depth_column == LastColumn)
        || (Banked ? `ROW - Acquired + t : t - Acquired) == Latency;
