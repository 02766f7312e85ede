#ifndef PHOTONS_H
#define PHOTONS_H

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tofsim.h"

// What the firmware shows laser and detector after an edge of clk_sys.
struct Shown {
    bool start, laser, spad_rst, mode, ring_on, frame_done;
};

// Light and detector of a scenario, from power-up on.
class Photons {
public:
    explicit Photons(const std::string &scenario) : handle(tofsim_photons_new(TOFSIM_VERSION, scenario.c_str())) {
        if (handle == nullptr) fail(tofsim_get_error(nullptr, tofsim_get_num_errors(nullptr) - 1));
        due = tofsim_photons_next(handle);
    }

    ~Photons() { tofsim_delete(handle); }

    Photons(const Photons &) = delete;
    Photons &operator=(const Photons &) = delete;

    // Returns the instant of the next change of tdc_stop that comes before the next edge or with it [fs], or -1.
    int64_t next() const { return due; }

    // Goes past that change, and returns the level after it.
    bool change() {
        bool level = tofsim_photons_level(handle);
        due = tofsim_photons_next(handle);
        return level;
    }

    // Takes an edge of clk_sys, and returns the level of tdc_stop after it.
    bool edge(int64_t now, const Shown &shown) {
        tofsim_photons_edge(handle, now, shown.start, shown.laser, shown.spad_rst, shown.mode, shown.ring_on,
                            shown.frame_done);
        if (tofsim_get_num_errors(handle) != 0) fail(tofsim_get_error(handle, 0));
        bool level = tofsim_photons_level(handle);
        due = tofsim_photons_next(handle);
        return level;
    }

private:
    void *const handle;
    int64_t due;

    [[noreturn]] static void fail(const char *reason) {
        std::fprintf(stderr, "board: %s\n", reason);
        std::exit(2);
    }
};

#endif
