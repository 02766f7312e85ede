"""What the tests share: the command that is in the wheel."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

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
