"""Captures of logic analysers."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._tofsim import _read_ila


@dataclass(frozen=True)
class Capture:
    """Samples of a logic analyser, an array for each probe."""

    form: str
    """`csv`, `csv without radices` or `ila`."""
    samples: int
    """How many there are."""
    signals: dict[str, Any]
    """By the head of its column: `uint64`, with a row of words (lowest first) above 64 bits; a list of words of text."""
    unknown: dict[str, NDArray[np.uint64]]
    """Bits that are not known, in the same shape."""
    widths: dict[str, int]
    """Bits of each probe."""
    windows: NDArray[np.uint64]
    """Samples with which windows begin."""
    triggers: NDArray[np.uint64]
    """Samples that triggered."""
    gaps: NDArray[np.uint64]
    """Places where nothing was stored."""
    notes: list[str] = field(default_factory=list)
    """What was read otherwise than it is usually written."""

    def __getitem__(self, name: str) -> Any:
        """A probe by the head of its column, or by its name without a range."""
        if name in self.signals:
            return self.signals[name]
        found = [head for head in self.signals if head.split("[")[0] == name]
        if len(found) != 1:
            raise KeyError(name)
        return self.signals[found[0]]

    def __len__(self) -> int:
        return self.samples


def read(path: str | os.PathLike[str], *, radix: str | None = None) -> Capture:
    """Reads a capture as Vivado writes it: CSV or an `.ila` archive; `radix` is that of a CSV that does not say.

    `tofsim.waves.read` reads a capture that was exported as VCD.
    """
    return Capture(**_read_ila(path, radix))
