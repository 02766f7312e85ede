"""A board, whose firmware is here a thread at the other end of a pseudo-terminal."""

import time
from typing import Any

import numpy as np
import pytest
import tofsim
from firmware import DSP_RST, Firmware


def is_off(firmware: Firmware) -> bool:
    """Whether laser and frames are off, some time after the last word was written: a write has no answer."""
    until = time.monotonic() + 5
    while time.monotonic() < until:
        if firmware.get("arm") == 0 and firmware.get("control") == DSP_RST:
            return True
        time.sleep(0.01)
    return False


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
    assert rom["count"].tolist() == [0] + [2000] * 800
    # 800 equal taps of a period of 8 ns.
    assert np.allclose(np.diff(rom["age_ps"][1:]), 10.0)
    assert 0 < rom["age_se_ps"].max() < 20 and rom["units"].dtype == np.uint64
    assert is_off(firmware)


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
