"""The command inside the wheel."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import tofsim


def script() -> str:
    found = shutil.which("tofsim", path=str(Path(sys.executable).parent))
    assert found, "the wheel has no command"
    return found


def run(*words: str, cwd: Path | None = None) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([script(), *words], capture_output=True, text=True, check=False, cwd=cwd)


def test_the_command_works_and_its_outputs_are_made_again(tmp_path: Path) -> None:
    assert run("--version").stdout.startswith("tofsim ")
    done = run("run", "near", "--waves=none", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    again = run("rerun", "out/histogram.svg", cwd=tmp_path)
    assert again.returncode == 0, again.stderr


def test_exit_statuses_are_the_program_s() -> None:
    assert run("run", "nonesuch").returncode == 2
    assert run("--bogus").returncode == 2
    assert run("scenario", "list").returncode == 0


def test_an_answer_is_what_the_command_prints() -> None:
    found = tofsim.command("scenario", "list")
    assert [one["name"] for one in found] == tofsim.scenarios()
    assert found[0]["name"] == "kc705"
    with pytest.raises(tofsim.InputError, match="unexpected argument '--bogus'"):
        tofsim.command("run", "--bogus")


def test_the_page_is_refused_for_there_is_no_server() -> None:
    said = "serve: is not in the Python package, which has no server"
    done = run("serve")
    assert done.returncode == 2 and said in done.stderr
    with pytest.raises(tofsim.InputError, match=said):
        tofsim.command("serve")
