//! Whether the numbers of a recipe make sense.

use tofsim::error::{Error, Input};
use tofsim::firmware::forward2::MOST_NEURONS;

use super::Recipe;

/// Histograms of a scene that the test grid has (thesis section 4.1).
const MOST_CHOICE: u64 = 5;
/// Distances of the training grid; below that, some would be left out.
const LEAST_SAMPLES: u64 = 201;

impl Recipe {
    /// That every number makes sense.
    ///
    /// # Errors
    /// Naming the first that does not.
    pub fn check(&self) -> Result<(), Error> {
        at_least("neurons", self.neurons as u64, 1)?;
        if self.neurons > MOST_NEURONS {
            let expected =
                format!("expected {MOST_NEURONS} at most, as the firmware has ports for");
            return Err(fault("neurons", self.neurons, expected).into());
        }
        at_least("checkpoint_epochs", self.checkpoint_epochs, 1)?;
        if self.validation > 0 {
            at_least("validation", self.validation, LEAST_SAMPLES)?;
            at_least("optimiser.max_fail", self.optimiser.max_fail.into(), 1)?;
        }
        if self.stages.is_empty() {
            return Err(fault("stages", 0, "expected one stage or more").into());
        }
        if self.start.lengths.is_empty() {
            return Err(fault("start.lengths", "[]", "expected one length or more").into());
        }
        self.check_stages()?;
        let finish = &self.finish;
        at_least("finish.blocks", finish.blocks as u64, 1)?;
        if !(1..=MOST_CHOICE).contains(&finish.choice) {
            let expected = format!("expected 1 to {MOST_CHOICE}");
            return Err(fault("finish.choice", finish.choice, expected).into());
        }
        for (field, value) in [
            ("finish.least", finish.least),
            ("finish.most", finish.most),
            ("optimiser.mu", self.optimiser.mu),
            ("optimiser.mu_max", self.optimiser.mu_max),
            ("optimiser.mu_dec", self.optimiser.mu_dec),
            ("limits.w1_share", self.limits.w1_share),
            ("limits.b1_share", self.limits.b1_share),
            ("limits.w2_share", self.limits.w2_share),
            ("limits.b2_share", self.limits.b2_share),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(fault(field, value, "expected a number above 0").into());
            }
        }
        if self.optimiser.mu_inc <= 1.0 || !self.optimiser.mu_inc.is_finite() {
            return Err(fault("optimiser.mu_inc", self.optimiser.mu_inc, "expected above 1").into());
        }
        for (field, value) in [("finish.power", finish.power), ("finish.keep", finish.keep)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(fault(field, value, "expected 0 to 1").into());
            }
        }
        if finish.least > finish.most {
            let expected = format!("expected finish.most = {} at most", finish.most);
            return Err(fault("finish.least", finish.least, expected).into());
        }
        self.formats.check()?;
        self.weighting.check()
    }

    /// That no stage has more candidates than the one before, and all have enough of everything.
    fn check_stages(&self) -> Result<(), Error> {
        let mut before = usize::MAX;
        for place in 0..=self.stages.len() {
            let (stage, name) = match self.stages.get(place) {
                Some(stage) => (*stage, format!("stages[{place}]")),
                None => (self.stage(place), "finish".to_owned()),
            };
            let field = format!("{name}.candidates");
            at_least(&field, stage.candidates as u64, 1)?;
            at_least(&format!("{name}.epochs"), stage.epochs, 1)?;
            at_least(&format!("{name}.samples"), stage.samples, LEAST_SAMPLES)?;
            if stage.candidates > before {
                let expected = format!("expected {before} at most, as in the stage before");
                return Err(fault(&field, stage.candidates, expected).into());
            }
            before = stage.candidates;
        }
        Ok(())
    }
}

fn at_least(field: &str, value: u64, least: u64) -> Result<(), Input> {
    match value >= least {
        true => Ok(()),
        false => Err(fault(field, value, format!("expected {least} or more"))),
    }
}

fn fault(field: &str, value: impl std::fmt::Display, expected: impl std::fmt::Display) -> Input {
    Input::new("recipe", expected).field(field).value(value)
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
        assert!(fault("", &["neurons=0"]).contains("neurons = 0: expected 1 or more"));
        assert!(fault("", &["finish.choice=6"]).contains("finish.choice = 6: expected 1 to 5"));
        assert!(fault("", &["finish.samples=5"]).contains("finish.samples = 5: expected 201"));
        assert!(fault("", &["finish.candidates=9"]).contains("expected 3 at most"));
        assert!(fault("", &["finish.keep=1.5"]).contains("finish.keep = 1.5: expected 0 to 1"));
        assert!(fault("", &["optimiser.mu=nan"]).contains("optimiser.mu = nan: expected a number"));
        assert!(fault("stages = []", &[]).contains("stages = 0: expected one stage"));
    }
}
