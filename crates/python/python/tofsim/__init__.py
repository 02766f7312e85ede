"""tofsim: a cycle-accurate simulator of the FPGA firmware of a time-of-flight rangefinder."""

from . import ila, waves
from ._evaluation import Evaluation, evaluate
from ._sets import dataset
from ._tofsim import (
    Board,
    Device,
    Frame,
    Frames,
    InputError,
    Network,
    Plan,
    Scenario,
    estimate,
    explain,
    image,
    link_budget,
    networks,
    scenarios,
    simulate,
)
from ._training import quantize, train
from ._verbs import command, compare

__all__ = [
    "Board",
    "Device",
    "Evaluation",
    "Frame",
    "Frames",
    "InputError",
    "Network",
    "Plan",
    "Scenario",
    "command",
    "compare",
    "dataset",
    "estimate",
    "evaluate",
    "explain",
    "ila",
    "image",
    "link_budget",
    "networks",
    "quantize",
    "scenarios",
    "simulate",
    "train",
    "waves",
]
