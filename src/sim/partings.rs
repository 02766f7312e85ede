//! Where the depths of the socket and second opinions part, over the frames of a run.

use crate::note::{Note, NoteCode};

use super::estimates::Estimate;
use super::frames::Frame;
use super::second_opinion::{ESTIMATOR, SecondOpinion};

/// What has been seen of some frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Partings {
    /// Frames of which there is an opinion.
    pub frames: u64,
    /// Frames whose depth is further from a believed opinion than allowed.
    pub parted: u64,
    /// Frames of which no depth is to be believed.
    pub unbelieved: u64,
    /// Name of what is numbered, if it is no frame of a run.
    things: Option<&'static str>,
    furthest: Option<Parting>,
    first_unbelieved: Option<(u64, String)>,
}

/// Two depths of one frame.
#[derive(Clone, Debug, PartialEq)]
struct Parting {
    frame: u64,
    own_m: f64,
    other_m: f64,
    allowed_m: f64,
}

impl Parting {
    fn apart_m(&self) -> f64 {
        (self.own_m - self.other_m).abs()
    }
}

impl Partings {
    /// Of histograms that are no frames of a run.
    pub fn of_histograms() -> Self {
        Partings { things: Some("histogram"), ..Partings::default() }
    }

    /// Takes the next frame, and what `second` said of it.
    pub fn add(&mut self, second: &SecondOpinion, frame: &Frame, opinion: &Estimate) {
        self.add_depth(second, (frame.index, frame.depth_m()), opinion);
    }

    /// Takes the depth of the next histogram with its number, and what `second` said of it.
    pub fn add_depth(
        &mut self,
        second: &SecondOpinion,
        (frame, own_m): (u64, f64),
        opinion: &Estimate,
    ) {
        self.frames += 1;
        let Some(other_m) = opinion.depth_m.filter(|_| opinion.valid) else {
            self.unbelieved += 1;
            self.first_unbelieved.get_or_insert_with(|| (frame, opinion.status.to_string()));
            return;
        };
        let parting = Parting { frame, own_m, other_m, allowed_m: second.allowed_m(opinion) };
        if parting.apart_m() <= parting.allowed_m {
            return;
        }
        self.parted += 1;
        if self.furthest.as_ref().is_none_or(|most| most.apart_m() < parting.apart_m()) {
            self.furthest = Some(parting);
        }
    }

    /// What a user has to know of it.
    pub fn notes(&self, second: &SecondOpinion) -> Vec<Note> {
        let note = |expected: String, text: String| {
            let (key, socket) = ("estimator.kind", second.socket());
            Note::new(NoteCode::SecondOpinion, key, socket, expected, text)
        };
        let parted = self.furthest.as_ref().map(|most| {
            let text = format!(
                "it says {:.4} m of {} and {ESTIMATOR} {:.4} m, {:.1} mm apart",
                most.own_m,
                self.which(self.parted, most.frame, "furthest in"),
                most.other_m,
                1e3 * most.apart_m()
            );
            note(format!("{:.1} mm at most", 1e3 * most.allowed_m), text)
        });
        let unbelieved = self.first_unbelieved.as_ref().map(|(frame, why)| {
            let which = self.which(self.unbelieved, *frame, "first");
            let text = format!("{ESTIMATOR} believes no depth of {which}: {why}");
            note("an echo that stands out by itself".to_owned(), text)
        });
        parted.into_iter().chain(unbelieved).collect()
    }

    /// So many of the frames, of which one is shown.
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
        let mut partings = Partings::default();
        for (frame, opinion) in frames.iter().zip(&opinions) {
            opinion.iter().for_each(|opinion| partings.add(&second, frame, opinion));
        }
        (opinions, partings.notes(&second))
    }

    fn text(notes: &[Note]) -> String {
        notes.iter().map(|note| format!("{note}\n")).collect()
    }

    #[test]
    fn within_its_training_the_network_is_of_one_mind_with_it() {
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
        assert!(said.starts_with("note: estimator.kind = network: it says "), "{said}");
        assert!(said.contains(" m of frame 0 and likelihood_estimator 0."), "{said}");
        assert!(said.contains("mm at most) [second-opinion]") && notes.len() == 1, "{said}");
        let (_, notes) = seen(3, &["target.distance_m=0.8"]);
        assert!(
            text(&notes).contains(" m of 3 of 3 frames (furthest in frame "),
            "{}",
            text(&notes)
        );
    }

    #[test]
    fn what_the_estimator_does_not_believe_parts_from_nothing() {
        let (opinions, notes) = seen(2, &["firmware.laser_en=false"]);
        let opinion = opinions[1].as_ref().unwrap();
        assert!(opinion.status.contains(Status::NoEcho) && !opinion.valid);
        let said = text(&notes);
        let expected =
            "likelihood_estimator believes no depth of 2 of 2 frames (first frame 0): no echo";
        assert!(said.contains(expected) && notes.len() == 1, "{said}");
    }
}
