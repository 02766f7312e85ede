"""The code in `docs/python.md` runs, and what it names is there."""

import re

import tofsim
import tofsim.dask
from conftest import ROOT


def test_the_code_runs() -> None:
    text = (ROOT / "docs" / "python.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) == 2
    names: dict[str, object] = {}
    for block in blocks:
        exec(block, names)
    frames = names["frames"]
    assert isinstance(frames, tofsim.Frames) and len(frames) == 1000


def test_every_function_of_the_table_is_there() -> None:
    text = (ROOT / "docs" / "python.md").read_text()
    table = text.split("## Further functions")[1].split("\n## ")[0]
    named = re.findall(r"^\| `([\w.]+)\(", table, re.MULTILINE)
    assert len(named) == 12
    for name in named:
        thing: object = tofsim
        for part in name.split("."):
            thing = getattr(thing, part)
        assert callable(thing), name
