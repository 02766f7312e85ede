"""A board's firmware, as a thread at the other end of a pseudo-terminal."""

import csv
import os
import threading
import tty
from pathlib import Path

WORD = 4
#: Commands of UARTBone; bits of `control` and of `status`.
WRITE, READ = 1, 2
LASER_EN, DSP_RST, RING_ON = 1 << 0, 1 << 2, 1 << 7
LOCKED, ARMED = 1 << 0, 1 << 4


class Firmware:
    """Registers by name, over UARTBone; a permitted frame ends at once, with its number in bin 7."""

    def __init__(self, map_file: Path) -> None:
        rows = list(csv.reader(map_file.open()))
        self.address = {row[1]: int(row[2], 16) // WORD for row in rows if row[0] == "csr_register"}
        self.base = {row[1]: int(row[2], 16) // WORD for row in rows if row[0] == "memory_region"}
        self.constants = {row[1]: int(row[2]) for row in rows if row[0] == "constant"}
        self.words: dict[int, int] = {}
        self.lit = 0
        self.gap = 0
        parameters = self.constants["parameters_hash_value"]
        self.set("identity", self.constants["identity_value"])
        self.set("map_version", self.constants["map_version_value"])
        self.set("parameters_hash", parameters >> 32)
        self.words[self.address["parameters_hash"] + 1] = parameters & 0xFFFF_FFFF
        self.set("system_hz", 125_000_000)
        self.set("host_timeout", 1_250_000_000)
        self.set("control", DSP_RST)
        self.set("status", LOCKED)
        self.ours, self.theirs = os.openpty()
        tty.setraw(self.ours)
        tty.setraw(self.theirs)
        self.port = os.ttyname(self.theirs)
        threading.Thread(target=self.serve, daemon=True).start()

    def get(self, name: str) -> int:
        return self.words.get(self.address[name], 0)

    def set(self, name: str, word: int) -> None:
        self.words[self.address[name]] = word

    def serve(self) -> None:
        while head := self.receive(6):
            command, length, address = head[0], head[1], int.from_bytes(head[2:], "big")
            if command == READ:
                words = [self.words.get(address + k, 0) for k in range(length)]
                os.write(self.ours, b"".join(word.to_bytes(WORD, "big") for word in words))
            for k in range(length if command == WRITE else 0):
                self.write(address + k, int.from_bytes(self.receive(WORD), "big"))

    def receive(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            try:
                data += os.read(self.ours, count - len(data))
            except OSError:
                return b""
        return data

    def write(self, address: int, word: int) -> None:
        self.words[address] = word
        if address == self.address["arm"]:
            armed = word == self.constants["arm_key"]
            self.set("arm", int(armed))
            self.set("status", LOCKED | ARMED * armed)
        elif address == self.address["frames_permitted"] and word == 1:
            self.end_frame()
        elif address == self.address["density_clear"]:
            self.set("density_clear", 0)
        elif address == self.address["control"] and word & RING_ON:
            counts = [2000] * 800
            self.set("density_hits", sum(counts))
            self.words |= {self.base["code_density"] + 1 + k: n for k, n in enumerate(counts)}

    def end_frame(self) -> None:
        number = self.get("frame")
        self.lit += self.get("arm") & self.get("control") & LASER_EN
        self.set("frame", number + 1 + self.gap)
        self.set("depth", 0xF)
        self.words[self.address["depth"] + 1] = 0xFFFF_FFFF - number
        self.set("estimate_valid", 1)
        self.words[self.base["histogram"] + 7] = number
