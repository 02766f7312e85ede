"""The firmware as a board: `python examples/board/board.py [SCENARIO] [-s KEY=VALUE] [--link PATH]`.

Compiles `rtl_ref` with the scenario's parameters in Verilator, connects the scenario's light and detector to it, and
prints the pseudo-terminal of its serial line. It runs until SIGTERM, Ctrl-C or the end of a pipe at its standard input.
The folder that it builds in gets csr.csv for LiteX's tools.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
OPTIONS = """--cc --exe --build -j 2 -O3 --x-assign fast --x-initial fast --noassert -Wno-fatal -Wno-lint -Wno-style
    -Wno-TIMESCALEMOD --top-module tof_top""".split()


def main() -> None:
    """Builds the board and becomes it."""
    parser = argparse.ArgumentParser(description="the firmware with simulated photons on a pseudo-terminal")
    parser.add_argument("scenario", nargs="?", default="kc705", help="built-in scenario, or path of a scenario file")
    parser.add_argument("-s", "--set", action="append", default=[], metavar="KEY=VALUE", help="set a scenario key")
    parser.add_argument("--parameter", action="append", default=[], metavar="NAME=VALUE", help="set a parameter")
    parser.add_argument("--baud", type=int, default=921600, help="symbol rate of the serial line [Bd]")
    parser.add_argument("--link", default="", metavar="PATH", help="symbolic link to the pseudo-terminal")
    parser.add_argument("--tofsim", type=Path, default=ROOT / "target/release/tofsim", help="the program")
    parser.add_argument("--lib", type=Path, help="folder with libtofsim_dpi.so [default: that of the program]")
    parser.add_argument("--build", type=Path, default=Path("board_build"), help="folder to build in")
    given = parser.parse_args()
    build, program = given.build.resolve(), given.tofsim.resolve()
    build.mkdir(parents=True, exist_ok=True)
    scenario = [given.scenario, *(word for key in given.set for word in ("-s", key))]
    call([program, "-q", "vectors", "tof_top", "--cycles", "1", "-o", build, "--scenario", *scenario])
    call([program, "-q", "board", "csr", "-o", build / "csr.csv", *scenario])
    described = json.loads((build / "tof_top/ports.json").read_text())
    period, first = (round(1000 * described["clock"][key]) for key in ("period_ps", "first_edge_ps"))
    bit_cycles = round(1e15 / period / given.baud)
    if bit_cycles < 4:
        parser.error(f"--baud: {given.baud}: expected at most {1e15 / period / 4:.0f}")
    parameters = {"Hosted": 1, "Baud": given.baud, "ParametersHash": parameters_hash(build / "csr.csv")}
    parameters = guarded(parameters | described["parameters"])
    parameters = {name: literal(value, build / "tof_top") for name, value in parameters.items()}
    parameters |= dict(pair.split("=", 1) for pair in given.parameter)
    model = verilate(build, parameters, (given.lib or program.parent).resolve())
    lines = "\n".join([given.scenario, *given.set])
    os.execv(model, [str(model), lines, str(period), str(first), str(bit_cycles), given.link])


def parameters_hash(registers: Path) -> int:
    """The hash of the firmware's parameters, which csr.csv has for LiteX."""
    rows = csv.reader(registers.open())
    return next(int(row[2]) for row in rows if row[:2] == ["constant", "parameters_hash_value"])


def guarded(parameters: dict[str, Any]) -> dict[str, Any]:
    """The parameters, with the limits of laser_guard at the scenario's pulse and at the shortest of its periods."""
    periods = parameters.get("LaserPeriods", [6])
    limits = {"LongestPulse": parameters.get("PulseHalfCycles", 1), "ShortestPeriod": 2 * min(periods)}
    return limits | parameters


def literal(value: int | list[int] | str, folder: Path) -> str:
    """A parameter's value in Verilog: a number, words of 16 bits, the first one lowest, or the path of a memory."""
    if isinstance(value, int):
        return f"64'd{value}" if value >= 1 << 31 else str(value)
    if isinstance(value, str):
        return f'"{folder / value}"'
    return f"{16 * len(value)}'h" + "".join(f"{word:04x}" for word in reversed(value))


def verilate(build: Path, parameters: dict[str, str], lib: Path) -> Path:
    """Compiles the board, and returns its program."""
    sources = [file for file in sorted((ROOT / "rtl_ref").glob("*.v")) if not file.name.endswith("5_top.v")]
    includes = f"-I{ROOT / 'crates/dpi/include'} -I{build / 'model'}"
    command = ["verilator", *OPTIONS, *(f"-G{name}={value}" for name, value in parameters.items())]
    command += ["--Mdir", str(build / "model"), "-CFLAGS", includes, "-MAKEFLAGS", "OPT_FAST=-O2 OPT_SLOW=-O0"]
    command += ["-LDFLAGS", f"{lib / 'libtofsim_dpi.so'} -Wl,-rpath,{lib} -lutil"]
    call([*command, HERE / "board.vlt", *sources, HERE / "main.cpp"])
    return build / "model/Vtof_top"


def call(command: Sequence[str | Path]) -> None:
    """Runs a program; if it fails, prints what it has written, and exits."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        failure = done.stdout if done.returncode != 0 else None
    except FileNotFoundError:
        failure = f"board: {command[0]}: no such program\n"
    if failure is not None:
        sys.stderr.write(failure)
        sys.exit(2)


if __name__ == "__main__":
    main()
