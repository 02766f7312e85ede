"""The example for cocotb: it passes as it is, and finds faults in the Verilog."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT


def run(build: Path, rtl: Path = ROOT / "rtl_ref") -> "subprocess.CompletedProcess[str]":
    assert shutil.which("iverilog"), "iverilog is missing: apt-get install iverilog"
    script = ROOT / "examples" / "cocotb" / "run.py"
    words = [sys.executable, str(script), f"--rtl={rtl}", f"--build={build}"]
    return subprocess.run(words, capture_output=True, text=True, check=False)


def test_the_verilog_does_what_the_device_does(tmp_path: Path) -> None:
    done = run(tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "3000 edges, 20 signals, 1 frames: no difference" in done.stdout + done.stderr


@pytest.mark.parametrize(
    ("file", "right", "wrong", "signal"),
    [
        ("coarse_counter.v", "coarse + 1'b1", "coarse + 2'd2", "tdc."),
        ("spad_control.v", "spad_rst <= spad_rst_next", "spad_rst <= 1'b0", "spad_rst"),
        ("control_sync.v", "laser_freq_sync <=", "laser_freq_sync <= #12000", "control_sync.laser_freq_sync"),
    ],
)
def test_a_planted_fault_is_found(
    tmp_path: Path, file: str, right: str, wrong: str, signal: str
) -> None:
    rtl = tmp_path / "rtl"
    shutil.copytree(ROOT / "rtl_ref", rtl)
    text = (rtl / file).read_text()
    assert right in text, f"{file} has no {right}"
    (rtl / file).write_text(text.replace(right, wrong))
    done = run(tmp_path / "build", rtl)
    said = done.stdout + done.stderr
    assert done.returncode == 1, said
    [line] = [line for line in said.splitlines() if "AssertionError: cycle" in line]
    assert f": {signal}" in line and "expected" in line and "got" in line, line
