"""Variables of every kind that pyvcd writes; the script prints what it has it write."""

import sys

from vcd import VCDWriter

COLUMNS = [
    ("bits", "pyvcd_types.level", "wire", 1),
    ("bits[7:0]", "pyvcd_types.count", "integer", 8),
    ("real", "pyvcd_types.ratio", "real", 64),
    ("word", "pyvcd_types.mode", "string", None),
    ("event", "pyvcd_types.tick", "event", None),
    ("bits", "pyvcd_types.block.bus", "tri", 5),
    ("bits[63:0]", "pyvcd_types.block.stamp", "time", 64),
    ("word", "pyvcd_types.block.f(1).text", "string", None),
]
CHANGES = [
    (0, [(0, "x"), (1, 0), (2, 0.0), (3, "idle"), (5, "zzzzz"), (6, 0), (7, "")]),
    (3, [(0, 1), (1, 200), (2, -0.1), (3, "a b\tc"), (4, None), (5, "1x"), (7, "\\n")]),
    (4, [(0, "z"), (2, 1e300), (3, "idle"), (6, 2**63 + 5)]),
    (9, [(0, 0), (0, 1), (0, 0), (1, 255), (5, 9), (4, None)]),
    (1_000_000, [(2, 0.1 + 0.2), (3, "é"), (5, "01xz0"), (7, "done")]),
]


def text(column, value):
    kind, _, _, width = COLUMNS[column]
    if kind.startswith("bits"):
        if isinstance(value, str):
            return value.rjust(width, "0" if value[0] in "01" else value[0])
        return f"{value:0{width}b}"
    return repr(value) if kind == "real" else str(value)


print("time_ps", *(f"{kind} {name}" for kind, name, *_ in COLUMNS), sep=";")
cells = [0 if kind == "event" else "" for kind, *_ in COLUMNS]
with open(sys.argv[1], "w", encoding="utf-8") as file, VCDWriter(file, timescale="100 ps", date="") as writer:
    variables = []
    for _, name, kind, width in COLUMNS:
        scope, own = name.rsplit(".", 1)
        initial = {"string": "", "real": 0.0, "event": None}.get(kind, 0)
        variables.append(writer.register_var(scope, own, kind, size=width, init=initial))
    for time, changes in CHANGES:
        for column, value in changes:
            if COLUMNS[column][0] == "event":
                writer.change(variables[column], time, True)
                cells[column] += 1
            else:
                writer.change(variables[column], time, value)
                cells[column] = text(column, value)
        print(100 * time, *cells, sep=";")
