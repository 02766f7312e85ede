"""How exactly estimators find the distance."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ._tofsim import Network, _answer
from ._verbs import Given, Grid, Progress, grid_words, option_words, scenario_of


class Evaluation:
    """What `tofsim evaluate` finds: `figures` is its JSON, `pictures` are its SVGs by name."""

    def __init__(self, figures: Any, pictures: dict[str, str]) -> None:
        self.figures = figures
        self.pictures = pictures

    @property
    def estimators(self) -> dict[str, Any]:
        """The figures of each estimator, by its name."""
        return {one["name"]: one for one in self.figures["estimators"]}

    @property
    def notes(self) -> list[Any]:
        """What the figures lie outside of."""
        return list(self.figures["notes"])

    def by(self, key: str = "distance_m", estimator: str | None = None) -> dict[str, list[Any]]:
        """Columns of a table: the values of `key`, and the spread of the errors there."""
        one = self.estimators[estimator or next(iter(self.estimators))]
        groups = one.get(f"by_{key}")
        if groups is None:
            own = {of["key"]: of["groups"] for of in one.get("by_key", [])}
            if key not in own:
                raise KeyError(key)
            groups = own[key]
        names = groups[0].keys() if groups else []
        return {name: [group[name] for group in groups] for name in names}

    def _repr_svg_(self) -> str | None:
        named = [name for name in self.pictures if name.endswith("_by_distance_m")]
        shown = [name for name in named if name.startswith("errors_")] or named
        return self.pictures[shown[0]] if shown else None

    def _repr_html_(self) -> str:
        head = "<tr><th>estimator</th><th>2σ [mm]</th><th>mean error [mm]</th><th>failures</th></tr>"
        rows = [_row(name, one["all"]) for name, one in self.estimators.items()]
        return f"<table>{head}{''.join(rows)}</table>{self._repr_svg_() or ''}"

    def __repr__(self) -> str:
        return f"<tofsim.Evaluation of {', '.join(self.estimators)}: {self.figures['rows']} histograms>"


def _row(name: str, spread: dict[str, Any]) -> str:
    cells = [_number(spread["two_sd_mm"]), _number(spread["mean_mm"]), str(spread["failures"])]
    return f"<tr><td>{name}</td>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"


def evaluate(
    network: Network | str | None = None,
    scenario: Given = None,
    *,
    estimators: Sequence[str] | None = None,
    grid: Grid = None,
    rows: int | None = None,
    repeats: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Evaluation:
    """Measures the accuracy of a network and other estimators, as `tofsim evaluate`.

    `grid` is `{key: values}` of any numeric keys, or as the command line has it; further options are the command
    line's: `check=0` leaves out the frames that are simulated cycle by cycle.
    """
    with tempfile.TemporaryDirectory(prefix="tofsim-") as folder:
        home = Path(folder)
        name, overrides = scenario_of(scenario)._words(home)
        words = ["evaluate", f"--scenario={name}", *overrides]
        if isinstance(network, Network):
            path = home / "network.toml"
            network.save(path)
            words.append(str(path))
        elif network is not None:
            words.append(str(network))
        if estimators is not None:
            words.append("--estimator=" + ",".join(estimators))
        words += [f"--grid={each}" for each in grid_words(grid)]
        given = {"rows": rows, "repeats": repeats, "seed": seed, "threads": threads}
        words += option_words({**given, **options})
        out = home / "out"
        figures, _ = _answer([*words, f"--output={out}", "--json"], threads, progress)
        pictures = {path.stem: path.read_text() for path in sorted(out.glob("*.svg"))}
    return Evaluation(figures, pictures)
