//! A setup, with all derived information about its frames.

use std::sync::Arc;

use serde::Serialize;

use tofsim::Note;
use tofsim::error::Result;
use tofsim::firmware::tof_top::status::Status;
use tofsim::optics::Hazard;
use tofsim::optics::cause_parts::cause_parts;
use tofsim::optics::hazard::BY_CAUSE;
use tofsim::sim::disagreements::Disagreements;
use tofsim::sim::frames::Frame;
use tofsim::sim::second_opinion::SecondOpinion;
use tofsim::sim::setup::Setup;
use tofsim_learn::error_budget::Bound;
use tofsim_learn::estimation::{Estimate, EstimatorKind, Panel};

/// Estimators shown in addition to the one in the estimator slot.
const PANEL: [EstimatorKind; 3] =
    [EstimatorKind::Network, EstimatorKind::Centroid, EstimatorKind::Likelihood];

/// A setup, with all derived information about its frames.
pub struct Instrument {
    /// Simulated setup.
    pub setup: Arc<Setup>,
    panel: Vec<(&'static str, std::result::Result<Panel, String>)>,
    second: Option<SecondOpinion>,
    /// Twice the smallest standard deviation of an unbiased depth [mm].
    pub bound_two_sd_mm: Option<f64>,
    /// Notes on the setup's results.
    pub notes: Vec<Note>,
    /// For each code, the fractions of signal, ambient light and dark counts, without and with laser [1].
    parts: [Vec<[f64; BY_CAUSE.len()]>; 2],
}

/// Estimate of a frame's depth.
#[derive(Clone, Debug, Serialize)]
pub struct Depth {
    /// The estimate.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Whether this is the firmware's estimator.
    pub in_socket: bool,
}

impl Instrument {
    /// Derives the information for a setup.
    ///
    /// # Errors
    /// If the network file's domain is invalid, or the acquisition is inconsistent.
    pub fn new(setup: Arc<Setup>) -> Result<Self> {
        let panel = PANEL.map(|kind| {
            let panel = Panel::new(&[kind], &setup).map_err(|error| error.to_string());
            (kind.name(), panel)
        });
        let mut notes = setup.notes()?;
        let has_depth = setup.no_depth().is_none();
        if has_depth {
            notes.extend(PANEL.iter().flat_map(|kind| kind.notes(&setup)));
        }
        let second = SecondOpinion::new(&setup);
        let second = match second {
            Ok(second) => Some(second),
            Err(why) => {
                if !notes.contains(&why) {
                    notes.push(why);
                }
                None
            }
        };
        let bound_two_sd_mm = if has_depth { Bound::of(&setup)?.two_sd_mm } else { None };
        let bins = setup.bins();
        let hazards = [Hazard::dark(&setup.budget), Hazard::new(&setup.budget)];
        let parts = hazards.map(|hazard| cause_parts(&hazard, &bins));
        Ok(Instrument { panel: panel.into(), second, bound_two_sd_mm, notes, parts, setup })
    }

    /// Returns each estimator's estimate of a frame; that of the estimator slot is the firmware's.
    pub fn depths(&self, frame: &Frame) -> Vec<Depth> {
        let own = Depth { estimate: frame.estimate(), in_socket: true };
        let others = self.panel.iter().filter(|(name, _)| *name != own.estimate.estimator);
        let others = others.map(|(name, panel)| {
            let read = |panel: &Panel| panel.read(&frame.histogram).pop();
            let refused = |why: &String| Estimate {
                status: Status::OutsideModel.into(),
                failure: Some(why.clone()),
                ..Estimate::of_depth(name, None)
            };
            let estimate = panel.as_ref().map_or_else(|why| Some(refused(why)), read);
            let estimate = estimate.unwrap_or_else(|| Estimate::of_depth(name, None));
            Depth { estimate, in_socket: false }
        });
        let mut depths: Vec<_> = others.chain([own.clone()]).collect();
        let place =
            |depth: &Depth| PANEL.iter().position(|kind| kind.name() == depth.estimate.estimator);
        depths.sort_by_key(|depth| place(depth).unwrap_or(PANEL.len()));
        depths
    }

    /// Returns notes on a frame's depth in addition to [`Instrument::notes`].
    pub fn notes_of(&self, frame: &Frame) -> Vec<Note> {
        let Some((second, opinion)) =
            self.second.as_ref().and_then(|second| Some((second, second.of(frame)?)))
        else {
            return Vec::new();
        };
        if self.setup.no_depth().is_some() {
            return Vec::new();
        }
        let mut disagreements = Disagreements::default();
        disagreements.add(second, frame, &opinion);
        disagreements.notes(second)
    }

    /// Splits a histogram into its expected parts of each of [`BY_CAUSE`] [hits].
    pub fn expected_causes(&self, frame: &Frame) -> [Vec<f64>; BY_CAUSE.len()] {
        let parts = &self.parts[usize::from(frame.laser_en)];
        let of = |cause: usize| {
            let each = frame.histogram.iter().zip(parts);
            each.map(move |(&count, parts)| (f64::from(count) * parts[cause] * 10.0).round() / 10.0)
        };
        std::array::from_fn(|cause| of(cause).collect())
    }
}
