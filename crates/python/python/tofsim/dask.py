"""Sweeps on a cluster, over `dask.distributed`."""

from __future__ import annotations

import os
import pickle
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from distributed import Client, as_completed

from ._tofsim import Plan, PlanTable
from ._verbs import Progress

# Blocks for each worker, so that the last ones end together, and points that a block has at most.
_BLOCKS = 16
_MOST = 200


def sweep(
    plan: Plan | str | os.PathLike[str],
    client: Client,
    output: str | os.PathLike[str],
    *,
    set: Mapping[str, Any] | None = None,
    seed: int | None = None,
    block: int | None = None,
    threads: int = 1,
    retries: int = 10,
    restart: bool = False,
    progress: Progress | None = None,
) -> list[Path]:
    """Works out the points of a plan on the workers of a cluster; the paths of the table, as Parquet and CSV.

    The table is the same, byte by byte, as that of `tofsim sweep PLAN -o OUTPUT`. Points travel in blocks; those of a
    worker that dies are worked out by another one. Each block goes to the journal in `output` as it comes, so that a
    sweep that was stopped goes on where it was, with this function or with the command; and to a file of its own in
    `sweep.parts`, to be looked at with `pandas.read_parquet` until the table is whole. Each block has so many
    `threads`; a worker with one thread wants one.
    """
    if not isinstance(plan, Plan):
        plan = Plan(plan, set, seed=seed)
    elif set is not None or seed is not None:
        raise TypeError("sweep: expected set and seed in the plan")
    table = PlanTable(plan, Path(output), restart=restart)
    missing = table.missing()
    done, all_points = len(plan) - len(missing), len(plan)
    if progress is not None:
        progress(done, all_points)
    if missing:
        size = block or _block(len(missing), client)
        blocks = [missing[begin : begin + size] for begin in range(0, len(missing), size)]
        text = pickle.dumps(plan)
        futures = client.map(
            _work, blocks, text=text, threads=threads, pure=False, retries=retries, key="tofsim-sweep"
        )
        try:
            for batch in as_completed(futures, with_results=True).batches():
                for future, lines in batch:
                    table.add(lines)
                    done += len(lines)
                    future.release()
                if progress is not None:
                    progress(done, all_points)
        finally:
            client.cancel(futures)
    return [Path(path) for path in table.finish()]


def _block(points: int, client: Client) -> int:
    workers = max(1, len(client.scheduler_info(n_workers=-1)["workers"]))
    return max(1, min(_MOST, points // (workers * _BLOCKS)))


@lru_cache(maxsize=4)
def _plan(text: bytes) -> Plan:
    plan = pickle.loads(text)
    assert isinstance(plan, Plan)
    return plan


def _work(points: list[int], *, text: bytes, threads: int) -> list[str]:
    return _plan(text).work(points, threads=threads)
