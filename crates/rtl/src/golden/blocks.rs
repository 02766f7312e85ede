//! The blocks, one file each: what is special about it and how its input is drawn.

use super::block::Spec;

mod carry_chain;
pub(super) mod centroid_estimator;
mod coarse_counter;
mod code_preload;
mod control_sync;
mod ddr_output;
mod depth_estimator;
mod estimator_ctrl;
mod forward1;
mod forward2;
mod frame_ctrl;
mod histogram_builder;
mod histogram_preload;
mod lvds_output;
mod pll;
mod reset_sync;
mod spad_control;
mod tansig;
mod tdc;
mod tdc_decoder;
mod tdc_latch;
mod tof_top;
mod vcsel_driver;

/// Every block, in the order of their names.
pub static BLOCKS: &[Spec] = &[
    carry_chain::SPEC,
    centroid_estimator::SPEC,
    coarse_counter::SPEC,
    code_preload::SPEC,
    control_sync::SPEC,
    ddr_output::SPEC,
    depth_estimator::SPEC,
    estimator_ctrl::SPEC,
    forward1::SPEC,
    forward2::SPEC,
    frame_ctrl::SPEC,
    histogram_builder::SPEC,
    histogram_preload::SPEC,
    lvds_output::SPEC,
    pll::SPEC,
    reset_sync::SPEC,
    spad_control::SPEC,
    tansig::SPEC,
    tdc::SPEC,
    tdc_decoder::SPEC,
    tdc_latch::SPEC,
    tof_top::SPEC,
    vcsel_driver::SPEC,
];

/// Blocks whose draws come after all others', whatever their names: each that is added goes to the end,
/// so that the stimuli of those before it stay as they are.
const LATER: &[&str] = &["centroid_estimator"];

/// The place of a block's draws.
pub(super) fn place(name: &str) -> u64 {
    let is_later = |spec: &&Spec| LATER.contains(&spec.name);
    let first = BLOCKS.iter().filter(|spec| !is_later(spec)).map(|spec| spec.name);
    let mut names = first.chain(LATER.iter().copied());
    names.position(|other| other == name).unwrap_or_default() as u64
}

/// The block called `name`.
pub fn find(name: &str) -> Option<&'static Spec> {
    BLOCKS.iter().find(|spec| spec.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::golden::timing::Step;
    use crate::golden::{Setting, Vectors};
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    fn vectors(spec: &'static Spec, seed: u64, cycles: Option<usize>) -> Vectors {
        let setup = Setup::new(scenario::load(scenario::DEFAULT, &[]).unwrap()).unwrap();
        let setting = Setting { seed, cycles, ..Setting::new(setup) };
        (spec.record)(spec, &setting).unwrap()
    }

    #[test]
    fn every_stimulus_covers_its_goals() {
        let mut gaps = Vec::new();
        for (spec, seed) in BLOCKS.iter().flat_map(|spec| [(spec, 1), (spec, 20_221_121)]) {
            let coverage = vectors(spec, seed, None).coverage;
            assert!(!coverage.is_empty(), "{}", spec.name);
            for cover in coverage.iter().filter(|cover| cover.met() < cover.cases()) {
                let missing: Vec<_> = cover.missing().collect();
                gaps.push(format!("{}, seed {seed}: {}: {missing:?}", spec.name, cover.what));
            }
        }
        assert!(gaps.is_empty(), "not covered:\n{}", gaps.join("\n"));
    }

    #[test]
    fn blocks_are_in_the_order_of_their_names() {
        assert!(BLOCKS.is_sorted_by_key(|spec| spec.name));
    }

    #[test]
    fn each_block_has_draws_of_its_own_and_a_later_one_moves_no_others() {
        let mut places: Vec<_> = BLOCKS.iter().map(|spec| place(spec.name)).collect();
        assert_eq!(
            (place("carry_chain"), place("coarse_counter"), place("vcsel_driver")),
            (0, 1, 21)
        );
        places.sort_unstable();
        assert!(places.into_iter().eq(0..BLOCKS.len() as u64));
    }

    #[test]
    fn every_input_is_driven_and_every_column_is_an_input_or_read_by_glue() {
        for spec in BLOCKS {
            let vectors = vectors(spec, 1, Some(1));
            let columns: Vec<_> = vectors.stimulus.columns().iter().map(|c| &c.name).collect();
            let inputs: Vec<_> =
                spec.ports(vectors.neurons).into_iter().filter(|port| !port.output).collect();
            for name in &columns {
                let is_read = spec.glue.is_some_and(|glue| glue.verilog.contains(name.as_str()));
                let is_late =
                    |step: &Step| step.late.is_some_and(|(_, column)| column == name.as_str());
                let is_read = is_read || spec.timing.steps.iter().any(is_late);
                let is_input = inputs.iter().any(|port| port.name == **name);
                assert!(is_input || is_read, "{}: {name}", spec.name);
            }
            for port in inputs.iter().filter(|port| !port.name.starts_with("clk")) {
                let is_glued = spec.glue.is_some_and(|glue| glue.drives == port.name);
                let is_driven = columns.contains(&&port.name) || port.name == "tdc_stop";
                assert!(is_driven || is_glued, "{}: {}", spec.name, port.name);
            }
        }
    }
}
