"""Sweeps and data sets on a cluster, over `dask.distributed`."""

from __future__ import annotations

import os
import pickle
import warnings
from collections import deque
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from distributed import Client, as_completed
from numpy.typing import NDArray

from ._tofsim import Dataset, DatasetFiles, InputError, Plan, PlanTable, _refuse
from ._verbs import Given, Grid, Progress, grid_words

_Result = TypeVar("_Result")

# Blocks for each worker, so that the last ones end together, and points that a block has at most.
_BLOCKS = 16
_MOST = 200
# Blocks of a data set for each worker that are under way, or wait for one before them.
_AHEAD = 4


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
    """Works out the points of a plan on the workers of a cluster; the paths of the table, as Parquet and CSV, and of
    the picture of a plan that has one.

    The table is the same, byte by byte, as that of `tofsim sweep PLAN -o OUTPUT`. Points travel in blocks; those of a
    worker that dies are worked out by another one. Each block goes to the journal in `output` as it comes, so that a
    sweep that was stopped goes on where it was, with this function or with the command; and to a file of its own in
    `sweep.parts`, to be looked at with `pandas.read_parquet` until the table is whole. Each block has so many
    `threads`; a worker with one thread wants one.
    """
    _check(client, block, threads)
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
                    table.add(_checked(lines))
                    done += len(lines)
                    future.release()
                if progress is not None:
                    progress(done, all_points)
        finally:
            _cancel(client, futures)
    files, said = table.finish()
    for sentence in said:
        warnings.warn(sentence, stacklevel=2)
    return [Path(path) for path in files]


def dataset(
    scenario: Given,
    client: Client,
    output: str | os.PathLike[str],
    *,
    grid: Grid = None,
    rows: int | None = None,
    repeats: int = 5,
    seed: int | None = None,
    formats: str | Sequence[str] = ("parquet",),
    block: int = 2048,
    threads: int = 1,
    retries: int = 10,
    progress: Progress | None = None,
) -> list[Path]:
    """Draws histograms of many scenes on the workers of a cluster; the paths of the files.

    The files are the same, byte by byte, as those of `tofsim dataset SCENARIO -o OUTPUT` with the same options. Blocks
    of so many rows come in order, few at a time, so that memory is that of some blocks whatever the rows; those of a
    worker that dies are drawn by another one. Where depths of some scenes are impossible there is a warning.
    """
    _check(client, block, threads)
    drawn = Dataset(scenario, grid_words(grid), rows, repeats, seed)
    for sentence in drawn.sentences():
        warnings.warn(sentence, stacklevel=2)
    text = pickle.dumps(drawn)
    begins = iter(range(0, drawn.rows, block))
    wanted = [formats] if isinstance(formats, str) else list(formats)
    files = DatasetFiles(drawn, Path(output), wanted)
    under_way: deque[Any] = deque()

    def begin_blocks() -> None:
        while len(under_way) < _AHEAD * _workers(client) and (begin := next(begins, None)) is not None:
            end = min(drawn.rows, begin + block)
            job = (_draw, begin, end)
            under_way.append(
                client.submit(*job, text=text, threads=threads, pure=False, retries=retries)
            )

    try:
        done = 0
        begin_blocks()
        while under_way:
            future = under_way.popleft()
            counts = _checked(future.result())
            future.release()
            begin_blocks()
            # What came over the network may begin at any byte.
            files.add(np.require(counts, np.uint32, ["C", "A"]))
            done += len(counts)
            if progress is not None:
                progress(done, drawn.rows)
        return [Path(path) for path in files.finish()]
    finally:
        files.abandon()
        _cancel(client, list(under_way))


def _check(client: Client, block: int | None, threads: int) -> None:
    if not isinstance(client, Client) or client.asynchronous:
        raise TypeError("client: expected a distributed.Client that is not asynchronous")
    for name, number in [("block", block), ("threads", threads)]:
        if number is not None and number < 1:
            _refuse(name, "expected 1 at least", value=str(number))


def _cancel(client: Client, futures: list[Any]) -> None:
    # A client that is closed has nothing under way, and why it was closed is to be told.
    with suppress(Exception):
        client.cancel(futures)


def _checked(result: _Result | InputError) -> _Result:
    if isinstance(result, InputError):
        raise result
    return result


def _workers(client: Client) -> int:
    return max(1, len(client.scheduler_info(n_workers=-1)["workers"]))


def _block(points: int, client: Client) -> int:
    return max(1, min(_MOST, points // (_workers(client) * _BLOCKS)))


@lru_cache(maxsize=4)
def _arrived(text: bytes) -> Any:
    return pickle.loads(text)


# What is refused is a result: it would be refused again, and a retry is for workers that die.
def _work(points: list[int], *, text: bytes, threads: int) -> list[str] | InputError:
    plan: Plan = _arrived(text)
    try:
        return plan.work(points, threads=threads)
    except InputError as refused:
        return refused


def _draw(begin: int, end: int, *, text: bytes, threads: int) -> NDArray[np.uint32] | InputError:
    drawn: Dataset = _arrived(text)
    try:
        return drawn.counts(begin, end, threads)
    except InputError as refused:
        return refused
