"""A sweep on a cluster of processes, one of which is killed."""

import pickle
import time
from pathlib import Path

import pytest
import tofsim
import tofsim.dask
from conftest import Command, kill_one_on_the_way
from distributed import Client

PLAN = """
scenario = "{scenario}"
fidelity = "histogram"
frames = 2
seed = 7
outputs = ["signal_per_shot", "hits_per_frame", "network.two_sd_mm"]
estimators = ["network"]
[[axis]]
key = "target.distance_m"
from = 0.1
to = 0.6
count = {count}
[[axis]]
key = "target.reflectance"
values = [0.1, 0.3, 0.5, 0.6]
"""


PLOT = """
[plot]
title = "Hits of a frame"
x = "target.distance_m"
y = ["hits_per_frame"]
x_label = "distance [m]"
y_label = "hits"
"""


def plan(folder: Path, count: int, scenario: str = "kc705") -> Path:
    path = folder / "plan.toml"
    path.write_text(PLAN.format(count=count, scenario=scenario))
    return path


def test_a_worker_that_is_killed_changes_nothing(
    command: Command, client: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    plan(tmp_path, 1250)
    done = command("sweep", "plan.toml", "-o", "one", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    progress, killed = kill_one_on_the_way(client)
    files = tofsim.dask.sweep("plan.toml", client, tmp_path / "many", progress=progress)
    assert killed, "nothing was killed"
    assert [path.name for path in files] == ["sweep.parquet", "sweep.csv"]
    for path in files:
        assert path.read_bytes() == (tmp_path / "one" / path.name).read_bytes(), path.name
    assert sorted(path.name for path in (tmp_path / "many").iterdir()) == ["sweep.csv", "sweep.parquet"]
    # A table that is whole is not worked out again.
    began = time.monotonic()
    assert tofsim.dask.sweep("plan.toml", client, tmp_path / "many") == files
    assert time.monotonic() - began < 1


def test_a_sweep_that_was_stopped_goes_on_here_and_with_the_command(
    command: Command, client: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    plan(tmp_path, 25)
    assert command("sweep", "plan.toml", "-o", "one", cwd=tmp_path).returncode == 0

    def stop(done: int, of: int) -> None:
        if done >= of // 2:
            raise KeyboardInterrupt

    for goes_on in ["here", "with the command"]:
        with pytest.raises(KeyboardInterrupt):
            tofsim.dask.sweep("plan.toml", client, goes_on, block=5, progress=stop)
        assert (tmp_path / goes_on / "sweep.journal").is_file()
        assert len(list((tmp_path / goes_on / "sweep.parts").glob("from-*.parquet"))) >= 10
        if goes_on == "here":
            told: list[int] = []
            tofsim.dask.sweep("plan.toml", client, goes_on, progress=lambda done, _: told.append(done))
            assert told[0] >= 50
        else:
            done = command("sweep", "plan.toml", "-o", goes_on, cwd=tmp_path)
            assert "points were there already" in done.stderr
        for name in ["sweep.parquet", "sweep.csv"]:
            found = (tmp_path / goes_on / name).read_bytes()
            assert found == (tmp_path / "one" / name).read_bytes(), name


def test_a_plan_travels_as_text_with_its_scenario_and_network(tmp_path: Path) -> None:
    here = tmp_path / "here"
    here.mkdir()
    (here / "net.toml").write_text(tofsim.Network("uniform-16").to_toml())
    (here / "mine.toml").write_text('[estimator]\nnetwork = "net.toml"\n[target]\nreflectance = 0.2\n')
    path = plan(here, 3, "mine.toml")
    there = tofsim.Plan(path, {"spad.pdp": 0.02}, seed=3)
    packed = pickle.dumps(there)
    expected = there.work([0, 5, 11])
    for file in here.iterdir():
        file.unlink()
    arrived = pickle.loads(packed)
    assert arrived.work([0, 5, 11], threads=2) == expected
    assert pickle.loads(pickle.dumps(arrived)).work([11]) == expected[2:]
    assert len(arrived) == 12 and arrived.columns == there.columns


def test_a_plan_with_a_picture_has_it_and_what_values_lie_outside_of_is_said(
    command: Command, client: Client, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = PLAN.format(scenario="kc705", count=3).replace("to = 0.6", "to = 1.2")
    Path("plan.toml").write_text(text + PLOT)
    done = command("sweep", "plan.toml", "-o", "one", cwd=tmp_path)
    with pytest.warns(UserWarning, match="target.distance_m = 1.2: the echo .* and so at 4 of 12 points"):
        files = tofsim.dask.sweep("plan.toml", client, tmp_path / "many")
    assert "and so at 4 of 12 points" in done.stderr
    assert [path.name for path in files] == ["sweep.parquet", "sweep.csv", "sweep.svg"]
    for path in files:
        assert path.read_bytes() == (tmp_path / "one" / path.name).read_bytes(), path.name
    assert tofsim.dask.sweep("plan.toml", client, tmp_path / "many") == files


def test_what_is_refused_at_a_point_is_said_here(client: Client, tmp_path: Path) -> None:
    text = PLAN.format(count=2, scenario="kc705").replace("[0.1, 0.3, 0.5, 0.6]", "[0.1, 0.3]")
    wrong = text + '\n[[axis]]\nkey = "tdc.bins"\nvalues = [256, 64]\n'
    with pytest.raises(ValueError, match="point"):
        tofsim.dask.sweep(tofsim.Plan(wrong), client, tmp_path / "out")
    with pytest.raises(tofsim.InputError, match="expected points below"):
        tofsim.Plan(text).work([99])
    with pytest.raises(tofsim.InputError, match="block: -1: expected 1 at least"):
        tofsim.dask.sweep(tofsim.Plan(text), client, tmp_path / "no", block=-1)
    with pytest.raises(TypeError, match="expected a distributed.Client"):
        tofsim.dask.sweep(tofsim.Plan(text), "tcp://localhost:8786", tmp_path / "no")  # type: ignore[arg-type]
    assert not (tmp_path / "no").exists()


def test_a_table_without_all_points_is_not_written(tmp_path: Path) -> None:
    some = tofsim.Plan(PLAN.format(count=2, scenario="kc705"))
    table = tofsim._tofsim.PlanTable(some, tmp_path / "out")
    table.add(some.work([0, 1]))
    assert table.missing() == [2, 3, 4, 5, 6, 7]
    with pytest.raises(tofsim.InputError, match="expected all points, 6 are missing"):
        table.finish()
    # A block that was worked out twice, as when a worker dies late, is there once.
    table.add(some.work([1, 2, 3, 4, 5, 6, 7]))
    ([_, csv], said) = table.finish()
    assert said == []
    rows = [line for line in Path(csv).read_text().splitlines() if not line.startswith("#")]
    assert [row.split(",")[0] for row in rows] == ["point", *map(str, range(8))]
