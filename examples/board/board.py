"""The firmware as a board: `python examples/board/board.py [SCENARIO] [-s KEY=VALUE] [--link PATH]`.

Compiles `rtl_ref` with the scenario's parameters in Verilator, connects the scenario's light and detector to it, and
prints the pseudo-terminal of its serial line. It runs until SIGTERM, Ctrl-C or the end of a pipe at its standard input.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
OPTIONS = """--cc --exe --build -j 2 -O3 --x-assign fast --x-initial fast --noassert -Wno-fatal -Wno-lint -Wno-style
    -Wno-TIMESCALEMOD --top-module tof_top""".split()


def main() -> int:
    """Builds the board and becomes it."""
    parser = argparse.ArgumentParser(description="the firmware with simulated photons on a pseudo-terminal")
    parser.add_argument("scenario", nargs="?", default="kc705", help="built-in scenario, or the path of a scenario file")
    parser.add_argument("-s", "--set", action="append", default=[], metavar="KEY=VALUE", help="set a scenario key")
    parser.add_argument("--parameter", action="append", default=[], metavar="NAME=VALUE", help="set a Verilog parameter")
    parser.add_argument("--baud", type=int, default=921600, help="symbol rate of the serial line [Bd]")
    parser.add_argument("--link", default="", metavar="PATH", help="symbolic link to the pseudo-terminal")
    parser.add_argument("--tofsim", type=Path, default=ROOT / "target/release/tofsim", help="the program")
    parser.add_argument("--lib", type=Path, help="folder with libtofsim_dpi.so [default: that of the program]")
    parser.add_argument("--build", type=Path, default=Path("board_build"), help="folder to build in")
    given = parser.parse_args()
    build, program = given.build.resolve(), given.tofsim.resolve()
    sets = [word for key in given.set for word in ("-s", key)]
    vectors = [program, "vectors", "tof_top", "--cycles", "1", "--scenario", given.scenario, *sets, "-o", build]
    if subprocess.run(vectors, stdout=subprocess.DEVNULL).returncode != 0:
        return 2
    described = json.loads((build / "tof_top/ports.json").read_text())
    period, first = (round(1000 * described["clock"][key]) for key in ("period_ps", "first_edge_ps"))
    bit_cycles = round(1e15 / period / given.baud)
    if bit_cycles < 4:
        print(f"board: --baud: {given.baud}: expected at most {1e15 / period / 4:.0f}", file=sys.stderr)
        return 2
    parameters = {name: literal(value, build / "tof_top") for name, value in described["parameters"].items()}
    parameters |= {"Hosted": "1", "Baud": str(given.baud)} | dict(pair.split("=", 1) for pair in given.parameter)
    model = verilate(build, parameters, (given.lib or program.parent).resolve())
    scenario = "\n".join([given.scenario, *given.set])
    os.execv(model, [str(model), scenario, str(period), str(first), str(bit_cycles), given.link])


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
    command += ["--Mdir", build / "model", "-CFLAGS", includes, "-MAKEFLAGS", "OPT_FAST=-O2 OPT_SLOW=-O0"]
    command += ["-LDFLAGS", f"{lib / 'libtofsim_dpi.so'} -Wl,-rpath,{lib} -lutil"]
    subprocess.run([*command, HERE / "board.vlt", *sources, HERE / "main.cpp"], stdout=sys.stderr, check=True)
    return build / "model/Vtof_top"


if __name__ == "__main__":
    sys.exit(main())
