"""Histograms in bulk."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, final

from numpy.typing import NDArray

from ._tofsim import Dataset, _refuse
from ._verbs import Given, Grid, grid_words


@final
class Batches(Iterator[dict[str, NDArray[Any]]]):
    """Batches of drawn histograms, each a dictionary of arrays."""

    def __init__(self, drawn: Dataset, batch: int, threads: int | None) -> None:
        if batch < 1:
            _refuse("batch", "expected 1 at least", value=str(batch))
        self._drawn, self._batch, self._threads = drawn, batch, threads
        self._begins = iter(range(0, drawn.rows, batch))

    @property
    def rows(self) -> int:
        """Histograms in all."""
        return self._drawn.rows

    def notes(self) -> list[dict[str, Any]]:
        """What makes depths of some scenes impossible."""
        return self._drawn.notes()

    def __len__(self) -> int:
        return -(-self._drawn.rows // self._batch)

    def __next__(self) -> dict[str, NDArray[Any]]:
        begin = next(self._begins)
        end = min(self._drawn.rows, begin + self._batch)
        return self._drawn.batch(begin, end, self._threads)


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
    `target.distance_m`. Of an array there is a row for each pixel, with its true radial depth as `distance_m` (NaN
    where no light returns) and its place as `pixel_row` and `pixel_column`. The same rows come for any `batch` and any
    number of threads. `notes()` of the batches says what makes depths of some scenes impossible.
    """
    return Batches(Dataset(scenario, grid_words(grid), rows, repeats, seed), batch, threads)
