#ifndef SERIAL_LINE_H
#define SERIAL_LINE_H

#include <cstdint>

#include "terminal.h"

// Bits of a terminal's bytes on uart_rx and uart_tx: 8 data bits, no parity, one stop bit, timed in cycles of clk_sys.
class SerialLine {
public:
    SerialLine(Terminal &terminal, unsigned bit_cycles) : terminal(terminal), bit_cycles(bit_cycles) {}

    // Returns the level of uart_rx in the next cycle.
    bool drive() {
        if (down_left == 0) {
            if (idle_cycles++ % POLL_CYCLES != 0) return true;
            int byte = terminal.read();
            if (byte < 0) return true;
            idle_cycles = 0;
            down_bits = static_cast<unsigned>(byte) << 1 | STOP_BIT;
            down_left = BITS * bit_cycles;
        }
        bool level = down_bits >> (BITS - 1 - (down_left - 1) / bit_cycles) & 1;
        down_left--;
        return level;
    }

    // Takes the level of uart_tx after an edge, and looks at each bit in its middle.
    void sample(bool level) {
        if (up_left == 0) {
            if (level) return;
            up_left = (BITS - 1) * bit_cycles + bit_cycles / 2;
            up_bits = 0;
            return;
        }
        up_left--;
        if (up_left % bit_cycles != 0) return;
        unsigned bit = BITS - 1 - up_left / bit_cycles;
        up_bits |= static_cast<unsigned>(level) << bit;
        if (up_left == 0 && level) terminal.write(static_cast<uint8_t>(up_bits >> 1));
    }

    // Returns whether no byte is under way, and the host has sent none for some time.
    bool is_idle() const { return down_left == 0 && up_left == 0 && idle_cycles > IDLE_CYCLES; }

private:
    static constexpr unsigned BITS = 10, STOP_BIT = 1u << 9;
    static constexpr uint64_t POLL_CYCLES = 64;     // between two looks for a byte
    static constexpr uint64_t IDLE_CYCLES = 65536;  // longer than the firmware takes to answer

    Terminal &terminal;
    const unsigned bit_cycles;
    unsigned down_bits = 0, down_left = 0;  // of the host's byte, cycles that it still takes
    unsigned up_bits = 0, up_left = 0;      // of the firmware's byte
    uint64_t idle_cycles = 0;               // since the host's last byte
};

#endif
