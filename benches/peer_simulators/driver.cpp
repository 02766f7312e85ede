// Times a model that Verilator has made; with TRACE_VCD or TRACE_FST, together with a waveform of
// every instant at which something changes.
#include "protocol.h"
#include "verilated.h"

#include "Vtof_top.h"
#include "Vtof_top___024root.h"
#if defined(TRACE_VCD)
#include "verilated_vcd_c.h"
using Waveform = VerilatedVcdC;
#elif defined(TRACE_FST)
#include "verilated_fst_c.h"
using Waveform = VerilatedFstC;
#endif

class Bench {
public:
    explicit Bench(const Arguments &arguments) : frames(arguments.frames), spad(arguments.photons) {
        top.laser_freq = arguments.laser_freq;
        top.laser_en = top.dsp_en = 1;
        top.mode = top.dsp_rst = top.rst = top.tdc_stop = top.clk_in = 0;
        open(arguments.waveform);
        eval(0);
    }

    void run() {
        double begun = seconds();
        until(FIRST_EDGE - CYCLE);
        show(FIRST_EDGE - CYCLE);
        top.rootp->tof_top__DOT__pll__DOT__lock = 1;
        eval(FIRST_EDGE - CYCLE);
        for (int64_t now = FIRST_EDGE; done < frames; now += CYCLE) {
            until(now);
            clocks(3, now);
            react(now);
            for (int quarter = 1; quarter < 4; quarter++) {
                until(now + quarter * (CYCLE / 4));
                clocks(3 - quarter, now + quarter * (CYCLE / 4));
            }
            edge++;
        }
        close();
        std::printf("seconds %.9f\n", seconds() - begun);
        top.final();
    }

private:
    VerilatedContext context;
    Vtof_top top{&context};
    const int frames;
    int done = 0;
    uint64_t edge = 0;
    Spad spad;

    void clocks(int levels, int64_t now) {
        show(now);
        top.rootp->tof_top__DOT__pll__DOT__clocks = levels;
        eval(now);
    }

    void stop(bool level, int64_t now) {
        show(now);
        top.tdc_stop = level;
        eval(now);
    }

    // What the detector and the outside do about the edge at `now`.
    void react(int64_t now) {
        if (top.laser_on_lvds_p) spad.begin_shot(now);
        if (top.spad_rst) {
            spad.hold();
            if (top.tdc_stop) stop(false, now);
        }
        if (top.algo_done) {
            print_frame(top.depth, spad.shots(), edge);
            spad.begin_frame();
            done++;
        }
    }

    // Brings what is asynchronous up to date.
    void until(int64_t now) {
#if defined(TRACE_VCD) || defined(TRACE_FST)
        while (oscillator <= now || spad.next() <= now) {
            if (spad.next() <= oscillator) {
                int64_t at = spad.next();
                spad.fire();
                stop(true, at);
            } else {
                show(oscillator);
                top.clk_in = !top.clk_in;
                eval(oscillator);
                oscillator += OSCILLATOR / 2;
            }
        }
#else
        if (spad.next() <= now) {
            int64_t at = spad.next();
            spad.fire();
            stop(true, at);
        }
#endif
    }

#if defined(TRACE_VCD) || defined(TRACE_FST)
    static constexpr int64_t OSCILLATOR = 5000000;  // period of clk_in [fs]
    int64_t oscillator = OSCILLATOR / 2;
    int64_t instant = 0;  // not in the waveform yet [ps]
    Waveform waveform;

    void open(const char *path) {
        context.traceEverOn(true);
        top.trace(&waveform, 99);
        waveform.set_time_resolution("1ps");
        waveform.open(path);
    }

    void close() {
        waveform.dump(static_cast<uint64_t>(instant));
        waveform.close();
    }

    // Time goes on to `now`: what is before it goes into the waveform.
    void show(int64_t now) {
        if (now / 1000 == instant) return;
        waveform.dump(static_cast<uint64_t>(instant));
        instant = now / 1000;
    }
#else
    void open(const char *) {}
    void close() {}
    void show(int64_t) {}
#endif

    void eval(int64_t now) {
        context.time(static_cast<uint64_t>(now));
        top.eval();
    }
};

int main(int count, char **words) {
    Arguments arguments(count, words);
    Bench bench(arguments);
    bench.run();
}
