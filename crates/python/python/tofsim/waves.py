"""Waveforms."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._tofsim import _refuse, _read_waves, _wave_signals


@dataclass(frozen=True)
class Signal:
    """The changes of a signal."""

    at: NDArray[np.int64]
    """When it changes: femtoseconds, or samples of a logic analyser."""
    values: Any
    """What it changes to: `uint64`, with a row of words (lowest first) above 64 bits; `float64`; a list of words."""
    width: int
    """Its bits."""
    unknown: NDArray[np.uint64] | None = None
    """Bits that are not known, in the same shape."""

    def sample(self, at: Any) -> Any:
        """Its values at some places; before the first change it has none."""
        places = np.searchsorted(self.at, np.asarray(at), side="right") - 1
        if np.any(places < 0):
            raise ValueError("expected places from the first change on")
        return np.asarray(self.values)[places]


@dataclass(frozen=True)
class Waves:
    """Signals of a waveform by their paths."""

    format: str
    """`VCD`, `FST`, `GHW` or one of a logic analyser's."""
    is_in_samples: bool
    """Whether places are samples, and not femtoseconds."""
    end: int | None
    """The last place, if the file says."""
    signals: dict[str, Signal]
    """The signals that were asked for."""
    notes: list[str] = field(default_factory=list)
    """What was read otherwise than it is usually written."""

    def __getitem__(self, name: str) -> Signal:
        """A signal by its path, or by the end of it if that is of one only."""
        if name in self.signals:
            return self.signals[name]
        found = [path for path in self.signals if path.endswith(f".{name}")]
        if len(found) != 1:
            raise KeyError(name)
        return self.signals[found[0]]


def signals(path: str | os.PathLike[str]) -> dict[str, int]:
    """Paths of the signals in a waveform, with their bits."""
    return _wave_signals(path)


def read(path: str | os.PathLike[str], signals: str | Iterable[str] = "*") -> Waves:
    """Reads signals of a VCD, FST or GHW file, by their paths with `*` and `?`, or the ends of these."""
    wanted = [signals] if isinstance(signals, str) else list(signals)
    known = _wave_signals(path)
    names: list[str] = []
    for glob in wanted:
        found = [name for name in known if fnmatchcase(name, glob) or fnmatchcase(name, f"*.{glob}")]
        if not found:
            _refuse(os.fspath(path), "there is no such signal", key="signals", value=glob)
        names += [name for name in found if name not in names]
    read = _read_waves(path, names)
    read["signals"] = {name: Signal(**one) for name, one in read["signals"].items()}
    return Waves(**read)
