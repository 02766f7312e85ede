"""Networks: read, rounded, trained."""

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tofsim
from conftest import Command


def test_a_network_travels_as_text(tmp_path: Path) -> None:
    network = tofsim.Network.load("uniform")
    assert (network.neurons, network.bins) == (8, 256)
    assert pickle.loads(pickle.dumps(network)) == network
    path = tmp_path / "net.toml"
    network.save(path)
    assert tofsim.Network.load(path) == network
    assert tofsim.Network.load(path).to_toml() == path.read_text()
    assert "uniform" in tofsim.networks()
    with pytest.raises(tofsim.InputError, match="built-in networks are"):
        tofsim.Network("unifrom")


def test_words_are_weights_that_were_rounded() -> None:
    network = tofsim.Network("uniform")
    words, weights = network.words, network.weights
    assert words["w1"].shape == weights["w1"].shape == (8, 256)
    scale = np.abs(words["w1"]).max() / np.abs(weights["w1"]).max()
    assert np.abs(words["w1"] / scale - weights["w1"]).max() < 2 / scale


def test_a_quick_training_is_the_command_s(command: Command, tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    network = tofsim.Network.train(
        recipe="quick", seed=3, progress=lambda *now: told.append(now), starts=2
    )
    done = command("train", "--quick", "--seed=3", "--starts=2", "-o", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert network == tofsim.Network.load(tmp_path / "network.toml")
    assert len(told) > 2 and told == sorted(told)
    assert told[-1][0] <= told[-1][1]


def test_a_network_that_was_trained_elsewhere_is_rounded() -> None:
    weights = tofsim.Network("uniform").weights
    arrays = {"IW": weights["w1"], "LW": weights["w2"], "b1": weights["b1"], "b2": [weights["b2"]]}
    found = tofsim.Network.quantize(arrays)
    words = tofsim.Network("uniform").words
    assert (found.words["w1"] == words["w1"]).all()
    assert found.words["b2"] == words["b2"]
    too_large = {**arrays, "LW": weights["w2"] * 1e6}
    with pytest.raises(tofsim.InputError):
        tofsim.Network.quantize(too_large)
    assert tofsim.Network.quantize(too_large, saturate=True).neurons == 8


def test_an_evaluation_takes_a_network_and_has_tables(printed: Callable[..., Any]) -> None:
    network = tofsim.Network("ideal")
    grid = {"target.distance_m": [0.2, 0.3], "laser.pulse_sigma_ps": "120,137"}
    scenario = tofsim.Scenario().with_(tdc={"profile": "ideal"})
    found = tofsim.evaluate(
        network, scenario, estimators=["network", "peak"], grid=grid, repeats=20, check=0
    )
    assert list(found.estimators) == ["network", "peak"]
    assert found.by()["value"] == [0.2, 0.3]
    assert found.by("laser.pulse_sigma_ps", "peak")["value"] == [120, 137]
    expected = printed(
        "evaluate",
        "ideal",
        "--profile=ideal",
        "--estimator=network,peak",
        "--grid=target.distance_m=0.2,0.3",
        "--grid=laser.pulse_sigma_ps=120,137",
        "--repeats=20",
        "--check=0",
    )
    assert found.figures["estimators"] == expected["estimators"]
