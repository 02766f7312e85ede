"""Runs `test_tof_top.py` in Icarus Verilog: `python examples/cocotb/run.py [--rtl FOLDER]`."""

import argparse
import sys
from pathlib import Path

from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner

HERE = Path(__file__).resolve().parent
# The Verilog's defaults are the scenario kc705, with memories by paths from here.
ROOT = HERE.parents[1]


def main() -> int:
    """Builds the design and runs the test; 1 if something differs."""
    parser = argparse.ArgumentParser(description="the Verilog beside the model, clock by clock")
    parser.add_argument("--rtl", type=Path, default=ROOT / "rtl_ref", help="folder with the Verilog")
    parser.add_argument("--shots", type=int, default=60, help="shots of a frame")
    parser.add_argument("--edges", type=int, default=3000, help="edges of clk_sys")
    parser.add_argument("--build", type=Path, default=Path("sim_build"), help="folder to build in")
    parser.add_argument("--waves", action="store_true", help="write a waveform into that folder")
    given = parser.parse_args()
    simulator, build = get_runner("icarus"), given.build.resolve()
    simulator.build(
        sources=sorted(given.rtl.resolve().glob("*.v")),
        hdl_toplevel="tof_top",
        parameters={"ShotsPerFrame": given.shots},
        timescale=("1ps", "1fs"),
        build_dir=build,
        always=True,
        waves=given.waves,
    )
    sys.path.insert(0, str(HERE))
    results = simulator.test(
        test_module="test_tof_top",
        hdl_toplevel="tof_top",
        extra_env={"SHOTS": str(given.shots), "EDGES": str(given.edges)},
        build_dir=build,
        test_dir=ROOT,
        results_xml=str(build / "results.xml"),
        waves=given.waves,
    )
    tests, failures = get_results(results)
    return 0 if tests == 1 and failures == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
