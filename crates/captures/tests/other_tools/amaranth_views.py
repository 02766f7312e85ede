"""Enumerations, structures, arrays and memories of Amaranth, whose VCD has both names and numbers of states."""

import sys

from amaranth.hdl import Elaboratable, Module, Signal, signed
from amaranth.lib import data, enum
from amaranth.lib.memory import Memory
from amaranth.sim import Simulator


class State(enum.Enum, shape=2):
    IDLE = 0
    RUN = 1
    DONE = 3


class Pair(data.Struct):
    high: signed(4)
    state: State
    valid: 1


class Views(Elaboratable):
    def __init__(self):
        self.count = Signal(3)
        self.level = Signal(signed(5))
        self.wide = Signal(72, init=1)
        self.state = Signal(State)
        self.pair = Signal(Pair)
        self.memory = Memory(shape=4, depth=2, init=[9, 6])
        self.write = self.memory.write_port()
        self.rows = Signal(data.ArrayLayout(3, 2))

    def elaborate(self, platform):
        m = Module()
        m.submodules.memory = self.memory
        write = self.write
        m.d.comb += [write.addr.eq(self.count[0]), write.data.eq(self.count), write.en.eq(self.count[1])]
        m.d.sync += [self.count.eq(self.count + 1), self.level.eq(self.level - 3), self.wide.eq(self.wide << 13),
                     self.pair.high.eq(self.level[1:]), self.rows[0].eq(self.count), self.rows[1].eq(~self.count)]
        with m.FSM(name="fsm"):
            with m.State("WAIT"):
                m.d.sync += [self.state.eq(State.RUN), self.pair.state.eq(self.state)]
                with m.If(self.count == 2):
                    m.next = "WORK"
            with m.State("WORK"):
                m.d.sync += [self.state.eq(State.DONE), self.pair.state.eq(State.RUN), self.pair.valid.eq(1)]
                m.next = "WAIT"
        return m


views = Views()
COLUMNS = [("bits[2:0]", "count", views.count, 3), ("bits[4:0]", "level", views.level, 5),
           ("bits[71:0]", "wide", views.wide, 72), ("word", "state", views.state, None),
           ("bits[3:0]", "\\pair.high", views.pair.high, 4), ("word", "\\pair.state", views.pair.state, None),
           ("bits", "\\pair.valid", views.pair.valid, 1), ("bits[2:0]", "\\rows[0]", views.rows[0], 3),
           ("bits[2:0]", "\\rows[1]", views.rows[1], 3),
           ("bits[6:0]", "pair", views.pair.as_value(), 7), ("bits[5:0]", "rows", views.rows.as_value(), 6),
           ("bits[3:0]", "\\memory[0]", views.memory.data[0], 4), ("bits[3:0]", "\\memory[1]", views.memory.data[1], 4)]
COLUMNS += [column for scope in ["", "memory."] for column in [
    ("bits", scope + "write__addr", views.write.addr, 1), ("bits[3:0]", scope + "write__data", views.write.data, 4),
    ("bits", scope + "write__en", views.write.en, 1)]]
PERIOD = 10_000


def text(value, width):
    return value.name if width is None else f"{int(value) & ((1 << width) - 1):0{width}b}"


def row(ctx, time, clk):
    print(time, clk, *(text(ctx.get(value), width) for _, _, value, width in COLUMNS), sep=";")


async def bench(ctx):
    print("time_ps;bits bench.top.clk", *(f"{kind} bench.top.{name}" for kind, name, *_ in COLUMNS), sep=";")
    row(ctx, 0, 0)
    for cycle in range(8):
        await ctx.tick()
        row(ctx, cycle * PERIOD + PERIOD // 2, 1)
        if cycle < 7:
            row(ctx, (cycle + 1) * PERIOD, 0)



simulator = Simulator(views)
simulator.add_clock(10e-9)
simulator.add_testbench(bench)
with simulator.write_vcd(sys.argv[1]):
    simulator.run()
