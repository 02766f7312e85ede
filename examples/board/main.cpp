// The firmware, with the simulator's photons on tdc_stop and a pseudo-terminal on its serial line.
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "photons.h"
#include "serial_line.h"
#include "terminal.h"

#include "Vtof_top.h"
#include "Vtof_top___024root.h"
#include "verilated.h"

namespace {

volatile std::sig_atomic_t is_stopped = 0;

// Arguments of the program, as board.py gives them.
struct Arguments {
    std::string scenario;  // its name or path, and a line for each key that is set
    int64_t period;        // of clk_sys [fs]
    int64_t first_edge;    // of clk_sys in a simulated run [fs]
    unsigned bit_cycles;   // of the serial line [cycles of clk_sys]
    std::string link;      // symbolic link to the terminal, or empty
};

class Board {
public:
    Board(const Arguments &arguments, Terminal &terminal)
        : arguments(arguments), terminal(terminal), line(terminal, arguments.bit_cycles) {
        now = arguments.first_edge - arguments.period;
        top.uart_rx = 1;
        eval(0);
        top.rootp->tof_top__DOT__pll__DOT__lock = 1;
        eval(now);
    }

    // Runs until a signal, or the end of standard input.
    void run() {
        for (uint64_t cycles = 0; !is_stopped; cycles++) {
            cycle();
            if (cycles % LOOK_CYCLES != 0) continue;
            terminal.flush();
            if (line.is_idle() && waits()) terminal.wait(REST_MS);
            if (input_is_closed()) break;
        }
        top.final();
    }

private:
    static constexpr uint64_t LOOK_CYCLES = 4096;
    static constexpr int REST_MS = 2;
    static constexpr unsigned DRAIN = 2;  // of frame_ctrl.state

    const Arguments &arguments;
    Terminal &terminal;
    SerialLine line;
    VerilatedContext context;
    Vtof_top top{&context};
    std::optional<Photons> photons;  // from the first release of dsp_rst on
    int64_t now;                     // the last edge of clk_sys, of those that the photons see [fs]
    int64_t offset = 0;              // of the simulator's time, which goes on when that of the photons begins [fs]
    bool is_held = false;            // the last edge was not among them

    // One cycle, up to and with a rising edge of both clocks.
    void cycle() {
        auto &root = *top.rootp;
        int64_t edge = now + arguments.period, quarter = arguments.period / 4;
        for (int step = 1; step < 4; step++) {
            stops(now + step * quarter);
            clocks(3 - step, now + step * quarter);
        }
        stops(edge);
        top.uart_rx = line.drive();
        bool was_lit = top.laser_on_lvds_p, was_reset = root.tof_top__DOT__dsp_rst_sync;
        auto state = root.tof_top__DOT__frame_ctrl__DOT__state;
        auto drain = root.tof_top__DOT__frame_ctrl__DOT__drain;
        clocks(3, edge);
        line.sample(top.uart_tx);
        Shown shown{root.tof_top__DOT__start != 0, top.laser_on_lvds_p && !was_lit, top.spad_rst != 0,
                    root.tof_top__DOT__mode_sync != 0, top.ring_on != 0, top.frame_done != 0};
        if (was_reset && !root.tof_top__DOT__dsp_rst_sync) return release(shown);
        // A frame that waits for the host would keep the light waiting, too: each frame has the photons that it has
        // in a run, however long the host takes.
        is_held = state == DRAIN && state == root.tof_top__DOT__frame_ctrl__DOT__state &&
                  drain == root.tof_top__DOT__frame_ctrl__DOT__drain && !top.ring_on;
        if (is_held) return;
        now = edge;
        if (photons) stop(photons->edge(now, shown), now);
    }

    // Begins with frame 0: in a run, too, the reset ends with the second edge.
    void release(const Shown &shown) {
        stop(false, now);
        photons.emplace(arguments.scenario);
        offset += now - (arguments.first_edge - arguments.period);
        now = arguments.first_edge;
        stop(photons->edge(now, Shown{}), now);
        stops(now + arguments.period);
        now += arguments.period;
        stop(photons->edge(now, shown), now);
    }

    // Returns whether nothing happens until the host says so.
    bool waits() const { return is_held || (top.rootp->tof_top__DOT__dsp_rst_sync && !top.ring_on); }

    // Changes tdc_stop as it does until `until`.
    void stops(int64_t until) {
        while (photons && photons->next() >= 0 && photons->next() <= until) {
            int64_t at = photons->next();
            stop(photons->change(), at);
        }
    }

    void stop(bool level, int64_t at) {
        if (top.tdc_stop == level) return;
        top.tdc_stop = level;
        eval(at);
    }

    // Sets both clocks: clk_sys is bit 1, clk_laser bit 0.
    void clocks(int levels, int64_t at) {
        top.rootp->tof_top__DOT__pll__DOT__clocks = levels;
        eval(at);
    }

    void eval(int64_t at) {
        context.time(static_cast<uint64_t>(offset + at));
        top.eval();
    }

    static bool input_is_closed() {
        pollfd input{STDIN_FILENO, 0, 0};
        return poll(&input, 1, 0) > 0 && (input.revents & POLLHUP) != 0;
    }
};

}  // namespace

int main(int count, char **words) {
    if (count < 5 || count > 6) {
        std::fprintf(stderr, "usage: board SCENARIO PERIOD_FS FIRST_EDGE_FS BIT_CYCLES [LINK]\n");
        return 2;
    }
    Arguments arguments{words[1], std::atoll(words[2]), std::atoll(words[3]),
                        static_cast<unsigned>(std::atoi(words[4])), count > 5 ? words[5] : ""};
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { is_stopped = 1; });
    Terminal terminal(arguments.link);
    auto board = std::make_unique<Board>(arguments, terminal);
    std::printf("%s\n", terminal.path().c_str());
    std::fflush(stdout);
    board->run();
}
