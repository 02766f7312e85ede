`timescale 1ps / 1fs
`default_nettype none

// The device with its photons, for Icarus: vvp bench.vvp +freq=N +frames=N +photons=FILE. The clocks are those of rtl_ref/pll.v. Says when it has read the photons, so that
// whoever started it can take the time.
module bench;
    parameter [15:0] ShotsPerFrame = 16'd30000;

    reg clk_in = 1'b0;
    reg tdc_stop = 1'b0;
    reg [1:0] laser_freq;
    wire laser_on, spad_rst, algo_done;
    wire signed [35:0] depth;

    integer photons [0:65535];  // from the laser edge, or -1 [fs]
    integer frames, done, shot, edges, file, count, at;
    reg [8*256:1] name;

    initial begin
        done = 0;
        shot = 0;
        edges = 0;
        count = 0;
        if (!$value$plusargs("freq=%d", laser_freq)) laser_freq = 2'd3;
        if (!$value$plusargs("frames=%d", frames)) frames = 1;
        if (!$value$plusargs("photons=%s", name)) $finish;
        file = $fopen(name, "r");
        while ($fscanf(file, "%d", at) == 1) begin
            photons[count] = at;
            count = count + 1;
        end
        $display("begin");
        $fflush;
    end

    always #2500 clk_in = !clk_in;

    tof_top #(
        .ShotsPerFrame(ShotsPerFrame)
    ) tof_top (
        .clk_in(clk_in),
        .rst(1'b0),
        .locked(),
        .laser_on_lvds_p(laser_on),
        .laser_on_lvds_n(),
        .tdc_stop(tdc_stop),
        .spad_rst(spad_rst),
        .spad_sel(),
        .mode(1'b0),
        .laser_freq(laser_freq),
        .laser_en(1'b1),
        .dsp_en(1'b1),
        .dsp_rst(1'b0),
        .depth(depth),
        .algo_done(algo_done),
        .hist_valid(),
        .hist_bin(),
        .hist_count(),
        .frame_done()
    );

    // The detector in MODE 0.
    always @(posedge laser_on) begin
        at = photons[shot % count];
        shot = shot + 1;
        if (at >= 0) fork : avalanche
            begin
                #(at / 1000.0) tdc_stop = 1'b1;
                disable avalanche;
            end
            @(posedge spad_rst) disable avalanche;
        join
    end

    always @(posedge spad_rst) tdc_stop = 1'b0;

    always @(posedge tof_top.clk_sys) edges = edges + 1;

    always @(negedge tof_top.clk_sys) if (algo_done) begin
        $display("frame %h %0d %0d", depth, shot, edges - 1);
        shot = 0;
        done = done + 1;
        if (done == frames) $finish(0);
    end
endmodule
