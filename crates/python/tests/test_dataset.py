"""Histograms in bulk, in batches."""

from pathlib import Path

import numpy as np
import pytest
import tofsim
from conftest import Command


def test_batches_are_the_files_of_the_command(command: Command, tmp_path: Path) -> None:
    done = command("dataset", "--rows=603", "--format=npy", "--seed=5", "-o", str(tmp_path))
    assert done.returncode == 0, done.stderr
    expected = np.load(tmp_path / "histograms.npy")
    truth = np.load(tmp_path / "truth.npy")
    for batch in [100, 2048]:
        batches = tofsim.dataset(rows=603, batch=batch, seed=5, threads=2)
        assert (batches.rows, len(batches)) == (603, -(-603 // batch))
        all_of_them = list(batches)
        found = np.concatenate([each["histograms"] for each in all_of_them])
        assert (found == expected).all()
        distances = np.concatenate([each["target.distance_m"] for each in all_of_them])
        assert (distances == truth[:, 0]).all()


def test_keys_of_a_grid_are_columns() -> None:
    grid = {"target.distance_m": [0.2, 0.4], "laser.pulse_sigma_ps": "100,150"}
    [batch] = tofsim.dataset(grid=grid, repeats=3)
    assert batch["histograms"].shape == (12, 256)
    assert sorted(set(batch["laser.pulse_sigma_ps"])) == [100, 150]
    assert sorted(set(batch["target.distance_m"])) == [0.2, 0.4]


def test_a_wrong_grid_is_refused_as_the_command_does(command: Command, tmp_path: Path) -> None:
    with pytest.raises(tofsim.InputError) as raised:
        tofsim.dataset(grid={"target.distance": [1]})
    said = command("dataset", "--grid=target.distance=1.0", "-o", str(tmp_path)).stderr.strip()
    assert said == f"tofsim: {raised.value}"
    with pytest.raises(tofsim.InputError, match="batch: 0"):
        tofsim.dataset(batch=0)
