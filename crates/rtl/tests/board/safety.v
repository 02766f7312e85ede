`timescale 1ps / 1fs
`default_nettype none

// A board's top compiled for synthesis, a host on its serial line, and each rule of laser_guard broken in turn. Around each
// it prints the laser's output, every nanosecond.
module safety;
    // Eight cycles a bit of the serial line; how long the host may be silent [cycles].
    localparam integer Bit = 8 * 8000, Timeout = 3000;
    localparam integer Control = 14'h008, Arm = 14'h00a, Faults = 14'h00c, Key = 32'h4c415352;

    reg clk_in, runs, uart_rx, interlock;
    wire laser, uart_tx, armed;

`ifdef KC705
    kc705_top top (
        .sysclk_p(clk_in),
        .sysclk_n(!clk_in),
        .cpu_reset(1'b0),
        .armed(armed),
        .select_pins(1'b0),
`define GUARD top.tof_top.laser_guard
`define LOST force top.tof_top.pll.plle2.LOCKED = 1'b0
`define FOUND release top.tof_top.pll.plle2.LOCKED
`else
    wire armed_n, clk_in_en;

    assign armed = !armed_n;
    ecp5_top top (
        .clk_in(clk_in),
        .clk_in_en(clk_in_en),
        .reset_n(1'b1),
        .armed_n(armed_n),
        .select_pins_n(1'b1),
`define GUARD top.tof_top.laser_guard
`define LOST force top.tof_top.pll.ehxplll.LOCK = 1'b0
`define FOUND release top.tof_top.pll.ehxplll.LOCK
`endif
        .laser_on_lvds_p(laser),
        .tdc_stop(1'b0),
        .mode(1'b0),
        .laser_freq(2'd0),
        .laser_en(1'b0),
        .dsp_en(1'b0),
        .dsp_rst(1'b0),
        .uart_rx(uart_rx),
        .uart_tx(uart_tx),
        .interlock(interlock)
    );
    defparam top.Calibrated = 1'b0;
    defparam top.tof_top.Baud = 64'd15625000;
    defparam top.tof_top.HostTimeout = Timeout;
    // 8 ns.
    defparam top.tof_top.PulseHalfCycles = 4;
    defparam top.tof_top.LongestPulse = 4;
    defparam top.tof_top.CalFile = "cal.mem";
    defparam top.tof_top.Taps = 64;

    initial begin
        clk_in = 1'b0;
        runs = 1'b1;
        #5000;
        forever begin
            if (runs) clk_in = !clk_in;
            #2500;
        end
    end

    task send;
        input [7:0] value;
        integer place;
        begin
            uart_rx = 1'b0;
            #Bit;
            for (place = 0; place < 8; place = place + 1) begin
                uart_rx = value[place];
                #Bit;
            end
            uart_rx = 1'b1;
            #Bit;
        end
    endtask

    task write;
        input [31:0] address, word;
        begin
            send(8'd1);
            send(8'd1);
            send_word(address);
            send_word(word);
        end
    endtask

    task send_word;
        input [31:0] word;
        begin
            send(word[31:24]);
            send(word[23:16]);
            send(word[15:8]);
            send(word[7:0]);
        end
    endtask

    // A word that the host reads.
    reg [31:0] heard;
    integer bit_place, byte_place;
    task read;
        input [31:0] address;
        begin
            fork
                begin
                    send(8'd2);
                    send(8'd1);
                    send_word(address);
                end
                for (byte_place = 0; byte_place < 4; byte_place = byte_place + 1) begin
                    @(negedge uart_tx);
                    #(Bit / 2);
                    heard = heard << 8;
                    for (bit_place = 0; bit_place < 8; bit_place = bit_place + 1) begin
                        #Bit heard[bit_place] = uart_tx;
                    end
                    #Bit;
                end
            join
        end
    endtask

    // The last nanoseconds.
    reg [63:0] lasers, offs;
    always #1000 begin
        lasers = {lasers[62:0], laser};
        offs = {offs[62:0], `GUARD.laser_off};
    end
    task show;
        input [22*8-1:0] rule;
        integer place;
        begin
            #24000;
            $write("%0s\n  laser      ", rule);
            for (place = 31; place >= 0; place = place - 1) $write("%s", lasers[place] ? "#" : "_");
            $write("\n  laser_off  ");
            for (place = 31; place >= 0; place = place - 1) $write("%s", offs[place] ? "#" : "_");
            $write("\n");
        end
    endtask
    // What the host reads of it, and the pulses of the next 4 us.
    integer pulses;
    always @(posedge laser) pulses = pulses + 1;
    task settle;
        begin
            read(Faults);
            pulses = 0;
            #4000000;
            $display("  laser_faults %b, armed %b, then %0d pulses", heard[4:0], armed, pulses);
        end
    endtask
    task ready;
        begin
            write(Arm, Key);
            pulses = 0;
            #1000000;
            if (!armed || pulses < 2) $display("not ready: armed %b, %0d pulses", armed, pulses);
        end
    endtask

    initial begin
        {uart_rx, interlock} = 2'b10;
        pulses = 0;
        #3000000;
        // The laser enabled, no calibration, no reset; frames acquire.
        write(Control, 32'h00000001);
        #4000000;
        $display("not armed\n  armed %b, %0d pulses", armed, pulses);
        ready;
        @(negedge armed);
        show("host_silent");
        settle;

        ready;
        @(posedge laser) #2300;
        // The clock stops where it is, and the PLL finds that out 10 ns later.
        force top.tof_top.vcsel_driver.ddr_output.clk_laser = 1'b1;
        force top.tof_top.clk_sys = 1'b1;
        force top.tof_top.clk_laser = 1'b1;
        #10000 `LOST;
        show("unlocked");
        `FOUND;
        release top.tof_top.vcsel_driver.ddr_output.clk_laser;
        release top.tof_top.clk_sys;
        release top.tof_top.clk_laser;
        #200000;
        settle;

        write(Control, 32'h00000001);
        ready;
        @(posedge laser) #2300 interlock = 1'b1;
        show("interlocked");
        interlock = 1'b0;
        settle;

        ready;
        @(posedge top.tof_top.vcsel_driver.laser_pulse[0]);
        force top.tof_top.vcsel_driver.laser_pulse = 2'b11;
        show("pulse_too_long");
        release top.tof_top.vcsel_driver.laser_pulse;
        settle;

        ready;
        @(negedge laser);
        #6000 force top.tof_top.vcsel_driver.laser_pulse = 2'b11;
        #4000 release top.tof_top.vcsel_driver.laser_pulse;
        show("rate_too_high");
        settle;
        $finish;
    end

    // Longer than all of it takes: a faulty guard may never do what is waited for.
    initial begin
        #400000000;
        $display("does not end");
        $finish;
    end
endmodule
