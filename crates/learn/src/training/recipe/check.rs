//! Whether the numbers of a recipe make sense.

use std::fmt::Display;

use tofsim::error::{Error, Input};
use tofsim::firmware::forward2::MOST_NEURONS;

use super::{Recipe, Stage};
use crate::training::basis::fill_tiles;

/// Histograms of a scene that the test grid has (thesis section 4.1).
const MOST_CHOICE: u64 = 5;
/// Least and largest number of knots: the ends and a few between, and a bin each.
const LEAST_KNOTS: usize = 15;
/// See [`LEAST_KNOTS`].
const MOST_KNOTS: usize = 1031;
/// Most candidates of a stage, which are in memory together.
const MOST_CANDIDATES: usize = 1 << 16;
/// Distances of the training grid; below that, some would be left out.
const LEAST_SAMPLES: u64 = 201;
/// Most histograms of a stage or of the validation, which are in memory together.
const MOST_SAMPLES: u64 = 1 << 24;

impl Recipe {
    /// Checks that every number is valid.
    ///
    /// # Errors
    /// Naming the first that is not.
    pub fn check(&self) -> Result<(), Error> {
        let Recipe { neurons, validation, start, stages, finish, optimiser, limits, .. } = self;
        at_least("neurons", *neurons as u64, 1)?;
        let most = format!("expected {MOST_NEURONS} at most, as the firmware has ports for");
        ensure(*neurons <= MOST_NEURONS, "neurons", neurons, most)?;
        at_least("checkpoint_epochs", self.checkpoint_epochs, 1)?;
        if *validation > 0 {
            check_samples("validation", *validation)?;
            at_least("optimiser.max_fail", optimiser.max_fail.into(), 1)?;
        }
        let knots = self.knots.unwrap_or(LEAST_KNOTS);
        let fits = (LEAST_KNOTS..=MOST_KNOTS).contains(&knots) && fill_tiles(knots);
        let expected =
            format!("expected {LEAST_KNOTS}, 23, 31 .. {MOST_KNOTS}, a multiple of 8 less one");
        ensure(fits, "knots", knots, expected)?;
        ensure(!stages.is_empty(), "stages", 0, "expected one stage or more")?;
        ensure(!start.lengths.is_empty(), "start.lengths", "[]", "expected one length or more")?;
        self.check_stages()?;
        let is_choice = (1..=MOST_CHOICE).contains(&finish.choice);
        let expected = format!("expected 1 to {MOST_CHOICE}");
        ensure(is_choice, "finish.choice", finish.choice, expected)?;
        for (field, value) in [
            ("finish.least", finish.least),
            ("finish.most", finish.most),
            ("optimiser.mu", optimiser.mu),
            ("optimiser.mu_max", optimiser.mu_max),
            ("optimiser.mu_dec", optimiser.mu_dec),
            ("limits.w1_share", limits.w1_share),
            ("limits.b1_share", limits.b1_share),
            ("limits.w2_share", limits.w2_share),
            ("limits.b2_share", limits.b2_share),
        ] {
            let is_above_0 = value > 0.0 && value.is_finite();
            ensure(is_above_0, field, value, "expected a number above 0")?;
        }
        let mu_inc = optimiser.mu_inc;
        ensure(mu_inc > 1.0 && mu_inc.is_finite(), "optimiser.mu_inc", mu_inc, "expected above 1")?;
        for (field, value) in [("finish.power", finish.power), ("finish.keep", finish.keep)] {
            ensure((0.0..=1.0).contains(&value), field, value, "expected 0 to 1")?;
        }
        let expected = format!("expected finish.most = {} at most", finish.most);
        ensure(finish.least <= finish.most, "finish.least", finish.least, expected)?;
        self.formats.check("formats")?;
        self.weighting.check()
    }

    /// Checks that no stage has more candidates than the one before, and that all have enough of everything.
    fn check_stages(&self) -> Result<(), Input> {
        let mut before = usize::MAX;
        for place in 0..=self.stages.len() {
            let is_finish = place == self.stages.len();
            let name = if is_finish { "finish".to_owned() } else { format!("stages[{place}]") };
            let Stage { candidates, epochs, samples } = self.stage(place);
            let field = format!("{name}.candidates");
            at_least(&field, candidates as u64, 1)?;
            let expected = format!("expected {MOST_CANDIDATES} at most");
            ensure(candidates <= MOST_CANDIDATES, &field, candidates, expected)?;
            at_least(&format!("{name}.epochs"), epochs, 1)?;
            check_samples(&format!("{name}.samples"), samples)?;
            let expected = format!("expected {before} at most, as in the stage before");
            ensure(candidates <= before, &field, candidates, expected)?;
            before = candidates;
        }
        Ok(())
    }
}

fn check_samples(field: &str, samples: u64) -> Result<(), Input> {
    at_least(field, samples, LEAST_SAMPLES)?;
    ensure(samples <= MOST_SAMPLES, field, samples, format!("expected {MOST_SAMPLES} at most"))
}

fn at_least(field: &str, value: u64, least: u64) -> Result<(), Input> {
    ensure(value >= least, field, value, format!("expected {least} or more"))
}

fn ensure(
    holds: bool,
    field: &str,
    value: impl Display,
    expected: impl Display,
) -> Result<(), Input> {
    let fault = || Input::new("recipe", expected).field(field).value(value);
    if holds { Ok(()) } else { Err(fault()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str, set: &[&str]) -> Result<Recipe, Error> {
        let set: Vec<_> = set.iter().map(|&text| text.to_owned()).collect();
        Recipe::parse(text, &Recipe::default(), &set, "a.toml")
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        let fault = |text: &str, set: &[&str]| parse(text, set).unwrap_err().to_string();
        assert!(fault("neuron = 3", &[]).contains("neuron: unknown key; did you mean `neurons`?"));
        assert!(
            fault("", &["limits.b3=1"]).starts_with("--with limits.b3=1: limits.b3: unknown key")
        );
        assert!(fault("", &["neurons"]).contains("expected key=value"));
        assert!(fault("", &["knots=72"]).contains("knots = 72: expected 15, 23, 31"));
        assert!(fault("", &["validation=20000000"]).contains("expected 16777216 at most"));
        let stage = "stages = [{ candidates = 2, epochs = 1, samples = 1000000000000 }]";
        assert!(fault(stage, &[]).contains("samples = 1000000000000: expected 16777216 at most"));
        assert!(fault("", &["neurons=0"]).contains("neurons = 0: expected 1 or more"));
        assert!(fault("", &["finish.choice=6"]).contains("finish.choice = 6: expected 1 to 5"));
        assert!(fault("", &["finish.samples=5"]).contains("finish.samples = 5: expected 201"));
        assert!(fault("", &["finish.candidates=9"]).contains("expected 3 at most"));
        assert!(fault("", &["finish.keep=1.5"]).contains("finish.keep = 1.5: expected 0 to 1"));
        assert!(fault("", &["optimiser.mu=nan"]).contains("optimiser.mu = nan: expected a number"));
        assert!(fault("stages = []", &[]).contains("stages = 0: expected one stage"));
    }
}
