//! Blocks that are timed: single ones between registers, and the whole.

use tofsim::error::{Input, Result, hint};

/// Something that is placed by itself.
#[derive(Debug)]
pub struct TimedBlock {
    /// Its name, as on the command line.
    pub name: &'static str,
    /// The modules in it, joined where an output of one is an input of another; none: the whole, on a board.
    pub modules: &'static [&'static str],
    /// Ports that go to a pin and not to a register.
    pub pins: &'static [&'static str],
    /// True if it is timed by default.
    pub usual: bool,
}

const fn block(
    name: &'static str,
    modules: &'static [&'static str],
    pins: &'static [&'static str],
) -> TimedBlock {
    TimedBlock { name, modules, pins, usual: true }
}

/// The whole firmware.
pub const TOP: &str = "tof_top";

/// All that can be timed.
pub static BLOCKS: &[TimedBlock] = &[
    block("depth_estimator", &["depth_estimator"], &[]),
    block("estimator_histogram", &["depth_estimator", "histogram_builder"], &[]),
    block("histogram_builder", &["histogram_builder"], &[]),
    block("tdc", &["tdc"], &["tdc_stop"]),
    block("centroid_estimator", &["centroid_estimator"], &[]),
    block("vcsel_driver", &["vcsel_driver"], &["laser_on"]),
    TimedBlock { usual: false, ..block("likelihood_estimator", &["likelihood_estimator"], &[]) },
    TimedBlock { usual: false, ..block(TOP, &[], &[]) },
];

impl TimedBlock {
    /// Returns whether it is the whole firmware, with its own clocks and pins.
    pub fn is_top(&self) -> bool {
        self.modules.is_empty()
    }

    /// The block called `name`.
    ///
    /// # Errors
    /// When there is none.
    pub fn find(name: &str) -> Result<&'static Self> {
        BLOCKS.iter().find(|block| block.name == name).ok_or_else(|| {
            let (hint, names) = hint(name, BLOCKS.iter().map(|block| block.name));
            let expected = format!("no such block{hint}; there are {names}");
            Input::new("--block", expected).value(name).into()
        })
    }
}

/// Returns the rate that a clock has to reach [MHz]; a clock of another name is taken as the slower one.
pub fn required_mhz(clock: &str) -> f64 {
    if clock.contains("laser") { 250.0 } else { 125.0 }
}
