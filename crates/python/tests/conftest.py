"""What the tests share: the command that is in the wheel, and a cluster."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from firmware import Firmware

Command = Callable[..., "subprocess.CompletedProcess[str]"]

ROOT = Path(__file__).parents[3]


def command_words() -> list[str]:
    """The command of the wheel, or the one that `TOFSIM` names."""
    given = os.environ.get("TOFSIM")
    return [given] if given else [sys.executable, "-m", "tofsim"]


@pytest.fixture(scope="session")
def command() -> Command:
    """Runs the command in a process of its own."""

    def run(*words: str, **options: Any) -> "subprocess.CompletedProcess[str]":
        return subprocess.run(
            [*command_words(), *words], capture_output=True, text=True, check=False, **options
        )

    return run


@pytest.fixture(scope="session")
def printed(command: Command) -> Callable[..., Any]:
    """What the command prints with `--json`."""

    def run(*words: str) -> Any:
        done = command(*words, "--json")
        assert done.returncode in (0, 1), done.stderr
        return json.loads(done.stdout)

    return run


@pytest.fixture(scope="session")
def client() -> Iterator[Any]:
    """Of a Dask cluster of four processes with one thread each."""
    from distributed import Client, LocalCluster

    cluster = LocalCluster(
        n_workers=4, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with cluster, Client(cluster) as client:
        yield client


def kill_one_on_the_way(client: Any) -> tuple[Callable[[int, int], None], list[int]]:
    """A progress function that kills a worker of the cluster once, after a quarter of the work; and whom it killed."""
    killed: list[int] = []

    def progress(done: int, of: int) -> None:
        if done > of // 4 and not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    return progress, killed


@pytest.fixture
def firmware(command: Command, tmp_path: Path) -> Iterator[Firmware]:
    """A board of the scenario kc705."""
    map_file = tmp_path / "csr.csv"
    done = command("board", "csr", "-o", str(map_file))
    assert done.returncode == 0, done.stderr
    firmware = Firmware(map_file)
    yield firmware
    os.close(firmware.theirs)
    os.close(firmware.ours)
