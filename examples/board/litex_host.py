"""Frames of a board by LiteX's own tools: `python examples/board/litex_host.py --port /dev/pts/3 --csr csr.csv`.

Starts `litex_server` on the port, talks to it with `RemoteClient`, and prints identity, depths and histograms as JSON.
Needs `pip install litex==2024.12`; `tofsim board csr` writes csr.csv.
"""

import argparse
import json
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from litex.tools.litex_client import RemoteClient

# Bits of the register control; those of laser_freq begin at 4.
LASER_EN, DSP_EN, DSP_RST, MODE, LASER_FREQ = 1, 2, 4, 8, 4
# Words of a read: UARTBone has 255 at most.
BURST = 64
# For an answer, which RemoteClient waits 2 s for: a simulation may take longer.
PATIENCE_S = 120.0


def main() -> int:
    """Takes frames and prints them."""
    parser = argparse.ArgumentParser(description="frames of a board by litex_server and RemoteClient")
    parser.add_argument("--port", required=True, help="serial port of the board")
    parser.add_argument("--csr", type=Path, required=True, help="csr.csv as tofsim board csr writes it")
    parser.add_argument("--baud", type=int, default=921600, help="symbol rate [Bd]")
    parser.add_argument("--frames", type=int, default=1, help="frames to take")
    parser.add_argument("--laser-freq", type=int, default=3, help="laser repetition rate (Table 6.1)")
    parser.add_argument("--mode", type=int, choices=(0, 1), default=0, help="SPAD quench mode (Table 6.2)")
    given = parser.parse_args()
    control = LASER_EN | DSP_EN | given.mode * MODE | given.laser_freq << LASER_FREQ
    with server(given.port, given.baud) as tcp_port:
        board = RemoteClient(port=tcp_port, csr_csv=str(given.csr))
        board.open()
        board.socket.settimeout(PATIENCE_S)
        try:
            print(json.dumps(acquire(board, control, given.frames)))
        finally:
            board.regs.arm.write(0)
            board.close()
    return 0


def acquire(board: RemoteClient, control: int, count: int) -> dict[str, object]:
    """Arms the laser, and takes frames from the first one after a reset on."""
    registers = board.regs
    identity, number = registers.identity.read(), registers.frame.read()
    registers.control.write(control | DSP_RST)
    registers.hold.write(0)
    registers.frames_permitted.write(0)
    registers.arm.write(board.constants.arm_key)
    wait_for("the laser to be armed", lambda: registers.arm.read() == 1)
    registers.control.write(control)
    frames = []
    for number in range(number + 1, number + 1 + count):
        registers.frames_permitted.write(1)
        wait_for(f"frame {number}", lambda: registers.frame.read() == number)
        registers.hold.write(1)
        depth = registers.depth.read() % (1 << 36)
        frames.append({"depth_raw": f"{depth:09x}", "histogram": words(board, board.mems.histogram)})
        registers.hold.write(0)
    registers.control.write(control | DSP_RST)
    return {"identity": f"{identity:08x}", "frames": frames}


def words(board: RemoteClient, memory: Any) -> list[int]:
    """All words of a memory."""
    found: list[int] = []
    while left := memory.size // 4 - len(found):
        found += board.read(memory.base + 4 * len(found), min(left, BURST))
    return found


def wait_for(what: str, is_there: Callable[[], bool]) -> None:
    """Waits until something has happened."""
    end = time.monotonic() + PATIENCE_S
    while not is_there():
        if time.monotonic() > end:
            sys.exit(f"litex_host.py: waited {PATIENCE_S} s for {what}")


@contextmanager
def server(port: str, baud: int) -> Iterator[int]:
    """litex_server on the port, with the TCP port that it listens at."""
    with socket.socket() as free:
        free.bind(("localhost", 0))
        tcp_port = free.getsockname()[1]
    program = Path(sys.executable).with_name("litex_server")
    command = [str(program), "--uart", "--uart-port", port, "--uart-baudrate", str(baud), "--bind-port", str(tcp_port)]
    running = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    try:
        wait_for("litex_server", lambda: listens(tcp_port) or running.poll() is not None)
        yield tcp_port
    finally:
        running.kill()
        running.wait()


def listens(tcp_port: int) -> bool:
    """Whether a program listens at a port of this machine."""
    with socket.socket() as client:
        return client.connect_ex(("localhost", tcp_port)) == 0


if __name__ == "__main__":
    sys.exit(main())
