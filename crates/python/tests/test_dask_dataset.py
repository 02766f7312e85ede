"""Data sets that are drawn on a cluster of processes."""

import pickle
from pathlib import Path

import numpy as np
import pytest
import tofsim
import tofsim.dask
from conftest import Command, kill_one_on_the_way
from distributed import Client, LocalCluster
from tofsim._tofsim import Dataset, DatasetFiles


def same_files(one: Path, other: Path) -> list[str]:
    names = sorted(path.name for path in one.iterdir())
    assert names == sorted(path.name for path in other.iterdir())
    for name in names:
        assert (one / name).read_bytes() == (other / name).read_bytes(), name
    return names


def test_a_worker_that_is_killed_changes_no_data_set(
    command: Command, client: Client, tmp_path: Path
) -> None:
    options = ["--rows=40000", "--seed=5", "--set=firmware.shots_per_frame=3000", "--format=parquet,npy"]
    done = command("dataset", "kc705", *options, "-o", "one", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    progress, killed = kill_one_on_the_way(client)
    scenario = tofsim.Scenario("kc705").with_({"firmware.shots_per_frame": 3000})
    files = tofsim.dask.dataset(
        scenario,
        client,
        tmp_path / "many",
        rows=40_000,
        seed=5,
        formats=["parquet", "npy"],
        block=700,
        progress=progress,
    )
    assert killed, "nothing was killed"
    names = same_files(tmp_path / "one", tmp_path / "many")
    assert names == ["dataset.json", "dataset.parquet", "histograms.npy", "rows.npy", "truth.npy"]
    assert sorted(path.name for path in files) == names


def test_a_grid_of_ones_own_and_a_chain_of_ones_own_travel(
    command: Command, client: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    delays = "".join(f"{tap},{30 + tap % 3}\n" for tap in range(300))
    Path("delays.csv").write_text(f"tap,delay_ps\n{delays}")
    Path("chain.toml").write_text('offset_ps = 2000\ndelays_file = "delays.csv"\n')
    Path("mine.toml").write_text('[tdc]\nprofile = "chain.toml"\n')
    grid = {"target.distance_m": [0.2, 0.4], "laser.pulse_sigma_ps": "100,150"}
    options = [f"--grid={word}" for word in ["target.distance_m=0.2,0.4", "laser.pulse_sigma_ps=100,150"]]
    done = command("dataset", "mine.toml", *options, "--repeats=700", "-o", "one", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    tofsim.dask.dataset("mine.toml", client, "many", grid=grid, repeats=700, block=1000)
    assert same_files(tmp_path / "one", tmp_path / "many") == ["dataset.json", "dataset.parquet"]
    # What travels needs no file of here.
    drawn = Dataset("mine.toml", ["target.distance_m=0.2,0.4"])
    expected, packed = drawn.counts(3, 9), pickle.dumps(drawn)
    for file in ["mine.toml", "chain.toml", "delays.csv"]:
        Path(file).unlink()
    assert (pickle.loads(packed).counts(3, 9) == expected).all()


def test_what_is_interrupted_leaves_the_data_set_that_was_there(client: Client, tmp_path: Path) -> None:
    first = tofsim.dask.dataset("kc705", client, tmp_path, rows=300)
    before = [path.read_bytes() for path in first]

    def stop(done: int, of: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        tofsim.dask.dataset("kc705", client, tmp_path, rows=3000, block=100, progress=stop)
    assert [path.read_bytes() for path in first] == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["dataset.json", "dataset.parquet"]
    # The folder is free again.
    tofsim.dask.dataset("kc705", client, tmp_path, rows=200)


def test_what_is_wrong_is_refused_before_anything_is_drawn(client: Client, tmp_path: Path) -> None:
    for expected, options in {
        "rows: 0: expected 1 to": {"rows": 0},
        "block: 0: expected 1 at least": {"block": 0},
        "formats: csv: expected some of parquet, npy": {"formats": "csv"},
        "formats: expected one at least": {"formats": []},
        "threads: 0: expected 1 at least": {"threads": 0},
        "grid: expected a key at least": {"grid": {}},
        "target.distance": {"grid": {"target.distance": [1]}},
    }.items():
        with pytest.raises(tofsim.InputError, match=expected):
            tofsim.dask.dataset("kc705", client, tmp_path / "out", **options)  # type: ignore[arg-type]
    assert not (tmp_path / "out").exists()


def test_a_client_that_goes_away_leaves_no_files(tmp_path: Path) -> None:
    with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as own:
        client = Client(own)

        def close(done: int, of: int) -> None:
            client.close()

        with pytest.raises(Exception) as raised:
            tofsim.dask.dataset("kc705", client, tmp_path, rows=30_000, block=500, progress=close)
        assert "cancel-keys" not in str(raised.value)
    assert list(tmp_path.iterdir()) == []


def test_a_depth_that_nothing_can_find_is_warned_of(client: Client, tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match="target.distance_m = 5: the echo comes after the last bin"):
        tofsim.dask.dataset("kc705", client, tmp_path, grid={"target.distance_m": [5]}, repeats=1)


def test_files_want_all_rows_in_their_shape(tmp_path: Path) -> None:
    drawn = Dataset("kc705", [], 100)
    files = DatasetFiles(drawn, tmp_path, ["npy"])
    files.add(drawn.counts(0, 60))
    for wrong in [np.zeros((1, 255), np.uint32), np.zeros((41, 256), np.uint32)]:
        with pytest.raises(tofsim.InputError, match="expected 40 x 256 counts at most"):
            files.add(wrong)
    with pytest.raises(tofsim.InputError, match="rows: 60: expected all 100"):
        files.finish()
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(tofsim.InputError, match="expected rows of 100"):
        drawn.counts(90, 101)
