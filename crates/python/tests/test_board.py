"""A board, whose firmware is here a thread at the other end of a pseudo-terminal."""

import csv
import os
import subprocess
import threading
import tty
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tofsim

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
            counts = [100] * 800
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


@pytest.fixture
def firmware(
    command: Callable[..., "subprocess.CompletedProcess[str]"], tmp_path: Path
) -> Iterator[Firmware]:
    map_file = tmp_path / "csr.csv"
    done = command("board", "csr", "-o", str(map_file))
    assert done.returncode == 0, done.stderr
    firmware = Firmware(map_file)
    yield firmware
    os.close(firmware.theirs)
    os.close(firmware.ours)


def is_off(firmware: Firmware) -> bool:
    return firmware.get("arm") == 0 and firmware.get("control") == DSP_RST


def test_frames_are_those_of_the_board(firmware: Firmware) -> None:
    seen: list[tuple[int, int]] = []
    with tofsim.Board(firmware.port) as board:
        dark = board.frames(3, progress=lambda done, of: seen.append((done, of)))
        assert firmware.lit == 0 and is_off(firmware)
        lit = board.frames(2, laser=True)
        assert firmware.lit == 2 and is_off(firmware)
        assert (board.port, board.scenario) == (firmware.port, "kc705")
    assert seen[-1] == (3, 3)
    assert isinstance(dark, tofsim.Frames)
    assert dark.histograms.dtype == np.uint32 and dark.histograms.shape == (3, 256)
    assert dark.histograms[:, 7].tolist() == [0, 1, 2]
    # A word of 36 bits, with its sign.
    assert lit.depth_raw.tolist() == [-(1 << 32) + 0xFFFF_FFFF - k for k in (3, 4)]
    assert lit.index.tolist() == [0, 1] and lit.valid.all()
    assert lit.laser_en.all() and not dark.laser_en.any()
    assert [note["code"] for note in dark.notes] == ["no-light"]
    assert lit.notes == []


def test_registers_have_names(firmware: Firmware) -> None:
    board = tofsim.Board(firmware.port)
    board["scratch"] = 0xDEAD_BEEF
    board["laser_freq"] = 2
    assert (board["scratch"], board["laser_freq"], board["identity"]) == (0xDEAD_BEEF, 2, 0x746F_6673)
    assert board["parameters_hash"] == firmware.constants["parameters_hash_value"]
    info = board.info()
    assert info["matches"] and info["status"]["locked"] and info["control"]["laser_freq"] == 2
    for name, value, said in [
        ("laser_frequ", 1, "unknown name (`laser_freq`?)"),
        ("depth", 1, "read-only register"),
        ("mode", 2, "expected a whole number from 0 to 1"),
        ("mode", -1, "expected a whole number from 0 to 1"),
    ]:
        with pytest.raises(tofsim.InputError) as error:
            board[name] = value
        assert said in str(error.value) and error.value.file == firmware.port
    with pytest.raises(tofsim.InputError, match="unknown register"):
        board["depths"]
    board.close()
    with pytest.raises(tofsim.InputError, match="this one has been closed"):
        board.info()


def test_a_calibration_is_that_of_the_counts(firmware: Firmware) -> None:
    with tofsim.Board(firmware.port) as board:
        rom = board.calibrate(1000)
    assert rom["count"].tolist() == [0] + [100] * 800
    # 800 equal taps of a period of 8 ns.
    assert np.allclose(np.diff(rom["age_ps"][1:]), 10.0)
    assert 0 < rom["age_se_ps"].max() < 20 and rom["units"].dtype == np.uint64
    assert firmware.get("control") == DSP_RST


def test_what_is_no_board_of_the_scenario_is_refused(firmware: Firmware) -> None:
    with pytest.raises(tofsim.InputError, match="that of scenario kc705 with estimator.kind"):
        tofsim.Board(firmware.port, tofsim.Scenario().with_(estimator={"kind": "likelihood"}))
    other = {"estimator": {"kind": "likelihood"}}
    assert not tofsim.Board(firmware.port, other, any_parameters=True).info()["matches"]
    with pytest.raises(tofsim.InputError, match="cannot open it"):
        tofsim.Board("nowhere")
    bad: list[dict[str, Any]] = [{"timeout": 0.0}, {"timeout": float("nan")}, {"baud": 7}]
    for options in bad:
        with pytest.raises(tofsim.InputError, match="expected"):
            tofsim.Board(firmware.port, **options)
    board = tofsim.Board(firmware.port, {"firmware": {"dark_frames": True}}, any_parameters=True)
    with pytest.raises(tofsim.InputError, match="a board does not alternate laser_en"):
        board.frames()
    with pytest.raises(tofsim.InputError, match="expected 1 at least"):
        board.frames(0)
    assert firmware.lit == 0


def test_a_missed_frame_and_an_exception_leave_the_laser_off(firmware: Firmware) -> None:
    board = tofsim.Board(firmware.port)
    firmware.gap = 1
    with pytest.raises(tofsim.InputError, match="a frame was missed"):
        board.frames(2, laser=True)
    assert firmware.lit == 1 and is_off(firmware)
    firmware.gap = 0

    def stop(done: int, of: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        board.frames(10_000, laser=True, progress=stop)
    # What goes on behind the exception has been told to stop; the next command waits for it.
    assert board["arm"] == 0 and is_off(firmware)
