"""A counter with a memory in PyRTL, whose VCD has wires without scopes."""

import sys

import pyrtl

data = pyrtl.Input(5, "data")
enable = pyrtl.Input(1, "enable")
count = pyrtl.Register(9, "count")
wide = pyrtl.Register(80, "wide", reset_value=3)
memory = pyrtl.MemBlock(5, 2, "memory")
out = pyrtl.Output(5, "out")
count.next <<= count + data + 1
wide.next <<= pyrtl.concat(wide[:70], data, count[:5])
memory[count[:2]] <<= pyrtl.MemBlock.EnabledWrite(data, enable)
out <<= memory[data[:2]]

simulation = pyrtl.Simulation(register_value_map={count: 500})
names = ["count", "data", "enable", "out", "wide"]
widths = [9, 5, 1, 5, 80]
ranges = [f"[{width - 1}:0]" if width > 1 else "" for width in widths]
print("time_ps", *(f"bits{range} logic.{name}" for range, name in zip(ranges, names)), sep=";")
for cycle in range(12):
    simulation.step({"data": 7 * cycle % 32, "enable": cycle % 3 > 0})
    cells = (f"{simulation.inspect(name):0{width}b}" for name, width in zip(names, widths))
    print(10_000 * cycle, *cells, sep=";")
with open(sys.argv[1], "w") as file:
    simulation.tracer.print_vcd(file, include_clock=False)
