//! The detector of a setup: light, diodes, and what makes pulses of their outputs.

use std::sync::Arc;

use crate::kernel::Time;
use crate::optics::dark::DarkRates;
use crate::optics::{Budget, Hazard};
use crate::scenario::wiring::Wiring;
use crate::scenario::{DeadTimeKind, Scenario, Spad};
use crate::sensor::front_end::FrontEnd;
use crate::sensor::light::{Light, Optics};
use crate::sensor::ring::Ring;
use crate::sensor::row::Effects;
use crate::sensor::row_light::RowLight;
use crate::sensor::shaper::{self, Shaper};
use crate::sensor::spad::Spads;
use crate::sensor::streams::Seeds;

use super::recalibration;

/// A row of SPADs that is simulated, where those on the TDC are not all of it.
#[derive(Clone, Debug)]
pub(super) struct SimulatedRow {
    /// Light on all of its SPADs.
    pub light: Arc<Light>,
    /// Which of them are on the TDC.
    pub wiring: Wiring,
}

/// The diodes of the row that are simulated, at power-up. What they do besides firing is one for all pixels of an
/// array's row, if they are simulated together.
pub(super) fn spads(
    spad: &Spad,
    dark: &DarkRates,
    row: Option<&SimulatedRow>,
    seeds: Seeds,
) -> Spads {
    let dead_time = Time::from_ps_f64(spad.dead_time_ns * 1e3);
    let (wiring, seed) = match row {
        Some(row) => (row.wiring.clone(), seeds.row),
        None => (Wiring::of(spad), seeds.pixel),
    };
    let is_row = row.is_some() || spad.row_outputs > 0;
    let on_tdc = is_row.then(|| wiring.places());
    let effects = Effects { on_tdc, ..effects(spad, dark) };
    Spads::new(wiring.simulated.len(), dead_time, Time::NEVER).with_effects(effects, seed)
}

/// Returns the parameters of the shaper of pulses on `tdc_stop`, if there is one.
pub(super) fn shaper(spad: &Spad) -> Option<shaper::Params> {
    // However short, it is none of no length.
    let span = |ns: f64| Time::from_ps_f64(ns * 1e3).max(Time::from_fs(1));
    let width = (spad.pulse_ns > 0.0).then(|| span(spad.pulse_ns));
    let gap = (spad.pulse_gap_ns > 0.0).then(|| span(spad.pulse_gap_ns));
    let is_there = width.is_some() || gap.is_some();
    is_there.then(|| shaper::Params { width, gap: gap.unwrap_or(Time::ZERO) })
}

/// Returns the driver of `tdc_stop` at power-up, with a ring if the firmware calibrates itself.
pub(super) fn front_end(scenario: &Scenario, calibrates: bool, seed: u64) -> FrontEnd {
    let ring = calibrates.then(|| recalibration::ring(&scenario.tdc));
    FrontEnd::new(Ring::new(ring, seed), shaper(&scenario.spad).map(Shaper::new))
}

/// Returns the light of the link budget.
pub(super) fn by_budget(budget: &Budget, seeds: impl Into<Seeds>) -> Light {
    Light::Optics(Box::new(optics(budget, seeds)))
}

/// Returns the light of the link budget of each SPAD of a row.
pub(super) fn by_budgets(spads: impl Iterator<Item = (Budget, Seeds)>) -> Light {
    let spads = spads.map(|(budget, seeds)| optics(&budget, seeds));
    Light::Row(Box::new(RowLight::new(spads.collect())))
}

fn optics(budget: &Budget, seeds: impl Into<Seeds>) -> Optics {
    Optics::new(Hazard::new(budget), Hazard::dark(budget), seeds)
}

/// Returns what a scenario's diodes do besides firing, all of them on the TDC.
pub(crate) fn effects(spad: &Spad, dark: &DarkRates) -> Effects {
    Effects {
        trap_probability: spad.afterpulse_probability,
        afterpulse_fs: spad.afterpulse_ns * 1e6,
        afterpulse_second_fs: spad.afterpulse_second_ns * 1e6,
        afterpulse_second_share: spad.afterpulse_second_share,
        paralysable: spad.dead_time_kind == DeadTimeKind::Paralysable,
        crosstalk_probability: spad.crosstalk_probability,
        dark_rates: dark.parts().to_vec(),
        on_tdc: None,
    }
}
