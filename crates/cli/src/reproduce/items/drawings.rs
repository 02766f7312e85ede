//! Figures with nothing to make again: drawings, and screens of a design tool.

use crate::reproduce::item::Item;

const DRAWING: &str = "A drawing: it shows how parts are connected or named, and no values.";

pub const ITEMS: [Item; 18] = [
    Item::nothing("fig-2.1", "Block diagram of the system", DRAWING),
    Item::nothing("fig-2.2", "Sensor module", DRAWING),
    Item::nothing("fig-2.3", "FPGA module", DRAWING),
    Item::nothing("fig-2.4", "Acquisition computer", DRAWING),
    Item::nothing("fig-3.1", "Flow of the simulation", DRAWING),
    Item::nothing("fig-3.2", "Set-up of the optical simulation", DRAWING),
    Item::nothing(
        "fig-5.2",
        "Features of findpeaks",
        "A drawing that explains the marks of Fig. 5.4; the same marks are in fig-5.4 here.",
    ),
    Item::nothing("fig-5.6", "Architecture of the network", DRAWING),
    Item::nothing(
        "fig-6.1",
        "The architecture in Vivado's block design",
        "A screen of Vivado, which is not at hand; tof_top in docs/model.md has the same blocks and ports.",
    ),
    Item::nothing("fig-6.2", "Connections of the two boards", DRAWING),
    Item::nothing("fig-6.4", "The SPAD array", DRAWING),
    Item::nothing("fig-6.5", "Laser and SPAD control with its analyser", DRAWING),
    Item::nothing("fig-6.8", "Blocks of the TDC", DRAWING),
    Item::nothing(
        "fig-6.10",
        "The carry chain on the device",
        "A screen of Vivado's placement on a Kintex-7; there is no place and route for that part here.",
    ),
    Item::nothing("fig-6.11", "Preloaded codes and their analyser", DRAWING),
    Item::nothing("fig-6.15", "A binary fixed-point word", DRAWING),
    Item::nothing("fig-6.18", "Blocks of the depth estimator", DRAWING),
    Item::nothing("fig-6.20", "The depth estimator and its analyser", DRAWING),
];
