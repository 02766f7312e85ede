//! The blocks, one file each: what is special about it and how its input is drawn.

use super::block::Spec;

mod carry_chain;
mod coarse_counter;
mod tof_top;
mod vcsel_driver;

/// Every block, in the order of their names.
pub static BLOCKS: &[Spec] =
    &[carry_chain::SPEC, coarse_counter::SPEC, tof_top::SPEC, vcsel_driver::SPEC];

/// The block called `name`.
pub fn find(name: &str) -> Option<&'static Spec> {
    BLOCKS.iter().find(|spec| spec.name == name)
}
