"""The Verilog of the whole device beside the model, clock by clock; `run.py` runs it."""

import os
from collections import deque
from typing import Any

import cocotb
import numpy as np
import tofsim
from cocotb.triggers import RisingEdge, Timer
from cocotb.utils import get_sim_time

# Inputs at power-up, and what the acquisition computer does after which edge of clk_sys.
AT_FIRST = {"rst": 0, "mode": 0, "laser_freq": 3, "laser_en": 1, "dsp_en": 1, "dsp_rst": 0}
LATER = {400: {"laser_freq": 1}, 500: {"dsp_rst": 1}, 560: {"dsp_rst": 0}, 1900: {"mode": 1}}
# Ports and registers that are compared; those of depth are valid from the first frame on.
SIGNALS = [
    "locked", "spad_rst", "spad_sel", "algo_done", "frame_done", "depth",
    "hist_valid", "hist_bin", "hist_count",
    "control_sync.laser_freq_sync", "control_sync.mode_sync",
    "frame_ctrl.state", "frame_ctrl.acquire", "frame_ctrl.clear",
    "vcsel_driver.pre_start", "vcsel_driver.start",
    "tdc.tdc_latch.hit", "tdc.tdc_decoder.n", "tdc.tdc_code", "tdc.tdc_valid",
]  # fmt: skip


def handle(dut: Any, path: str) -> Any:
    """The signal of the design with the path that the model has for it."""
    for name in path.split("."):
        dut = getattr(dut, name)
    return dut


class Stops:
    """Drives tdc_stop at the instants at which the model's detector does."""

    def __init__(self, dut: Any) -> None:
        self.pin, self.level = dut.tdc_stop, 0
        self.pin.value = 0
        self.coming: deque[int] = deque()

    async def drive(self, until: int) -> None:
        """Changes it at the instants before `until` [fs]."""
        while self.coming and self.coming[0] < until:
            at = self.coming.popleft()
            if at > (now := get_sim_time("fs")):
                await Timer(at - now, "fs")
            self.level = 1 - self.level
            self.pin.value = self.level


@cocotb.test()
async def the_verilog_does_what_the_model_does(dut: Any) -> None:
    """Stops at the first signal that is not what the model has."""
    shots, edges = int(os.environ["SHOTS"]), int(os.environ["EDGES"])
    scenario = tofsim.Scenario("kc705").with_(firmware={"shots_per_frame": shots})
    device = tofsim.Device(scenario, keep_stops=True)
    stops, handles = Stops(dut), [(name, handle(dut, name)) for name in SIGNALS]
    dut.clk_in.value = 0
    for name, value in AT_FIRST.items():
        getattr(dut, name).value = value
    for cycle in range(edges):
        device.step()
        stops.coming.extend(device.stops().tolist())
        edge = device.time_fs
        await stops.drive(until=edge)
        await RisingEdge(dut.clk_sys)
        # Registers still have the values that this edge takes, as the model's signals are.
        assert get_sim_time("fs") == edge, f"cycle {cycle}: clk_sys rises at {get_sim_time('fs')} fs, expected {edge}"
        for name, signal in handles:
            compare(cycle, name, expected=device[name], got=signal)
        await stops.drive(until=edge + 1)
        for name, value in LATER.get(cycle, {}).items():
            device.drive(**{name: value})
            getattr(dut, name).value = value
    frames = device.frames()
    assert frames, "no frame was finished"
    depths = np.array([frame.depth_m for frame in frames])
    dut._log.info(f"{edges} edges, {len(SIGNALS)} signals, {len(frames)} frames: no difference; depths {depths.round(4)} m")


def compare(cycle: int, name: str, *, expected: int, got: Any) -> None:
    """One signal at one edge; the model's may be below 0, the design's are bits."""
    bits = str(got.value)
    wanted = f"{expected % (1 << len(bits)):0{len(bits)}b}"
    assert bits == wanted, f"cycle {cycle}: {name} expected {wanted}, got {bits}"
