"""Histograms in bulk."""

from __future__ import annotations

from ._tofsim import Batches
from ._verbs import Given, Grid, grid_words


def dataset(
    scenario: Given = None,
    *,
    grid: Grid = None,
    rows: int | None = None,
    repeats: int = 5,
    batch: int = 2048,
    seed: int | None = None,
    threads: int | None = None,
) -> Batches:
    """Draws histograms of many scenes, some at a time: those of `tofsim dataset` with the same options.

    A batch has `histograms` (n x bins, `uint32`), `row`, and a column for each key that varies, as
    `target.distance_m`. The same rows come for any `batch` and any number of threads.
    """
    return Batches(scenario, grid_words(grid), rows, repeats, batch, seed, threads)
