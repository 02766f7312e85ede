"""Python goes on while something runs, and may interrupt it."""

import os
import signal
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest
import tofsim

MANY = 10_000_000
# Longest time from an interruption to its exception [s].
ALLOWED = 0.3


def test_a_thread_that_counts_goes_on() -> None:
    counted, stop = [0], threading.Event()

    def count() -> None:
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    began = time.monotonic()
    tofsim.simulate("kc705", 150, "cycle", threads=1)
    took = time.monotonic() - began
    stop.set()
    thread.join()
    assert took > 0.1, "too short to tell"
    # It wakes a thousand times a second at most; on a loaded machine less often.
    assert counted[0] > 100 * took, f"{counted[0]} in {took:.2f} s"


def interrupted(task: Callable[[], object], after: float = 0.5) -> float:
    """Time from an interruption to its exception [s]."""
    sent = [0.0]

    def interrupt() -> None:
        time.sleep(after)
        sent[0] = time.monotonic()
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        task()
    took = time.monotonic() - sent[0]
    thread.join()
    return took


TASKS: dict[str, Callable[[], object]] = {
    "cycle": lambda: tofsim.simulate("kc705", MANY // 1000, "cycle"),
    "shot": lambda: tofsim.simulate("kc705", MANY // 10, "shot"),
    "histogram": lambda: tofsim.simulate("kc705", MANY // 10, "histogram"),
    "pairs": lambda: tofsim.simulate(
        tofsim.Scenario().with_(firmware={"dark_frames": True}), MANY // 1000, "cycle"
    ),
    "by cause": lambda: tofsim.simulate("kc705", 1000, by_cause=True),
    "evaluate": lambda: tofsim.evaluate(rows=5_000_000, check=0, estimators=["likelihood"]),
    "train": lambda: tofsim.Network.train(recipe="short"),
    "device": lambda: tofsim.Device().step(MANY * 100),
    "dataset": lambda: list(tofsim.dataset(rows=5_000_000, batch=500_000)),
    "plan": lambda: tofsim.Plan("fig-4-2").work(list(range(len(tofsim.Plan("fig-4-2")))) * 100),
    "command": lambda: tofsim.command("run", "--frames=100000", "--fidelity=shot"),
}


@pytest.mark.parametrize("name", list(TASKS))
def test_an_interruption_is_answered_at_once(name: str) -> None:
    took = interrupted(TASKS[name])
    print(f"{name}: {took:.3f} s")
    assert took < ALLOWED


@pytest.fixture(scope="module")
def captures(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A long capture and a long waveform."""
    folder = tmp_path_factory.mktemp("long")
    rows = "\n".join(f"{k},{k},0,{k & 1:x},{k & 0xFFFF:04x}" for k in range(3_000_000))
    head = "Sample in Buffer,Sample in Window,TRIGGER,start,tdc_code[15:0]\nRadix - UNSIGNED,UNSIGNED,UNSIGNED,HEX,HEX\n"
    (folder / "long.csv").write_text(head + rows + "\n")
    body = "\n".join(f"#{k}\n{k & 1}!" for k in range(4_000_000))
    vcd = "$timescale 1ns $end\n$scope module tof_top $end\n$var wire 1 ! start $end\n$upscope $end\n$enddefinitions $end\n"
    (folder / "long.vcd").write_text(f"{vcd}{body}\n")
    return {"csv": folder / "long.csv", "vcd": folder / "long.vcd"}


@pytest.mark.parametrize("name", ["dataset", "compare", "ila.read"])
def test_what_is_interrupted_ends(name: str, captures: dict[str, Path]) -> None:
    csv, vcd = captures["csv"], captures["vcd"]
    tasks: dict[str, Callable[[], object]] = {
        "dataset": lambda: list(tofsim.dataset(rows=5_000_000, batch=5_000_000)),
        "compare": lambda: tofsim.compare(vcd, vcd),
        "ila.read": lambda: tofsim.ila.read(csv),
    }
    took = interrupted(tasks[name], 0.15)
    spent = time.process_time()
    time.sleep(0.5)
    spent = time.process_time() - spent
    print(f"{name}: {took:.3f} s, {spent:.3f} s of work after it")
    assert took < ALLOWED
    assert spent < 0.25, "it works on"


def test_a_run_after_an_interruption_is_as_any_other() -> None:
    expected = tofsim.simulate("kc705", 3, "shot").histograms.tobytes()
    interrupted(lambda: tofsim.simulate("kc705", MANY, "shot"), 0.1)
    assert tofsim.simulate("kc705", 3, "shot").histograms.tobytes() == expected


def test_progress_is_told_and_its_exception_ends_the_run() -> None:
    told: list[tuple[int, int]] = []
    tofsim.simulate("kc705", 300, "shot", progress=lambda *now: told.append(now))
    assert told[-1] == (300, 300)
    assert told == sorted(told)

    def refuse(done: int, of: int) -> None:
        raise RuntimeError(f"enough of {of}")

    with pytest.raises(RuntimeError, match=f"enough of {MANY}"):
        tofsim.simulate("kc705", MANY, "shot", progress=refuse)


def test_runs_go_on_side_by_side() -> None:
    expected = tofsim.simulate("near", 20, "shot").histograms.tobytes()
    found: list[bytes] = []

    def run() -> None:
        found.append(tofsim.simulate("near", 20, "shot", threads=1).histograms.tobytes())

    threads = [threading.Thread(target=run) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 4
