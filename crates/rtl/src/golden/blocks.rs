//! The blocks, one file each: what is special about it and how its input is drawn.

use super::spec::Spec;

/// Blocks, each a module of the same name here and in `rtl_ref`.
macro_rules! blocks {
    ($($name:ident)*) => {
        $(pub(super) mod $name;)*

        /// Every block, in the order of their names.
        pub static BLOCKS: &[Spec] = &[$(Spec {
            verilog: include_str!(concat!("../../../../rtl_ref/", stringify!($name), ".v")),
            ..$name::SPEC
        }),*];
    };
}

blocks! {
    carry_chain
    centroid_estimator
    coarse_counter
    code_preload
    control_sync
    ddr_output
    depth_estimator
    estimator_ctrl
    forward1
    forward2
    frame_ctrl
    histogram_builder
    histogram_preload
    laser_guard
    likelihood_estimator
    likelihood_glass
    likelihood_memory
    likelihood_pair
    likelihood_scan
    likelihood_solver
    likelihood_sums
    likelihood_terms
    lvds_output
    pll
    registers
    reset_sync
    spad_control
    tansig
    tdc
    tdc_calibration
    tdc_decoder
    tdc_latch
    tof_top
    uart_bridge
    vcsel_driver
}

/// The estimator that the thesis does not have, and other people's designs need not.
pub const CENTROID: &str = "centroid_estimator";
/// As [`CENTROID`].
pub const LIKELIHOOD: &str = "likelihood_estimator";

/// File name and text of each block's module.
pub fn verilog() -> impl Iterator<Item = (String, &'static str)> {
    BLOCKS.iter().map(|spec| (format!("{}.v", spec.name), spec.verilog))
}

/// The block called `name`.
pub fn find(name: &str) -> Option<&'static Spec> {
    BLOCKS.iter().find(|spec| spec.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::configuration::Configuration;
    use crate::golden::draw::MEMORIES;
    use crate::golden::setting::Setting;
    use crate::golden::spec::{FIRST_RESET, Vectors};
    use crate::golden::timing::BenchStep;
    use tofsim::kernel::sizes::Sizes;
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    fn vectors(spec: &'static Spec, seed: u64, cycles: Option<usize>) -> Vectors {
        let setup = Setup::new(scenario::load(scenario::DEFAULT, &[]).unwrap()).unwrap();
        let setting = Setting { seed, cycles, ..Setting::new(setup) };
        (spec.record)(spec, &setting).unwrap()
    }

    fn configured(spec: &'static Spec, configuration: &Configuration, seed: u64) -> Vectors {
        let setup = Setup::new(scenario::load(scenario::DEFAULT, &[]).unwrap()).unwrap();
        let setting = configuration.setting(&Setting { seed, ..Setting::new(setup) }).unwrap();
        (spec.record)(spec, &setting).unwrap()
    }

    #[test]
    fn what_has_a_reset_is_reset_soon() {
        for spec in BLOCKS {
            let vectors = vectors(spec, 1, Some(FIRST_RESET + 1));
            let Some(reset) = spec.reset else { continue };
            let columns = vectors.stimulus.columns();
            let column = columns.iter().find(|column| column.name == reset).unwrap();
            assert!(vectors.stimulus.row(FIRST_RESET)[column.low], "{}", spec.name);
        }
    }

    /// With another seed than the two of the lockstep tests, which see the same of theirs.
    #[test]
    #[ignore = "long: ./check --full"]
    fn every_stimulus_covers_its_goals() {
        let (seed, mut gaps) = (20_221_121, Vec::new());
        for spec in BLOCKS {
            let mut all = vec![("", vectors(spec, seed, None))];
            for configuration in spec.configurations {
                let vectors = configured(spec, configuration, seed);
                let names: Vec<_> = vectors.parameters.iter().map(|(name, _)| *name).collect();
                let has = |name: &&str| names.contains(name);
                assert!(configuration.parameters.iter().all(has), "{}: {names:?}", spec.name);
                all.push((configuration.name, vectors));
            }
            for (configuration, vectors) in all {
                let coverage = vectors.coverage;
                assert!(!coverage.is_empty(), "{}", spec.name);
                for cover in coverage.iter().filter(|cover| cover.met() < cover.cases()) {
                    let missing: Vec<_> = cover.missing().collect();
                    let name = spec.name;
                    gaps.push(format!(
                        "{name}.{configuration}, seed {seed}: {}: {missing:?}",
                        cover.what
                    ));
                }
            }
        }
        assert!(gaps.is_empty(), "not covered:\n{}", gaps.join("\n"));
    }

    #[test]
    fn blocks_are_in_the_order_of_their_names() {
        assert!(BLOCKS.is_sorted_by_key(|spec| spec.name));
    }

    #[test]
    fn each_block_has_a_stream_of_its_own_by_number_or_by_name() {
        let named = |name| Spec { name, ..tdc::SPEC }.stream();
        let mut streams: Vec<_> = BLOCKS.iter().map(Spec::stream).collect();
        streams.extend([MEMORIES, u64::MAX, named("tdc_2"), named("tdc_3")]);
        streams.sort_unstable();
        assert!(streams.is_sorted_by(|a, b| a < b));
    }

    #[test]
    fn every_input_is_driven_and_every_column_is_an_input_or_read_by_glue() {
        for spec in BLOCKS {
            let vectors = vectors(spec, 1, Some(1));
            let columns: Vec<_> = vectors.stimulus.columns().iter().map(|c| &c.name).collect();
            let inputs: Vec<_> =
                spec.ports(&vectors.sizes).into_iter().filter(|port| !port.output).collect();
            for name in &columns {
                let is_read = spec
                    .glue
                    .is_some_and(|glue| glue.verilog(&Sizes::default()).contains(name.as_str()));
                let is_late =
                    |step: &BenchStep| step.late.is_some_and(|(_, column)| column == name.as_str());
                let is_read = is_read || spec.timing.steps.iter().any(is_late);
                let is_input = inputs.iter().any(|port| port.name == **name);
                assert!(is_input || is_read, "{}: {name}", spec.name);
            }
            for port in inputs.iter().filter(|port| !port.name.starts_with("clk")) {
                let is_glued = spec.is_glued(&port.name);
                let is_driven = columns.contains(&&port.name) || port.name == "tdc_stop";
                assert!(is_driven || is_glued, "{}: {}", spec.name, port.name);
            }
        }
    }
}
