"""The code in `docs/python.md` runs, and what it names is there."""

import re

import tofsim
import tofsim.dask
from conftest import ROOT
from firmware import Firmware


def test_the_code_runs(firmware: Firmware) -> None:
    text = (ROOT / "docs" / "python.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) == 3
    names: dict[str, object] = {}
    for block in blocks:
        exec(block.replace("/dev/ttyUSB0", firmware.port), names)
    frames = names["frames"]
    assert isinstance(frames, tofsim.Frames) and len(frames) == 1000
    taken = names["taken"]
    assert isinstance(taken, tofsim.Frames) and len(taken) == 100 == firmware.lit


def test_every_function_of_the_table_is_there() -> None:
    text = (ROOT / "docs" / "python.md").read_text()
    table = text.split("## Further functions")[1].split("\n## ")[0]
    named = re.findall(r"^\| `([\w.]+)\(", table, re.MULTILINE)
    assert len(named) == 13
    for name in named:
        thing: object = tofsim
        for part in name.split("."):
            thing = getattr(thing, part)
        assert callable(thing), name
