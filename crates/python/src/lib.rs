//! tofsim as a Python package: thin doors to the library and the command, and no model of their own.

mod arrays;
mod board;
mod command;
mod dataset;
mod dataset_files;
mod device;
mod errors;
mod estimates;
mod frame;
mod frames;
mod ila;
mod image;
mod network;
mod objects;
mod pictures;
mod plan;
mod running;
mod scenario;
mod simulate;
mod waves;

/// Contents of the package `tofsim`.
#[pyo3::pymodule]
mod _tofsim {
    #[pymodule_export]
    use crate::board::Board;
    #[pymodule_export]
    use crate::command::{answer, main};
    #[pymodule_export]
    use crate::dataset::Dataset;
    #[pymodule_export]
    use crate::dataset_files::DatasetFiles;
    #[pymodule_export]
    use crate::device::Device;
    #[pymodule_export]
    use crate::errors::{InputError, refuse};
    #[pymodule_export]
    use crate::estimates::{estimate, explain, link_budget};
    #[pymodule_export]
    use crate::frame::Frame;
    #[pymodule_export]
    use crate::frames::Frames;
    #[pymodule_export]
    use crate::ila::read_ila;
    #[pymodule_export]
    use crate::image::image;
    #[pymodule_export]
    use crate::network::Network;
    #[pymodule_export]
    use crate::plan::{Plan, PlanTable};
    #[pymodule_export]
    use crate::scenario::{Scenario, networks, scenarios};
    #[pymodule_export]
    use crate::simulate::simulate;
    #[pymodule_export]
    use crate::waves::{read_waves, wave_signals};
}
