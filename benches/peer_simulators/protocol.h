// What the driver is told, the photons, and what it prints.
#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

constexpr int64_t NEVER = int64_t{1} << 62;      // later than everything [fs]
constexpr int64_t CYCLE = 8000000;               // of clk_sys [fs]
constexpr int64_t FIRST_EDGE = 1008000000;       // one cycle after the PLL has locked [fs]
constexpr uint64_t DEPTH_MASK = 0xfffffffff;     // 36 bits

// LASER_FREQ FRAMES PHOTONS [WAVEFORM]
struct Arguments {
    int laser_freq;
    int frames;
    std::vector<int64_t> photons;  // of each shot, from the laser edge, or NEVER [fs]
    const char *waveform;

    Arguments(int count, char **words) {
        if (count < 4) fail("expected LASER_FREQ FRAMES PHOTONS [WAVEFORM]");
        laser_freq = std::atoi(words[1]);
        frames = std::atoi(words[2]);
        waveform = count > 4 ? words[4] : "/dev/null";
        std::FILE *file = std::fopen(words[3], "r");
        if (!file) fail(words[3]);
        long long at;
        while (std::fscanf(file, "%lld", &at) == 1) photons.push_back(at < 0 ? NEVER : at);
        std::fclose(file);
        if (photons.empty()) fail("no photons");
    }

    [[noreturn]] static void fail(const char *what) {
        std::fprintf(stderr, "driver: %s\n", what);
        std::exit(2);
    }
};

// The detector in MODE 0: fires once a shot, and its output falls as spad_rst rises.
class Spad {
public:
    explicit Spad(const std::vector<int64_t> &photons) : photons(photons) {}

    int64_t next() const { return avalanche_at; }
    uint64_t shots() const { return shot; }
    void fire() { avalanche_at = NEVER; }
    void hold() { avalanche_at = NEVER; }
    void begin_shot(int64_t now) {
        int64_t at = photons[shot++ % photons.size()];
        avalanche_at = at == NEVER ? NEVER : now + at;
    }
    void begin_frame() { shot = 0; }

private:
    const std::vector<int64_t> &photons;
    int64_t avalanche_at = NEVER;
    uint64_t shot = 0;
};

// A finished frame, and the edge of clk_sys that ended it.
inline void print_frame(uint64_t depth, uint64_t shots, uint64_t edge) {
    std::printf("frame %09llx %llu %llu\n", (unsigned long long)(depth & DEPTH_MASK),
                (unsigned long long)shots, (unsigned long long)edge);
}

inline double seconds() {
    auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
}
