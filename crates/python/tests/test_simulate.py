"""Frames as arrays."""

import numpy as np
import pytest
import tofsim


def test_arrays_have_the_shapes_and_types_that_are_promised() -> None:
    frames = tofsim.simulate("kc705", 3, "shot")
    assert frames.histograms.shape == (3, 256)
    assert frames.histograms.dtype == np.uint32
    assert frames.depth_m.dtype == np.float64
    assert frames.depth_raw.dtype == np.int64
    assert frames.hits.tolist() == frames.histograms.sum(axis=1).tolist()
    assert np.allclose(frames.depth_m, frames.depth_raw / 2**29)
    assert frames.histograms.flags.owndata or frames.histograms.base is not None
    frames.histograms[0, 0] = 7
    assert frames.histograms[0, 0] == 7
    assert len(frames) == 3
    assert frames.true_depth_m == 0.5


def test_a_frame_is_a_row() -> None:
    frames = tofsim.simulate("near", 2, "histogram")
    assert frames[-1].index == 1
    assert frames[1].histogram.tobytes() == frames.histograms[1].tobytes()
    assert frames[0].depth_raw == frames.depth_raw[0]
    assert [frame.index for frame in frames] == [0, 1]
    with pytest.raises(IndexError, match="frame 2 of 2"):
        frames[2]


def test_the_number_of_threads_changes_nothing() -> None:
    for fidelity in ["cycle", "shot", "histogram"]:
        one = tofsim.simulate("far", 5, fidelity, 3, 1)
        two = tofsim.simulate("far", 5, fidelity, seed=3, threads=2)
        assert one.histograms.tobytes() == two.histograms.tobytes()
        other = tofsim.simulate("far", 5, fidelity, seed=4)
        assert one.histograms.tobytes() != other.histograms.tobytes()


def test_hits_are_told_apart_by_what_caused_them() -> None:
    frames = tofsim.simulate("bright", 2, "cycle", by_cause=True)
    causes = frames.by_cause
    assert causes is not None
    assert set(causes) == {"dark", "ambient", "cover", "signal", "afterpulse", "unknown"}
    assert (np.sum(list(causes.values()), axis=0) == frames.histograms).all()
    assert causes["ambient"].sum() > 0 and causes["signal"].sum() > 0
    assert frames.histograms.tobytes() == tofsim.simulate("bright", 2).histograms.tobytes()
    assert tofsim.simulate("bright", 1, "shot").by_cause is None
    with pytest.raises(tofsim.InputError, match="by_cause"):
        tofsim.simulate("bright", 1, "shot", by_cause=True)


def test_dark_and_lit_frames_come_in_pairs() -> None:
    scenario = tofsim.Scenario().with_(firmware={"dark_frames": True})
    frames = tofsim.simulate(scenario, 2, "histogram")
    assert frames.laser_en.tolist() == [False, True, False, True]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"frames": 0}, "frames: 0: expected 1 at least"),
        ({"threads": 0}, "threads: 0: expected 1 to 1024"),
        ({"fidelity": "cycles"}, "fidelity: cycles: expected one of cycle, shot, histogram"),
        ({"frames": 2**63}, "frames: 9223372036854775808: expected"),
    ],
)
def test_wrong_options_are_refused(options: dict[str, int], said: str) -> None:
    with pytest.raises(tofsim.InputError) as raised:
        tofsim.simulate("kc705", **options)  # type: ignore[arg-type]
    assert str(raised.value).startswith(said)


def test_notes_are_those_of_the_scenario() -> None:
    dark = tofsim.Scenario().with_(firmware={"laser_en": False})
    notes = tofsim.simulate(dark, 1, "shot").notes
    assert [note["code"] for note in notes] == [note["code"] for note in dark.notes()]
    assert notes[0]["key"] == "firmware.laser_en"
