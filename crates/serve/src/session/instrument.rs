//! A setup, and all that is said of its frames.

use std::sync::Arc;

use serde::Serialize;

use tofsim::Note;
use tofsim::error::Result;
use tofsim::optics::Hazard;
use tofsim::optics::cause_parts::cause_parts;
use tofsim::sim::frames::Frame;
use tofsim::sim::partings::Partings;
use tofsim::sim::second_opinion::SecondOpinion;
use tofsim::sim::setup::Setup;
use tofsim_learn::error_budget::Bound;
use tofsim_learn::estimation::{EstimatorKind, Panel};

/// Who says how far it is, beside the estimator in the socket.
const PANEL: [EstimatorKind; 3] =
    [EstimatorKind::Network, EstimatorKind::Centroid, EstimatorKind::Likelihood];

/// A setup, and all that is said of its frames.
pub struct Instrument {
    /// What is simulated.
    pub setup: Arc<Setup>,
    panel: Vec<(&'static str, std::result::Result<Panel, String>)>,
    second: Option<SecondOpinion>,
    /// Twice the least standard deviation that an unbiased depth can have [mm].
    pub bound_two_sd_mm: Option<f64>,
    /// What results lie outside of.
    pub notes: Vec<Note>,
    /// Of each code the parts of signal, ambient light and no light, in the dark and with the laser [1].
    parts: [Vec<[f64; 3]>; 2],
}

/// What an estimator says of a frame.
#[derive(Clone, Debug, Serialize)]
pub struct Depth {
    /// Its name.
    pub estimator: &'static str,
    /// Whether it is the one in the firmware.
    pub in_socket: bool,
    /// Distance of the target [m].
    pub depth_m: Option<f64>,
    /// Why there is none.
    pub failure: Option<String>,
}

impl Instrument {
    /// For frames of a setup.
    ///
    /// # Errors
    /// When the network's file has a domain that is none, or the acquisition makes no sense.
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

    /// What each estimator says of a frame; the one in the socket says what the firmware has said.
    pub fn depths(&self, frame: &Frame) -> Vec<Depth> {
        let socket = EstimatorKind::in_socket(&self.setup.scenario).name();
        let own = Depth {
            estimator: socket,
            in_socket: true,
            depth_m: Some(frame.depth_m()),
            failure: None,
        };
        let others = self.panel.iter().filter(|(name, _)| *name != socket);
        let others = others.map(|(name, panel)| {
            let reading = panel.as_ref().map_err(String::clone).and_then(|panel| {
                let reading = panel.read(&frame.histogram).pop();
                let reading = reading.ok_or_else(|| "no reading".to_owned())?;
                reading.depth_m.ok_or_else(|| reading.failure.unwrap_or_default())
            });
            Depth {
                estimator: name,
                in_socket: false,
                depth_m: reading.as_ref().ok().copied(),
                failure: reading.err(),
            }
        });
        let mut depths: Vec<_> = std::iter::once(own).chain(others).collect();
        let place = |depth: &Depth| PANEL.iter().position(|kind| kind.name() == depth.estimator);
        depths.sort_by_key(|depth| place(depth).unwrap_or(PANEL.len()));
        depths
    }

    /// What a frame's depth lies outside of beside [`Instrument::notes`].
    pub fn notes_of(&self, frame: &Frame) -> Vec<Note> {
        let Some((second, opinion)) =
            self.second.as_ref().and_then(|second| Some((second, second.of(frame)?)))
        else {
            return Vec::new();
        };
        if self.setup.no_depth().is_some() {
            return Vec::new();
        }
        let mut partings = Partings::default();
        partings.add(second, frame, &opinion);
        partings.notes(second)
    }

    /// A histogram by what is to be expected: signal, ambient light, dark [hits].
    pub fn expected_causes(&self, frame: &Frame) -> [Vec<f64>; 3] {
        let parts = &self.parts[usize::from(frame.laser_en)];
        let of = |cause: usize| {
            let each = frame.histogram.iter().zip(parts);
            each.map(move |(&count, parts)| (f64::from(count) * parts[cause] * 10.0).round() / 10.0)
        };
        [0, 1, 2].map(|cause| of(cause).collect())
    }
}
