// Times the model that Yosys has made for CXXRTL (DESIGN, compiled in), with clocks and carry chain
// in C++.
#include DESIGN

#include <algorithm>
#include <array>
#include <numeric>

#include "protocol.h"

namespace {

int64_t edge_at = 0;  // the edge of clk_125 at hand [fs]
int64_t stop_at = 0;  // the last change of tdc_stop [fs]

constexpr int TAPS = 800;
constexpr int CELL = 13;  // ages that share an entry of the guide, as a power of two
using Taps = std::array<uint32_t, TAPS / 32>;

// The delays of the chain.
struct Delays {
    std::vector<int64_t> sorted;  // time to each tap, earliest first [fs]
    std::vector<Taps> reached;    // the taps that an edge has reached first, by their number
    std::vector<int> guide;       // how many of them at the begin of a cell of ages

    explicit Delays(const char *path) {
        std::FILE *file = std::fopen(path, "r");
        if (!file) Arguments::fail(path);
        std::vector<int64_t> arrival;
        unsigned long long at;
        while (std::fscanf(file, "%llx", &at) == 1) arrival.push_back(at);
        std::fclose(file);
        if (arrival.size() != TAPS) Arguments::fail("expected 800 delays");
        std::vector<int> order(TAPS);
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(),
                         [&](int a, int b) { return arrival[a] < arrival[b]; });
        reached.push_back({});
        for (int tap : order) {
            sorted.push_back(arrival[tap]);
            reached.push_back(reached.back());
            reached.back()[tap / 32] |= uint32_t{1} << tap % 32;
        }
        for (int64_t age = 0; age <= sorted.back(); age += 1 << CELL)
            guide.push_back(std::lower_bound(sorted.begin(), sorted.end(), age) - sorted.begin());
        sorted.push_back(NEVER);
    }

    const Taps &at(int64_t age) const {
        int rank = guide[age >> CELL];
        while (sorted[rank] <= age) rank++;
        return reached[rank];
    }
};

struct Pll : cxxrtl_design::bb_p_pll {};

Pll *pll;

struct Ones : cxxrtl_design::bb_p_ones {
    bool eval() override {
        if (!posedge_p_clk__125()) return true;
        unsigned ones = 0;
        for (auto word : p_hit__taps.data) ones += __builtin_popcount(word);
        if (p_rst.get<bool>()) p_n.next.set<unsigned>(0);
        else if (p_hit.get<bool>()) p_n.next.set(ones);
        return true;
    }
};

// As rtl/carry_chain.sv.
struct Chain : cxxrtl_design::bb_p_carry__chain {
    Delays delays{"rtl_ref/tap_delays.mem"};
    bool level = false;
    std::array<int64_t, 8> changed{};
    unsigned newest = 0, travelling = 0;

    bool eval() override {
        if (posedge_p_clk__125()) sample();
        return true;
    }

    void sample() {
        if (p_tdc__stop.get<bool>() != level) {
            level = !level;
            changed[++newest % 8] = stop_at;
            travelling = std::min(travelling + 1, 8u);
        }
        if (travelling == 0) return;
        Taps levels;
        levels.fill(level ? ~uint32_t{0} : 0);
        for (unsigned n = 0; n < travelling; n++) {
            int64_t age = edge_at - changed[(newest - n) % 8];
            if (age >= delays.sorted[TAPS - 1]) {
                travelling = n;
                break;
            }
            const Taps &reached = delays.at(age);
            for (size_t k = 0; k < levels.size(); k++) levels[k] ^= ~reached[k];
        }
        std::copy(levels.begin(), levels.end(), p_taps.next.data);
    }
};

struct Bench {
    cxxrtl_design::p_tof__top top;
    Spad spad;

    explicit Bench(const Arguments &arguments) : spad(arguments.photons) {
        top.p_laser__freq.set<unsigned>(arguments.laser_freq);
        top.p_laser__en.set<bool>(true);
        top.p_dsp__en.set<bool>(true);
        set(pll->p_locked, true);
        top.step();
    }

    void stop(bool level, int64_t now) {
        top.p_tdc__stop.set<bool>(level);
        stop_at = now;
    }

    // An output of the blackbox, at once and not a delta later.
    static void set(wire<1> &pin, bool level) {
        pin.curr.set(level);
        pin.next.set(level);
    }

    void clocks(bool clk_125, bool clk_250) {
        set(pll->p_clk__125, clk_125);
        set(pll->p_clk__250, clk_250);
        top.p_clk__125.set(clk_125);
        top.p_clk__250.set(clk_250);
        top.step();
    }

    void run(int frames) {
        double begun = seconds();
        int done = 0;
        uint64_t edge = 0;
        for (int64_t now = FIRST_EDGE; done < frames; now += CYCLE, edge++) {
            // One change between two edges at most, and the chain has its time.
            if (spad.next() <= now) {
                stop(true, spad.next());
                spad.fire();
            }
            // clk_250 stays where it is while no register of its domain can change. clk_125 falls
            // early: nothing waits for that, and the outputs have followed the registers by then.
            bool all = edge < 8;
            bool rises = all || top.p_vcsel__driver_2e_laser__pulse.curr.bit(0);
            edge_at = now;
            clocks(true, rises);
            clocks(false, rises);
            if (top.p_laser__on__lvds__p.get<bool>()) spad.begin_shot(now);
            if (top.p_spad__rst.get<bool>()) {
                spad.hold();
                if (top.p_tdc__stop.get<bool>()) stop(false, now);
            }
            if (top.p_algo__done.get<bool>()) {
                print_frame(top.p_depth.get<uint64_t>(), spad.shots(), edge);
                spad.begin_frame();
                done++;
            }
            if (rises) clocks(false, false);
            if (all || top.p_vcsel__driver_2e_fire.curr.bit(0)) {
                clocks(false, true);
                clocks(false, false);
            }
        }
        std::printf("seconds %.9f\n", seconds() - begun);
    }
};

}  // namespace

namespace cxxrtl_design {
std::unique_ptr<bb_p_pll> bb_p_pll::create(std::string, metadata_map, metadata_map) {
    auto made = std::make_unique<Pll>();
    pll = made.get();
    return made;
}
std::unique_ptr<bb_p_carry__chain> bb_p_carry__chain::create(std::string, metadata_map,
                                                             metadata_map) {
    return std::make_unique<Chain>();
}
std::unique_ptr<bb_p_ones> bb_p_ones::create(std::string, metadata_map, metadata_map) {
    return std::make_unique<Ones>();
}
}  // namespace cxxrtl_design

int main(int count, char **words) {
    Arguments arguments(count, words);
    Bench(arguments).run(arguments.frames);
}
