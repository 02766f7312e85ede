#ifndef TERMINAL_H
#define TERMINAL_H

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <string>
#include <termios.h>
#include <unistd.h>

// Ends the program with the reason of the last system call.
[[noreturn]] inline void fail(const std::string &what) {
    std::fprintf(stderr, "board: %s: %s\n", what.c_str(), std::strerror(errno));
    std::exit(2);
}

// A pseudo-terminal in raw mode: the host opens one side, the board has the other.
class Terminal {
public:
    // Opens a pair; `link`, unless it is empty, becomes a symbolic link to the host's side.
    explicit Terminal(const std::string &link) : link(link) {
        char path[64];
        termios raw{};
        cfmakeraw(&raw);
        raw.c_cflag |= CREAD | CLOCAL;
        if (openpty(&own, &theirs, path, &raw, nullptr) != 0) fail("openpty");
        if (fcntl(own, F_SETFL, O_NONBLOCK) != 0) fail(path);
        name = path;
        if (link.empty()) return;
        if (unlink(link.c_str()) != 0 && errno != ENOENT) fail(link);
        if (symlink(path, link.c_str()) != 0) fail(link);
    }

    ~Terminal() {
        if (!link.empty()) unlink(link.c_str());
    }

    Terminal(const Terminal &) = delete;
    Terminal &operator=(const Terminal &) = delete;

    // Path of the host's side.
    const std::string &path() const { return name; }

    // Returns the host's next byte, or -1.
    int read() {
        uint8_t byte;
        return ::read(own, &byte, 1) == 1 ? byte : -1;
    }

    // Sends a byte to the host, later if the host has not read for long.
    void write(uint8_t byte) {
        unsent.push_back(byte);
        flush();
    }

    // Sends what the host has room for now.
    void flush() {
        while (!unsent.empty() && ::write(own, &unsent.front(), 1) == 1) unsent.pop_front();
    }

    // Waits until the host has sent something, `milliseconds` at most.
    void wait(int milliseconds) {
        pollfd host{own, POLLIN, 0};
        poll(&host, 1, milliseconds);
    }

private:
    const std::string link;
    std::string name;
    int own, theirs;  // `theirs` stays open, so that hosts may come and go
    std::deque<uint8_t> unsent;
};

#endif
