"""Verbs of the command line as functions: the same options, the same messages, the same JSON."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Union

from ._tofsim import Scenario, _answer, _refuse

Given = Union[Scenario, str, "os.PathLike[str]", Mapping[str, Any], None]
Progress = Callable[[int, int], object]
Grid = Union[str, Iterable[str], Mapping[str, Any], None]


def scenario_of(given: Given) -> Scenario:
    """A scenario, from what makes one."""
    return given if isinstance(given, Scenario) else Scenario(given)


def grid_words(grid: Grid) -> list[str]:
    """A grid as the command line has it, from `{key: values}`, where values are numbers or a text as `0.1..0.6:0.1`."""
    if grid is None:
        return []
    if isinstance(grid, str):
        return [grid]
    if isinstance(grid, Mapping):
        words = [f"{key}={_values(values)}" for key, values in grid.items()]
    else:
        words = list(grid)
    # Without any it would be the grid of the scenario.
    return words or _refuse("grid", "expected a key at least, or None for the scenario's own")


def _values(values: Any) -> str:
    if isinstance(values, str):
        return values
    if isinstance(values, Iterable):
        return ",".join(repr(float(value)) for value in values)
    return repr(float(values))


def option_words(options: Mapping[str, Any]) -> list[str]:
    """Options as the command line has them: `check=8` is `--check=8`, and True stands for the option alone."""
    words = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
        elif isinstance(value, (list, tuple)):
            words.extend(f"{option}={each}" for each in value)
        else:
            words.append(f"{option}={value}")
    return words


def command(*words: str, threads: int | None = None, progress: Progress | None = None) -> Any:
    """What `tofsim WORDS --json` prints, as Python's dictionaries and lists.

    `command("budget", "near")` is the table of `tofsim budget near`. A wrong option or input raises `InputError`.
    """
    return _answer([*words, "--json"], threads, progress)[0]


def compare(
    a: Given,
    b: str | os.PathLike[str],
    *,
    simulate: bool = False,
    threads: int | None = None,
    **options: Any,
) -> Any:
    """Lays two waveforms or captures over each other, as `tofsim compare`; its JSON, and `same`.

    `a` is what is expected: a file or, as a `Scenario` or with `simulate=True`, what is simulated. Options are those of
    the command line: `compare(scenario, "board.ila", map="fig_6_6")`.
    """
    with tempfile.TemporaryDirectory(prefix="tofsim-") as home:
        if simulate or isinstance(a, (Scenario, Mapping)):
            name, overrides = scenario_of(a)._words(Path(home))
            words = [f"--scenario={name}", *overrides, os.fspath(b)]
        else:
            if a is None:
                raise TypeError("compare: expected a file or a scenario")
            words = [os.fspath(a), os.fspath(b)]
        words = ["compare", *option_words(options), *words, "--json"]
        found, same = _answer(words, threads, None)
    found["same"] = same
    return found
