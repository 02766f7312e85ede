"""Captures and waveforms as arrays, and comparisons."""

from pathlib import Path

import numpy as np
import pytest
import tofsim
from conftest import Command


@pytest.fixture(scope="module")
def folder(command: Command, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A waveform in both formats, and a capture in all."""
    folder = tmp_path_factory.mktemp("captures")
    for form in ["vcd", "fst"]:
        options = ["--waves", form, "--window", "shot:0..32", "-o", str(folder)]
        done = command("run", *options)
        assert done.returncode == 0, done.stderr
    for form in ["csv", "ila"]:
        done = command("ila", "capture", "--probes=fig_6_6", f"--format={form}", "-o", str(folder))
        assert done.returncode == 0, done.stderr
    return folder


def test_both_formats_of_a_waveform_have_the_same_changes(folder: Path) -> None:
    vcd = tofsim.waves.read(folder / "kc705.vcd", ["tdc_code", "laser_pulse", "taps"])
    fst = tofsim.waves.read(folder / "kc705.fst", ["tdc_code", "laser_pulse", "taps"])
    assert (vcd.format, fst.format) == ("VCD", "FST")
    assert vcd.signals.keys() == fst.signals.keys()
    for name, expected in vcd.signals.items():
        found = fst[name]
        assert found.width == expected.width
        assert (found.at == expected.at).all()
        assert (np.asarray(found.values) == np.asarray(expected.values)).all()
    pulse = vcd["vcsel_driver.laser_pulse"]
    rises = pulse.at[1:][np.asarray(pulse.values)[1:] == 1]
    assert set(np.diff(rises)) == {48_000_000}, "six cycles of 8 ns, in femtoseconds"


def test_a_waveform_has_what_the_device_shows(folder: Path) -> None:
    code = tofsim.waves.read(folder / "kc705.vcd", "tof_top.tdc_code")["tof_top.tdc_code"]
    device = tofsim.Device("kc705")
    begin = code.at[1]
    while (device.time_fs or 0) <= begin:
        device.step()
    times, shown = [], []
    for _ in range(150):
        device.step()
        times.append(device.time_fs)
        shown.append(device["tdc_code"])
    # The value just before the edge.
    before = np.array(times) - 1
    assert code.sample(before).tolist() == shown
    assert len(set(shown)) > 3


def test_a_capture_is_the_same_in_both_formats(folder: Path) -> None:
    [csv] = [path for path in folder.glob("*.csv") if path.name != "histogram.csv"]
    [archive] = folder.glob("*.ila")
    one, other = tofsim.ila.read(csv), tofsim.ila.read(archive)
    assert (one.form, other.form) == ("csv", "ila")
    assert len(one) == len(other) > 100
    assert one.signals.keys() == other.signals.keys()
    for name, values in one.signals.items():
        assert (np.asarray(values) == np.asarray(other[name])).all(), name
        assert values.dtype == np.uint64
        assert not one.unknown[name].any()
    assert one.triggers.tolist() == other.triggers.tolist()


def test_a_capture_is_that_of_its_scenario_and_of_no_other(folder: Path) -> None:
    [archive] = folder.glob("*.ila")
    same = tofsim.compare(tofsim.Scenario("kc705"), archive, map="fig_6_6")
    assert same["same"] is True
    slower = tofsim.Scenario("kc705").with_(firmware={"laser_freq": 1})
    other = tofsim.compare(slower, archive, map="fig_6_6")
    assert other["same"] is False
    files = tofsim.compare(folder / "kc705.vcd", folder / "kc705.fst")
    assert files["same"] is True


def test_faults_name_the_file(folder: Path, tmp_path: Path) -> None:
    path = tmp_path / "broken.csv"
    path.write_text("nothing of the kind\n")
    with pytest.raises(tofsim.InputError) as raised:
        tofsim.ila.read(path)
    assert raised.value.file == str(path)
    with pytest.raises(tofsim.InputError, match="no such signal"):
        tofsim.waves.read(folder / "kc705.vcd", "nothing_*")
    with pytest.raises(FileNotFoundError):
        tofsim.waves.read(tmp_path / "none.vcd")
    with pytest.raises(tofsim.InputError, match="radix: octo: expected one of hex"):
        tofsim.ila.read(path, radix="octo")
