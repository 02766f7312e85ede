//! The rows of the histograms as they are read.

use tofsim::error::Result;
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::network::estimate;
use tofsim::sim::disagreements::Disagreements;
use tofsim::sim::second_opinion::SecondOpinion;
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode};
use tofsim_learn::estimation::notes::PedestalWatch;
use tofsim_learn::estimation::{Estimate, EstimatorKind, Panel};
use tofsim_learn::quantize::{LikelihoodExplainer, explain};

use crate::report::estimates::{Numbers, Row};

/// Estimates of the histograms so far.
pub(super) struct Reading<'a> {
    setup: &'a Setup,
    /// Whether the network is in the firmware.
    pub(super) is_network: bool,
    panel: Panel,
    second: Option<SecondOpinion>,
    disagreements: Disagreements,
    explains_network: bool,
    likelihood: Option<LikelihoodExplainer>,
    /// The first histogram with more hits than shots, and its hits.
    crowded: Option<(usize, u64)>,
    pub(super) rows: Vec<Row<'a>>,
}

impl<'a> Reading<'a> {
    /// Begins without histograms; the last argument says whether the network and whether the likelihood estimator are
    /// to be explained.
    pub(super) fn new(
        setup: &'a Setup,
        estimators: &[EstimatorKind],
        second: Option<SecondOpinion>,
        (explains_network, explains_likelihood): (bool, bool),
    ) -> Result<Self> {
        let likelihood = explains_likelihood.then(|| LikelihoodExplainer::new(setup));
        Ok(Reading {
            setup,
            is_network: setup.params.estimator == FirmwareEstimator::Network,
            panel: Panel::new(estimators, setup)?,
            second,
            disagreements: Disagreements::of_histograms(),
            explains_network,
            likelihood: likelihood.transpose()?,
            crowded: None,
            rows: Vec::new(),
        })
    }

    /// Adds the row of the next histogram.
    pub(super) fn take(&mut self, file: &'a str, histogram: &[u32]) {
        let (setup, index) = (self.setup, self.rows.len());
        let hits: u64 = histogram.iter().map(|&count| u64::from(count)).sum();
        self.crowded = self.crowded.or((hits > setup.shots(1)).then_some((index, hits)));
        let words = setup.estimate_words(histogram);
        let second_opinion = self.second.as_ref().map(|second| {
            let opinion = second.of_histogram(histogram);
            let own_m = words.depth_m().to_num();
            self.disagreements.add_depth(second, (index as u64, own_m), &opinion);
            opinion
        });
        let params = &setup.params.estimators.depth_estimator;
        let l1_in = self.is_network.then(|| {
            let sums = estimate(params, histogram).l1_in;
            sums[..params.neurons()].iter().map(|sum| sum.get()).collect()
        });
        let explainer = self.likelihood.as_ref();
        self.rows.push(Row {
            index,
            file,
            numbers: Numbers {
                estimate: Estimate::of_words(setup.params.estimator, &words),
                l1_in,
            },
            second_opinion,
            estimates: self.panel.read(histogram),
            explanation: self.explains_network.then(|| explain(&setup.network, histogram)),
            likelihood_explanation: explainer.map(|explainer| explainer.explain(histogram)),
        });
    }

    /// Returns the notes on the histograms and their depths.
    pub(super) fn notes(&self) -> Vec<Note> {
        let disagreements = self.second.as_ref().map(|second| self.disagreements.notes(second));
        let mut notes = disagreements.unwrap_or_default();
        notes.extend(self.crowded.map(|(index, hits)| {
            let text = format!("histogram {index} has {hits} hits, more than its shots");
            let (shots, expected) = (self.setup.shots(1) as f64, format!("{hits} or more"));
            let (code, key) = (NoteCode::EstimatorOutsideModel, "firmware.shots_per_frame");
            Note::new(code, key, shots, expected, text)
        }));
        let mut pedestals = PedestalWatch::default();
        self.rows.iter().for_each(|row| pedestals.add(&row.estimates));
        notes.extend(self.setup.glass.as_ref().and_then(|glass| pedestals.note(glass)));
        notes
    }
}
