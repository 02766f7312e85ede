//! Disagreements between the depths of the estimator slot and second opinions, over the frames of a run.

use crate::note::{Note, NoteCode};

use super::estimates::Estimate;
use super::frames::Frame;
use super::second_opinion::{ESTIMATOR, SecondOpinion};

/// Counts of disagreements, and the most significant ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Disagreements {
    /// Frames with a second opinion.
    pub frames: u64,
    /// Frames whose depth differs from a valid second opinion by more than the tolerance.
    pub disagreeing: u64,
    /// Frames whose second opinion is invalid.
    pub rejected: u64,
    /// Name of the numbered items, if they are not the frames of a run.
    things: Option<&'static str>,
    largest: Option<Disagreement>,
    first_rejected: Option<(u64, String)>,
}

/// Two different depths of one frame.
#[derive(Clone, Debug, PartialEq)]
struct Disagreement {
    frame: u64,
    own_m: f64,
    other_m: f64,
    allowed_m: f64,
}

impl Disagreement {
    fn difference_m(&self) -> f64 {
        (self.own_m - self.other_m).abs()
    }
}

impl Disagreements {
    /// Creates counts for histograms that are not frames of a run.
    pub fn of_histograms() -> Self {
        Disagreements { things: Some("histogram"), ..Disagreements::default() }
    }

    /// Adds the next frame and its second opinion.
    pub fn add(&mut self, second: &SecondOpinion, frame: &Frame, opinion: &Estimate) {
        self.add_depth(second, (frame.index, frame.depth_m()), opinion);
    }

    /// Adds the number and depth of the next histogram, and its second opinion.
    pub fn add_depth(
        &mut self,
        second: &SecondOpinion,
        (frame, own_m): (u64, f64),
        opinion: &Estimate,
    ) {
        self.frames += 1;
        let Some(other_m) = opinion.depth_m.filter(|_| opinion.valid) else {
            self.rejected += 1;
            self.first_rejected.get_or_insert_with(|| (frame, opinion.status.to_string()));
            return;
        };
        let found = Disagreement { frame, own_m, other_m, allowed_m: second.allowed_m(opinion) };
        if found.difference_m() <= found.allowed_m {
            return;
        }
        self.disagreeing += 1;
        if self.largest.as_ref().is_none_or(|most| most.difference_m() < found.difference_m()) {
            self.largest = Some(found);
        }
    }

    /// Returns the notes on disagreements and rejected frames.
    pub fn notes(&self, second: &SecondOpinion) -> Vec<Note> {
        let note = |expected: String, text: String| {
            let (key, kind) = ("estimator.kind", second.socket());
            Note::new(NoteCode::SecondOpinion, key, kind, expected, text)
        };
        let disagreement = self.largest.as_ref().map(|most| {
            let text = format!(
                "it disagrees with {ESTIMATOR} in {}: {:.4} m against {:.4} m, a difference of {:.1} mm",
                self.which(self.disagreeing, most.frame, "most in"),
                most.own_m,
                most.other_m,
                1e3 * most.difference_m()
            );
            note(format!("{:.1} mm at most", 1e3 * most.allowed_m), text)
        });
        let rejection = self.first_rejected.as_ref().map(|(frame, why)| {
            let which = self.which(self.rejected, *frame, "first:");
            let text = format!("{ESTIMATOR} rejects {which}: {why}");
            note("a single, distinct echo".to_owned(), text)
        });
        disagreement.into_iter().chain(rejection).collect()
    }

    /// Returns a text such as `3 of 20 frames (most in frame 7)`.
    fn which(&self, count: u64, shown: u64, how: &str) -> String {
        let one = self.things.unwrap_or("frame");
        match count {
            1 => format!("{one} {shown}"),
            _ => format!("{count} of {} {one}s ({how} {one} {shown})", self.frames),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::tof_top::status::Status;
    use crate::sim::setup::Setup;
    use crate::sim::{Run, Stepping};

    /// Opinions on so many frames, and the notes on all of them.
    fn seen(count: u64, set: &[&str]) -> (Vec<Option<Estimate>>, Vec<Note>) {
        let setup = Setup::load("kc705", set).unwrap();
        let second = SecondOpinion::new(&setup).unwrap();
        let frames = Run::new(&setup).stepping(Stepping::LeapShots).frames(count).unwrap();
        let opinions: Vec<_> = frames.iter().map(|frame| second.of(frame)).collect();
        let mut disagreements = Disagreements::default();
        for (frame, opinion) in frames.iter().zip(&opinions) {
            opinion.iter().for_each(|opinion| disagreements.add(&second, frame, opinion));
        }
        (opinions, disagreements.notes(&second))
    }

    fn text(notes: &[Note]) -> String {
        notes.iter().map(|note| format!("{note}\n")).collect()
    }

    #[test]
    fn within_its_training_the_network_agrees_with_it() {
        let (opinions, notes) = seen(3, &[]);
        assert!(notes.is_empty(), "{}", text(&notes));
        for opinion in opinions {
            let opinion = opinion.unwrap();
            let (depth_m, sigma_m) = (opinion.depth_m.unwrap(), opinion.sigma_m.unwrap());
            assert!((depth_m - 0.5).abs() < 6.0 * sigma_m, "{opinion:?}");
            assert!((1e-4..1e-3).contains(&sigma_m) && opinion.valid && opinion.status.is_empty());
        }
    }

    #[test]
    fn a_network_out_of_its_depth_is_seen_to_be() {
        let (opinions, notes) = seen(1, &["target.distance_m=0.8"]);
        assert!((opinions[0].as_ref().unwrap().depth_m.unwrap() - 0.8).abs() < 0.01);
        let said = text(&notes);
        assert!(
            said.starts_with(
                "note: estimator.kind = network: it disagrees with likelihood_estimator in "
            ),
            "{said}"
        );
        assert!(said.contains(" in frame 0: ") && said.contains(" m against 0."), "{said}");
        assert!(said.contains("mm at most) [second-opinion]") && notes.len() == 1, "{said}");
        let (_, notes) = seen(3, &["target.distance_m=0.8"]);
        assert!(text(&notes).contains(" in 3 of 3 frames (most in frame "), "{}", text(&notes));
    }

    #[test]
    fn frames_that_the_estimator_rejects_do_not_disagree() {
        let (opinions, notes) = seen(2, &["firmware.laser_en=false"]);
        let opinion = opinions[1].as_ref().unwrap();
        assert!(opinion.status.contains(Status::NoEcho) && !opinion.valid);
        let said = text(&notes);
        let expected = "likelihood_estimator rejects 2 of 2 frames (first: frame 0): no echo";
        assert!(said.contains(expected) && notes.len() == 1, "{said}");
    }
}
