//! Calibration of a cover window's light from histograms without a target.
//!
//! Of the shots that still wait at a bin, the part that ends there gives the bin's hazard, whatever came before: pile-up
//! is corrected bin by bin, as [`crate::estimation::coates`] does it for an echo. All histograms are added up. Ambient
//! light is a constant rate, fitted in the bins outside of the pedestal ([`pedestal`]); a target is looked for, and
//! refused ([`target`]).

mod cells;
mod pedestal;
mod target;

use std::ops::Range;

use tofsim::error::{Input, Result};
use tofsim::network::Histogram;
use tofsim::scenario::glass::{GlassBin, GlassTemplate};

use crate::estimation::acquisition::Acquisition;

use cells::{Cells, SOURCE};
use pedestal::Ambient;

/// Shots of all histograms that still wait after the pedestal: fewer tell nothing of ambient light [shots].
const FEWEST_WAITING: f64 = 100.0;

/// Result of a calibration.
#[derive(Clone, Debug)]
pub struct GlassCalibration {
    /// The template.
    pub template: GlassTemplate,
    /// Hazard without ambient light in every bin, in order of time, and its standard error [bin with 1].
    pub measured: Vec<GlassBin>,
    /// Histograms.
    pub histograms: usize,
    /// Hits in all bins of all histograms [hits].
    pub hits: u64,
    /// Detected photons of the window's light per shot, and their standard error [1].
    pub photons: [f64; 2],
    /// Mean delay from the laser edge, and standard deviation of the delay [ps].
    pub delay_ps: [f64; 2],
    /// Begin and end of the pedestal [ps].
    pub support_ps: [f64; 2],
    /// Rate of ambient light and dark counts, and its standard error [1/ps].
    pub ambient_per_ps: [f64; 2],
    /// Relative change of the window's light from the first histogram to the last, by a straight line, and its standard
    /// error; `None` for one histogram [1].
    pub change: Option<[f64; 2]>,
}

impl GlassCalibration {
    /// Calibrates from histograms without a target; `name` gives the file of a histogram and its number there.
    ///
    /// # Errors
    /// When there is no pedestal, a target or a change of the pedestal, no shot is left for ambient light, the diode is
    /// not armed for each shot (MODE 1), or [`Acquisition::check`] fails.
    pub fn new(
        acquisition: &Acquisition,
        histograms: &[Histogram],
        name: impl Fn(usize) -> (String, usize),
    ) -> Result<Self> {
        acquisition.check()?;
        if acquisition.free_running.is_some() {
            let expected =
                "expected 0: in MODE 1 it depends on the shots before which of them can have a hit";
            return Err(Input::new(SOURCE, expected).field("firmware.mode").value(1).into());
        }
        if histograms.is_empty() {
            return Err(Input::new(SOURCE, "expected a histogram at least").into());
        }
        let cells = Cells::new(acquisition, histograms);
        if let Some(used_up) =
            (0..cells.hits.len()).find(|&bin| cells.waiting[bin] - cells.hits[bin] < FEWEST_WAITING)
        {
            let expected = format!(
                "expected {FEWEST_WAITING} shots or more that are still waiting then: pile-up hides the rest; \
                 take more histograms, or dim the laser"
            );
            let at = format!("{} ps", cells.limits[used_up].1[0]);
            return Err(Input::new(SOURCE, expected).field("shots used up at").value(at).into());
        }
        let ambient = Ambient::fit(&cells);
        let support = pedestal::support(acquisition, &cells, &ambient)?;
        target::check(acquisition, &cells, &ambient, &support, histograms, &name)?;
        let change = target::change(acquisition, &cells, &ambient, &support, histograms);
        GlassCalibration::of(&cells, &ambient, &support, histograms.len(), change)
    }

    fn of(
        cells: &Cells,
        ambient: &Ambient,
        support: &Range<usize>,
        histograms: usize,
        change: Option<[f64; 2]>,
    ) -> Result<Self> {
        let bin = |bin: usize| {
            let ([hazard, variance], width_ps) = (cells.hazard(bin), cells.widths_ps[bin]);
            let hazard_se = variance.sqrt().hypot(width_ps * ambient.rate_se);
            let [from_ps, until_ps] = cells.limits[bin].1;
            GlassBin { from_ps, until_ps, hazard: hazard - width_ps * ambient.rate, hazard_se }
        };
        let measured: Vec<_> = (0..cells.hits.len()).map(bin).collect();
        let codes = cells.limits.iter().map(|(code, _)| code + 1).max().unwrap_or(0);
        let mut template = vec![GlassBin::default(); codes];
        for (bin, (code, [from_ps, until_ps])) in cells.limits.iter().enumerate() {
            let (from_ps, until_ps) = (*from_ps, *until_ps);
            template[*code] = if support.contains(&bin) {
                GlassBin { hazard: measured[bin].hazard.max(0.0), ..measured[bin] }
            } else {
                GlassBin { from_ps, until_ps, ..GlassBin::default() }
            };
        }
        let inside = &measured[support.clone()];
        let photons: f64 = inside.iter().map(|bin| bin.hazard).sum();
        let counted: f64 = support.clone().map(|bin| cells.hazard(bin)[1]).sum();
        let all_ps: f64 = cells.widths_ps[support.clone()].iter().sum();
        let photons_se = counted.sqrt().hypot(all_ps * ambient.rate_se);
        let moment = |of: &dyn Fn(&GlassBin) -> f64| {
            inside.iter().map(|bin| bin.hazard * of(bin)).sum::<f64>() / photons
        };
        let mean_ps = moment(&GlassBin::middle_ps);
        let variance = moment(&|bin| (bin.middle_ps() - mean_ps).powi(2));
        Ok(GlassCalibration {
            template: GlassTemplate::new(SOURCE, template)?,
            histograms,
            hits: cells.hits.iter().sum::<f64>() as u64,
            photons: [photons, photons_se],
            delay_ps: [mean_ps, variance.max(0.0).sqrt()],
            support_ps: [inside[0].from_ps, inside[inside.len() - 1].until_ps],
            ambient_per_ps: [ambient.rate, ambient.rate_se],
            change,
            measured,
        })
    }

    /// Returns the standard error of the amplitude that a frame's is compared with [1].
    pub fn relative_se(&self) -> f64 {
        self.photons[1] / self.photons[0]
    }
}
