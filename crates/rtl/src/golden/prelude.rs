//! Imports for the file of a block's stimulus.

pub use tofsim::error::Result;
pub use tofsim::firmware::tof_top::slot::SlotEstimator;
pub use tofsim::kernel::signals::Signals;
pub use tofsim::kernel::sizes::Size;
pub use tofsim::kernel::{Clocked, S, Time, U};
pub use tofsim::network::mem;
pub use tofsim::signals;

pub use super::configuration::{
    ARRAY, CALIBRATED, CLOCKS, COUNT_STAGES_2, Configuration, HOSTED, HOSTED_LONG_PULSE, LEADING,
    LONG_PULSE, NEURONS_16, NEURONS_31, REORDERED,
};
pub use super::cover::{Cover, bits, ends};
pub use super::draw::{Draw, MEMORIES};
pub use super::glue::Glue;
pub use super::model::{Edge, Model};
pub use super::parameters::{self, Parameter, files};
pub use super::record::Recorder;
pub use super::setting::Setting;
pub use super::spec::{FIRST_RESET, Latency, Spec, Vectors};
pub use super::stops::{self, Stops};
pub use super::timing;
