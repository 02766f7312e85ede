"""Scenarios: where they come from, what is refused, and how they travel."""

import pickle
from pathlib import Path

import numpy as np
import pytest
import tofsim
from conftest import Command


def test_a_scenario_comes_from_a_name_a_path_a_text_or_a_dictionary(tmp_path: Path) -> None:
    text = "[target]\ndistance_m = 0.3\n"
    path = tmp_path / "mine.toml"
    path.write_text(text)
    for scenario in [
        tofsim.Scenario("kc705").with_(target={"distance_m": 0.3}),
        tofsim.Scenario(path),
        tofsim.Scenario(str(path)),
        tofsim.Scenario(text),
        tofsim.Scenario({"target": {"distance_m": 0.3}}),
        tofsim.Scenario().with_({"target.distance_m": np.float32(0.3).round(1) * 1.0}),
        tofsim.Scenario({"target": {"distance_m": np.float64(0.3)}}),
    ]:
        assert scenario["target.distance_m"] == pytest.approx(0.3)
        assert scenario.to_dict()["tdc"]["bins"] == 256
    assert tofsim.Scenario(path).name == "mine"
    assert "kc705" in tofsim.scenarios()


def test_every_kind_of_value_can_be_set() -> None:
    scenario = tofsim.Scenario().with_(
        firmware={"laser_en": False, "laser_freq": np.int64(2)},
        tdc={"profile": "ideal"},
        report={"windows": ["shot:0..4"]},
        control=[{"at_us": 1.5, "mode": 0, "dsp_en": True}],
    )
    assert scenario["firmware.laser_en"] is False
    assert scenario["firmware.laser_freq"] == 2
    assert scenario["report.windows"] == ["shot:0..4"]
    assert scenario["control"][0]["at_us"] == 1.5
    with pytest.raises(TypeError, match="got complex"):
        tofsim.Scenario().with_(target={"distance_m": 1j})
    with pytest.raises(KeyError):
        scenario["target.distance"]


@pytest.mark.parametrize(
    "override",
    ["target.distance_m=-1", "target.distanse_m=1", "tdc.bins=7", "firmware.shots_per_frame=0.5"],
)
def test_a_fault_is_said_as_the_command_says_it(command: Command, override: str) -> None:
    key, value = override.split("=")
    with pytest.raises(ValueError) as raised:
        tofsim.Scenario().with_({key: float(value) if "." in value else int(value)})
    said = command("scenario", "check", "-s", override).stderr.strip()
    assert said == f"tofsim: {raised.value}"
    assert isinstance(raised.value, tofsim.InputError)
    assert raised.value.key == key
    assert raised.value.file == f"-s {override}"


def test_a_fault_in_a_file_has_its_place(command: Command, tmp_path: Path) -> None:
    path = tmp_path / "faulty.toml"
    path.write_text("[target]\nreflectance = 2\n")
    with pytest.raises(tofsim.InputError) as raised:
        tofsim.Scenario(path)
    assert command("scenario", "check", str(path)).stderr.strip() == f"tofsim: {raised.value}"
    assert (raised.value.line, raised.value.column) == (2, 15)
    assert (raised.value.file, raised.value.key) == (str(path), "target.reflectance")
    with pytest.raises(FileNotFoundError):
        tofsim.Scenario(tmp_path / "none.toml")


def test_a_scenario_travels_as_text_with_its_files(tmp_path: Path) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    network = tofsim.Network("ideal").to_toml()
    (folder / "net.toml").write_text(network)
    (tmp_path / "chain.toml").write_text('description = "own"\noffset_ps = 2230\ntap_ps = 12.0\n')
    path = folder / "mine.toml"
    path.write_text('[estimator]\nnetwork = "net.toml"\n[tdc]\nprofile = "../chain.toml"\n')
    scenario = tofsim.Scenario(path).with_(target={"distance_m": 0.3})
    expected = tofsim.simulate(scenario, 2, "shot")
    packed = pickle.dumps(scenario)
    assert network.encode() in packed
    for file in [path, folder / "net.toml", tmp_path / "chain.toml"]:
        file.unlink()
    arrived = pickle.loads(packed)
    assert arrived == scenario
    found = tofsim.simulate(arrived, 2, "shot")
    assert found.histograms.tobytes() == expected.histograms.tobytes()
    assert found.depth_raw.tobytes() == expected.depth_raw.tobytes()
    # And once more.
    assert pickle.loads(pickle.dumps(arrived)) == scenario


def test_files_with_absolute_paths_and_without_an_ending_travel_too(tmp_path: Path) -> None:
    (tmp_path / "net").write_text(tofsim.Network("ideal").to_toml())
    (tmp_path / "chain.toml").write_text('description = "own"\noffset_ps = 2230\ntap_ps = 12.0\n')
    network, profile = str(tmp_path / "net"), str(tmp_path / "chain.toml")
    scenario = tofsim.Scenario({"estimator": {"network": network}, "tdc": {"profile": profile}})
    expected = tofsim.simulate(scenario, 2, "shot")
    packed = pickle.dumps(scenario)
    for file in tmp_path.iterdir():
        file.unlink()
    arrived = pickle.loads(pickle.dumps(pickle.loads(packed)))
    found = tofsim.simulate(arrived, 2, "shot")
    assert found.depth_raw.tobytes() == expected.depth_raw.tobytes()


def test_tables_in_themselves_or_too_deep_are_refused() -> None:
    itself: dict[str, object] = {}
    itself["target"] = itself
    array: list[object] = []
    array.append(array)
    deep: dict[str, object] = {}
    for _ in range(100_000):
        deep = {"target": deep}
    inline: dict[str, object] = {"control": [itself]}
    windows: dict[str, object] = {"report": {"windows": array}}
    for tables in [itself, windows, deep, inline]:
        with pytest.raises(ValueError, match="nested to 16 levels at most, none within itself"):
            tofsim.Scenario(tables)
        with pytest.raises(ValueError, match="nested to 16 levels at most, none within itself"):
            tofsim.Scenario().with_(tables)


def test_another_network_may_stand_in_the_estimator() -> None:
    network = tofsim.Network("uniform-16")
    scenario = tofsim.Scenario("kc705").with_network(network)
    frames = tofsim.simulate(scenario, 3, "shot")
    found = network.estimate(frames.histograms)
    assert found["depth_raw"].tobytes() == frames.depth_raw.tobytes()
    named = tofsim.Scenario("kc705").with_(estimator={"network": "uniform-16"})
    assert tofsim.simulate(named, 3, "shot").depth_raw.tobytes() == frames.depth_raw.tobytes()


def test_a_scenario_that_was_made_is_taken_by_every_function(tmp_path: Path) -> None:
    scenario = tofsim.Scenario({"laser": {"pulse_sigma_ps": 150}})
    for given in [scenario, pickle.loads(pickle.dumps(scenario))]:
        evaluation = tofsim.evaluate(scenario=given, rows=102, check=0)
        assert evaluation.figures["set"] == ["laser.pulse_sigma_ps=150"]
    assert tofsim.link_budget(scenario)["distance_m"] == 0.5
    assert len(tofsim.dataset(scenario, rows=102)) == 1
