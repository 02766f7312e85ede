"""Networks that are trained, or that were trained elsewhere."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ._tofsim import Network, _answer
from ._verbs import Given, Grid, Progress, grid_words, option_words, scenario_of


def train(
    scenario: Given = None,
    *,
    recipe: str | None = None,
    grid: Grid = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
    output: str | os.PathLike[str] | None = None,
    **options: Any,
) -> Network:
    """Trains a network on simulated histograms, as `tofsim train`; `progress` hears how much of how much is done.

    `recipe` is `quick` (seconds), `short` (minutes), another built-in one, or a file. In `output` are the network's
    file, its accuracy and its learning curve; further options are the command line's.
    """
    with tempfile.TemporaryDirectory(prefix="tofsim-") as folder:
        home = Path(folder)
        name, overrides = scenario_of(scenario)._words(home)
        words = ["train", name, *overrides, *(f"--grid={each}" for each in grid_words(grid))]
        if recipe == "quick":
            words.append("--quick")
        elif recipe is not None:
            words.append(f"--recipe={recipe}")
        words += option_words({"seed": seed, "threads": threads, **options})
        out = Path(output) if output is not None else home / "out"
        _answer([*words, f"--output={out}", "--json"], threads, progress)
        return Network.from_toml((out / "network.toml").read_text(), "trained")


def quantize(source: str | os.PathLike[str] | Mapping[str, Any], **options: Any) -> Network:
    """Rounds a network that was trained elsewhere to the firmware's words, as `tofsim quantize --from`.

    `source` is a MATLAB or JSON file, a folder of NumPy arrays, or a dictionary of arrays: `IW` (neurons x bins), `LW`,
    `b1`, `b2`, and the settings of mapminmax if there are any. Options are the command line's: `saturate=True`,
    `lut_bits=10`, `format=["w1=12.19"]`.
    """
    with tempfile.TemporaryDirectory(prefix="tofsim-") as folder:
        home = Path(folder)
        if isinstance(source, Mapping):
            path = home / "arrays"
            path.mkdir()
            for name, array in source.items():
                np.save(path / f"{name}.npy", np.asarray(array, dtype=np.float64))
        else:
            path = Path(source)
        out = home / "network.toml"
        words = ["quantize", f"--from={path}", f"--output={out}", *option_words(options), "--json"]
        _answer(words, 1, None)
        return Network.from_toml(out.read_text(), "quantized")
