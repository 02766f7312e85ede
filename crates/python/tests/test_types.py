"""The stubs are right: mypy reads the package and these tests, and the stubs name what is there."""

import subprocess
import sys
from pathlib import Path

import tofsim
from tofsim import _tofsim

HERE = Path(__file__).parents[1]


def test_mypy_finds_no_fault() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file=pyproject.toml"],
        cwd=HERE,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs_are_those_of_what_is_there() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "tofsim._tofsim", "--ignore-missing-stub"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert (Path(tofsim.__file__).parent / "py.typed").is_file()


def test_all_that_the_package_names_has_a_text() -> None:
    for name in tofsim.__all__:
        thing = getattr(tofsim, name)
        assert thing.__doc__, name
    assert _tofsim.InputError is tofsim.InputError
