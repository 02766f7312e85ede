"""States, integers and memories of MyHDL, whose VCD has an enumeration's values as words."""

import sys

from myhdl import Signal, StopSimulation, block, delay, enum, instance, intbv, now

State = enum("IDLE", "RUN", "DONE")
OneHot = enum("LEFT", "RIGHT", "UP", encoding="one_hot")


@block
def stage(clk, local, total):
    @instance
    def count():
        while True:
            yield clk.posedge
            local.next = (local + 3) % 16
            total.next = local

    return count


@block
def myhdl_states():
    clk = Signal(bool(0))
    state = Signal(State.IDLE)
    turn = Signal(OneHot.LEFT)
    level = Signal(intbv(0, min=-8, max=8))
    wide = Signal(intbv(0)[70:])
    total = Signal(intbv(0)[4:])
    local = Signal(intbv(0)[4:])
    inner = stage(clk, local, total)

    @instance
    def drive():
        states = [State.RUN, State.DONE, State.IDLE, State.RUN]
        turns = [OneHot.LEFT, OneHot.UP, OneHot.RIGHT, OneHot.LEFT]
        for k in range(8):
            yield delay(5)
            clk.next = not clk
            level.next = k - 6
            wide.next = (1 << 69) >> (k * 9) | k
            if k % 2:
                state.next = states[k // 2]
                turn.next = turns[k // 2]
        yield delay(5)
        raise StopSimulation

    @instance
    def print_rows():
        print("time_ps;bits myhdl_states.clk;word myhdl_states.state;word myhdl_states.turn;bits myhdl_states.level;"
              "bits myhdl_states.wide;bits myhdl_states.total;bits myhdl_states.stage0.clk;"
              "bits myhdl_states.stage0.total;"
              "bits myhdl_states.local;bits myhdl_states.stage0.local")
        while True:
            numbers = [(int(level), 4), (int(wide), 70), (int(total), 4), (int(clk), 1), (int(total), 4),
                       (int(local), 4), (int(local), 4)]
            bits = [f"{number & ((1 << width) - 1):0{width}b}" for number, width in numbers]
            print(1000 * now(), int(clk), state, turn, *bits, sep=";")
            yield clk, state, turn, level, wide, total, local
            yield delay(0)

    return drive, inner, print_rows


bench = myhdl_states()
bench.config_sim(trace=True, tracebackup=False, timescale="1ns", filename=sys.argv[1].removesuffix(".vcd"))
bench.run_sim(quiet=1)
