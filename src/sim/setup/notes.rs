//! What the results of a setup lie outside of.

use crate::firmware::tof_top::Estimator;
use crate::note::{Note, NoteCode};

use super::Setup;

impl Setup {
    /// What the depths of a run lie outside of: what the network was trained for, and what the
    /// scenario makes impossible.
    pub fn notes(&self) -> Vec<Note> {
        let (trained, chain) = (&self.network.training.chain, &self.scenario.tdc.profile);
        let is_used = self.params.estimator == Estimator::Network;
        let differ = is_used && trained != chain && self.true_depth_m().is_some();
        let text = "the network was not trained for it";
        let note =
            || Note::new(NoteCode::OutsideTraining, "tdc.profile", &**chain, trained.clone(), text);
        differ.then(note).into_iter().collect()
    }
}
