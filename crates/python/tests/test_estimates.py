"""Depths of histograms of one's own."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tofsim


@pytest.fixture(scope="module")
def frames() -> tofsim.Frames:
    return tofsim.simulate("kc705", 5, "histogram")


def test_depths_are_those_of_the_run(frames: tofsim.Frames) -> None:
    found = tofsim.estimate(frames.histograms)
    assert found["depth_raw"].tobytes() == frames.depth_raw.tobytes()
    assert found["depth_m"].tobytes() == frames.depth_m.tobytes()
    assert found["estimator"] == frames.estimator == "network"
    assert np.isnan(found["sigma_m"]).all() and np.isnan(frames.sigma_m).all()
    assert found["valid"].all() and frames.valid.all() and frames[0].valid
    assert found["status"] == frames.status == [[]] * 5
    assert found["status_code"] == frames.status_code == ["not stated"] * 5
    one = tofsim.estimate(frames.histograms[2])
    assert one["depth_raw"].tolist() == [frames.depth_raw[2]]


def test_depths_are_those_of_the_command(
    frames: tofsim.Frames, printed: Callable[..., Any], tmp_path: Path
) -> None:
    path = tmp_path / "h.npy"
    np.save(path, frames.histograms)
    names = ["likelihood", "peak", "matched"]
    expected = printed("estimate", str(path), "--estimator=" + ",".join(names), "--explain")
    found = tofsim.estimate(frames.histograms, estimators=names)
    explained = tofsim.explain(frames.histograms)
    for place, row in enumerate(expected["histograms"]):
        assert row["depth_m"] == found["depth_m"][place]
        assert row["explanation"] == explained[place]
        for reading in row["estimates"]:
            assert reading["depth_m"] == found[reading["estimator"]][place]
    assert json.loads(json.dumps(tofsim.explain(frames.histograms[0]))) == explained[0]


def test_a_failure_is_no_number() -> None:
    nothing = np.zeros((2, 256), dtype=np.uint32)
    found = tofsim.estimate(nothing, estimators=["peak"])
    assert np.isnan(found["peak"]).all()
    peak = found["estimates"]["peak"]
    assert peak["status"] == [["no hits"]] * 2 and not peak["valid"].any()


def test_counts_of_any_whole_type_will_do(frames: tofsim.Frames) -> None:
    for dtype in ["int64", "uint16", "int32"]:
        found = tofsim.estimate(frames.histograms.astype(dtype))
        assert found["depth_raw"].tobytes() == frames.depth_raw.tobytes()
    turned = np.asfortranarray(frames.histograms)
    assert tofsim.estimate(turned)["depth_raw"].tobytes() == frames.depth_raw.tobytes()
    assert tofsim.estimate(frames.histograms[:0])["depth_m"].shape == (0,)


@pytest.mark.parametrize(
    ("histograms", "said"),
    [
        (np.zeros((3, 255), dtype=np.uint32), "shape = [3, 255]: expected n x 256 or 256 bins"),
        (np.zeros((1, 3, 256), dtype=np.uint32), "expected n x 256"),
        (np.zeros(256), "dtype = float64: expected whole numbers"),
        (np.full(256, -1), "-1: expected counts from 0 to 65535"),
        (np.full(256, 65536), "65536: expected counts from 0 to 65535"),
    ],
)
def test_what_is_no_histogram_is_refused(histograms: np.ndarray[Any, Any], said: str) -> None:
    with pytest.raises(tofsim.InputError) as raised:
        tofsim.estimate(histograms)
    assert said in str(raised.value)


def test_an_unknown_estimator_is_refused(frames: tofsim.Frames) -> None:
    with pytest.raises(tofsim.InputError, match="estimators: peek: expected some of network"):
        tofsim.estimate(frames.histograms, estimators=["peek"])
