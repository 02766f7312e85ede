"""The same scenario and seed give the same bytes in Python and on the command line."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import tofsim

SCENARIOS = ["kc705", "near", "far", "bright", "fog", "step", "long", "fine", "compact", "ecp5"]
OTHERS: list[dict[str, Any]] = [
    {"target.reflectance": 0.25},
    {"target.distance_m": 0.4, "ambient.irradiance_w_m2_nm": 0.05},
    {"laser.delay_ps": 50.0, "laser.pulse_sigma_ps": 150.0},
    {"tdc.profile": "ideal", "seed": 12},
]
OVERRIDES: list[dict[str, Any]] = [{}, *OTHERS]
CASES = [(name, other) for name in SCENARIOS for other in range(len(OVERRIDES))]


def words(value: object) -> str:
    return str(value) if not isinstance(value, str) else f'"{value}"'


@pytest.mark.parametrize(("place", "case"), list(enumerate(CASES)))
def test_a_frame_has_the_same_bytes(
    printed: Callable[..., Any], place: int, case: tuple[str, int]
) -> None:
    name, other = case
    overrides = {"firmware.shots_per_frame": 3000, **OVERRIDES[other]}
    fidelity = ["cycle", "shot", "histogram"][place % 3]
    seed = 100 + place
    scenario = tofsim.Scenario(name).with_(overrides)
    frames = tofsim.simulate(scenario, 3, fidelity, seed)
    sets = [f"--set={key}={words(value)}" for key, value in overrides.items()]
    options = ["--frames=3", f"--fidelity={fidelity}", f"--seed={seed}", "--no-second-opinion"]
    waves = ["--waves=none"] if fidelity == "cycle" else []
    run = printed("run", name, *sets, *options, *waves)
    assert run["hash"] == tofsim.Scenario(name).with_({**overrides, "seed": seed}).hash
    assert run["notes"] == frames.notes
    assert len(run["frames"]) == len(frames)
    for row, expected in enumerate(run["frames"]):
        counts = np.array(expected["histogram"], dtype=np.uint32)
        assert counts.tobytes() == frames.histograms[row].tobytes()
        assert expected["depth_m"] == frames.depth_m[row]
        assert int(expected["depth_raw"], 16) == int(frames.depth_raw[row]) & ((1 << 36) - 1)
        for column in ["hits", "tdc_hits", "shots", "estimator_cycles", "frame_cycles"]:
            assert expected[column] == getattr(frames, column)[row], column


def test_there_are_fifty() -> None:
    assert len(CASES) == 50


def test_a_link_budget_is_the_one_that_is_printed(printed: Callable[..., Any]) -> None:
    found = tofsim.link_budget("far")
    expected = printed("budget", "far")
    assert found == {key: expected[key] for key in found}


def test_an_evaluation_is_the_one_that_is_printed(printed: Callable[..., Any]) -> None:
    found = tofsim.evaluate(rows=510, check=0, seed=4)
    expected = printed("evaluate", "--rows=510", "--check=0", "--seed=4")
    for key in ["estimators", "cramer_rao_two_sd_mm", "rows", "notes", "hash"]:
        assert found.figures[key] == expected[key], key
