"""The device, edge by edge."""

import numpy as np
import pytest
import tofsim

FEW = tofsim.Scenario().with_(firmware={"shots_per_frame": 50})


def test_a_device_finishes_the_frames_of_a_run() -> None:
    device = tofsim.Device(FEW)
    frames: list[tofsim.Frame] = []
    while len(frames) < 3:
        device.step(500)
        frames += device.frames()
    expected = tofsim.simulate(FEW, 3)
    for frame in frames[:3]:
        assert frame.histogram.tobytes() == expected.histograms[frame.index].tobytes()
        assert frame.depth_raw == expected.depth_raw[frame.index]
        assert frame.frame_cycles == expected.frame_cycles[frame.index]


def test_a_trace_has_what_single_steps_show() -> None:
    names = ["tof_top.tdc_valid", "tdc.tdc_code", "frame_ctrl.state"]
    device, traced = tofsim.Device(FEW), tofsim.Device(FEW)
    values = traced.trace(600, names)
    assert values.dtype == np.int64 and values.shape == (600, 3)
    for row in values:
        device.step()
        assert [device[name] for name in names] == row.tolist()
    assert device.cycle == traced.cycle == 599
    before = device.time_fs or 0
    device.step()
    assert device.time_fs == before + 8_000_000
    # A valid code is the histogram's.
    codes = values[values[:, 0] == 1, 1]
    assert len(codes) > 10


def test_the_stops_are_where_the_wire_changes() -> None:
    device = tofsim.Device(FEW, keep_stops=True)
    stops: list[int] = []
    for _ in range(600):
        device.step()
        stops += device.stops().tolist()
        # What the edge took is what changed before it.
        time = device.time_fs
        assert time is not None
        assert device["tdc_stop"] == sum(at < time for at in stops) % 2
    assert len(stops) > 50 and stops == sorted(stops)
    with pytest.raises(tofsim.InputError, match="expected a device with keep_stops=True"):
        tofsim.Device(FEW).stops()


def test_a_pin_that_is_driven_does_what_the_acquisition_computer_does() -> None:
    device = tofsim.Device(FEW)
    device.step(400)
    assert device.trace(100, ["vcsel_driver.laser_pulse"]).sum() > 5
    device.drive(laser_en=0)
    device.step(20)
    assert device.trace(100, ["vcsel_driver.laser_pulse"]).sum() == 0
    device.drive(laser_en=True, dsp_rst=1)
    device.step(20)
    assert device["dsp_rst"] == 1


def test_what_is_not_there_is_refused() -> None:
    device = tofsim.Device(FEW)
    with pytest.raises(tofsim.InputError, match="did you mean `tdc.tdc_decoder.tdc_code`|did you mean"):
        device["tdc.tdc_cod"]
    with pytest.raises(tofsim.InputError, match="laser_en = 2: expected 0 or 1"):
        device.drive(laser_en=2)
    with pytest.raises(tofsim.InputError, match="pin: laser: expected one of rst, mode"):
        device.drive(laser=1)
    assert device.cycle is None
    assert "tdc.tdc_code" in device.signals
