"""Depth images of an array of pixels."""

import json
from pathlib import Path

import numpy as np
import pytest
import tofsim
from conftest import Command

SMALL = {"array": {"rows": 3, "columns": 4}, "firmware": {"shots_per_frame": 2000}}


def small() -> tofsim.Scenario:
    return tofsim.Scenario("array").with_(SMALL)


def test_arrays_are_the_files_of_the_command(command: Command, tmp_path: Path) -> None:
    sizes = ["-s", "array.rows=3", "-s", "array.columns=4", "-s", "firmware.shots_per_frame=2000"]
    done = command("image", *sizes, "--images=2", "--seed=5", "-o", str(tmp_path))
    assert done.returncode == 0, done.stderr
    found = tofsim.image(small(), 2, seed=5, threads=2)
    names = {file.stem for file in tmp_path.glob("*.npy")}
    assert names == set(found) - {"info"} and len(names) == 9
    for name in names:
        expected = np.load(tmp_path / f"{name}.npy")
        assert found[name].dtype == expected.dtype, name
        assert np.array_equal(found[name], expected, equal_nan=expected.dtype.kind == "f"), name
    assert found["depth_radial_m"].shape == (2, 3, 4) and found["signal"].shape == (3, 4)
    expected = json.loads((tmp_path / "image.json").read_text())
    for key in ["geometry", "firmware", "images", "estimator", "notes"]:
        assert found["info"][key] == expected[key], key


def test_one_image_has_rows_and_columns() -> None:
    done = []
    found = tofsim.image(small(), fidelity="histogram", progress=lambda *now: done.append(now))
    assert found["depth_radial_m"].shape == (3, 4)
    assert (found["valid"] == (found["status"] == 0)).all()
    assert done[-1] == (12, 12)


def test_what_is_no_image_is_refused() -> None:
    with pytest.raises(tofsim.InputError, match="fidelity: fast"):
        tofsim.image(small(), fidelity="fast")
    with pytest.raises(tofsim.InputError, match="images"):
        tofsim.image(small(), 0)
    with pytest.raises(tofsim.InputError, match="array.rows"):
        tofsim.image(tofsim.Scenario("array").with_({"array.rows": 65}))
