//! Search for the end of the range of a key's values in which limits are met.

use tofsim::error::Result;
use tofsim::files::toml::{Checked, assign};
use tofsim::scenario::Scenario;
use toml_edit::Table;

use crate::columns::Column;
use crate::limit::Limit;

use super::axis::{Axis, checked_ends, is_whole, rounded};
use super::combination::{Combination, scenes};
use super::distribution::between;
use super::fault::at_key;
use super::file::{Find, Scale, SearchFile};

/// A checked search.
#[derive(Clone, Debug)]
pub struct Search {
    /// Key of the scenario.
    pub key: String,
    /// Limits that must be met.
    pub meets: Vec<Limit>,
    /// Column of each limit.
    pub columns: Vec<Column>,
    /// Axes of the scenes in all of which the limits must be met.
    pub over: Vec<Axis>,
    /// These scenes, as an assignment for each key.
    pub scenes: Vec<Vec<String>>,
    find: Find,
    ends: [f64; 2],
    resolution: f64,
    scale: Scale,
    steps: u64,
    is_whole: bool,
}

/// Result of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// The end of the range.
    Found(f64),
    /// The limits are met at all values.
    Everywhere,
    /// The limits are met at no value or, for the largest value, not at the first.
    Nowhere,
}

impl Search {
    /// Checks the search of a plan.
    ///
    /// # Errors
    /// If it is inconsistent, or the scenario has no such key or value.
    pub fn new(
        checked: &Checked,
        file: &SearchFile,
        points: &Combination,
        known: &[Column],
    ) -> Result<Self> {
        let fault =
            |field: &str, expected: &str| checked.fault(&format!("search.{field}"), expected);
        let ends = checked_ends([file.from, file.to], file.scale, &fault)?;
        if !(file.resolution.is_finite() && file.resolution > 0.0) {
            return Err(fault("resolution", "expected a number above 0").into());
        }
        if file.meets.is_empty() {
            return Err(
                fault("meets", "expected a limit, such as [\"peak.failure_rate < 0.1\"]").into()
            );
        }
        for end in ends {
            let assignment = format!("{}={end}", file.key);
            let checked_value = assign::<Scenario>(&mut Table::new(), "search", &assignment);
            checked_value.map_err(|error| at_key(checked, "search.key", error))?;
        }
        let over = Axis::all(checked, "search.over", &file.over)?;
        let mut taken: Vec<_> = points.axes.iter().map(|axis| axis.key.as_str()).collect();
        if taken.contains(&file.key.as_str()) || over.iter().any(|axis| axis.key == file.key) {
            return Err(fault("key", "expected a key that no axis has").into());
        }
        taken.push(&file.key);
        let scenes = scenes(checked, "search.over", &over, &taken)?;
        let limit = |(k, text): (usize, &String)| {
            Limit::parse(checked, &format!("search.meets.{k}"), text, known)
        };
        let meets: Vec<_> = file.meets.iter().enumerate().map(limit).collect::<Result<_>>()?;
        let column = |limit: &Limit| known.iter().find(|column| column.name == limit.column);
        let columns = meets.iter().filter_map(column).cloned().collect();
        Ok(Search {
            key: file.key.clone(),
            meets,
            columns,
            over,
            scenes,
            find: file.find,
            ends,
            resolution: file.resolution,
            scale: file.scale,
            steps: file.steps,
            is_whole: is_whole(&file.key),
        })
    }

    /// Steps from the first value on until the limits begin or cease to be met, and bisects that step down to the
    /// resolution. `are_met` evaluates the limits at a value.
    ///
    /// # Errors
    /// If `are_met` fails.
    pub fn run(&self, mut are_met: impl FnMut(f64) -> Result<bool>) -> Result<Answer> {
        let wanted = self.find == Find::Least;
        let mut before = self.value(0.0);
        if are_met(before)? {
            if wanted {
                return Ok(Answer::Everywhere);
            }
        } else if !wanted {
            return Ok(Answer::Nowhere);
        }
        for step in 1..=self.steps {
            let next = self.value(step as f64 / self.steps as f64);
            if are_met(next)? == wanted {
                return self.halve([before, next], wanted, are_met).map(Answer::Found);
            }
            before = next;
        }
        Ok(if wanted { Answer::Nowhere } else { Answer::Everywhere })
    }

    /// Bisects between a value before the change and one after it.
    fn halve(
        &self,
        [mut before, mut after]: [f64; 2],
        wanted: bool,
        mut are_met: impl FnMut(f64) -> Result<bool>,
    ) -> Result<f64> {
        while !self.is_near(before, after) {
            let middle = self.settled(between([before, after], self.scale, 0.5));
            if middle <= before || middle >= after {
                break;
            }
            if are_met(middle)? == wanted { after = middle } else { before = middle }
        }
        Ok(if wanted { after } else { before })
    }

    fn is_near(&self, before: f64, after: f64) -> bool {
        let apart = match self.scale {
            Scale::Linear => after - before,
            Scale::Log => after / before - 1.0,
        };
        // A resolution that is a power of ten is not to be missed by a rounding.
        apart <= self.resolution * (1.0 + 1e-9)
    }

    /// Returns the value at a fraction of the range.
    fn value(&self, part: f64) -> f64 {
        self.settled(between(self.ends, self.scale, part))
    }

    /// Rounds a value to one that the scenario accepts.
    pub fn settled(&self, value: f64) -> f64 {
        if self.is_whole { value.round() } else { rounded(value) }
    }

    /// Returns the value at which the outputs for an answer are computed.
    pub fn shown(&self, answer: Answer) -> f64 {
        match (answer, self.find) {
            (Answer::Found(value), _) => value,
            (Answer::Everywhere, Find::Largest) | (Answer::Nowhere, Find::Least) => self.ends[1],
            (Answer::Everywhere, Find::Least) | (Answer::Nowhere, Find::Largest) => self.ends[0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(find: Find, ends: [f64; 2], resolution: f64, scale: Scale) -> Search {
        Search {
            key: "target.distance_m".to_owned(),
            meets: Vec::new(),
            columns: Vec::new(),
            over: Vec::new(),
            scenes: vec![Vec::new()],
            find,
            ends,
            resolution,
            scale,
            steps: 10,
            is_whole: false,
        }
    }

    fn found(search: &Search, are_met: impl Fn(f64) -> bool) -> (Answer, usize) {
        let mut asked = 0;
        let answer = search.run(|value| {
            asked += 1;
            Ok(are_met(value))
        });
        (answer.unwrap(), asked)
    }

    #[test]
    fn the_end_of_a_stretch_is_found_to_the_resolution_from_the_side_that_meets() {
        let largest = search(Find::Largest, [0.1, 0.9], 0.001, Scale::Linear);
        let (Answer::Found(value), asked) = found(&largest, |value| value <= 0.4321) else {
            panic!()
        };
        assert!((0.4311..=0.4321).contains(&value), "{value}");
        assert!(asked <= 6 + 7, "{asked}");
        let least = search(Find::Least, [1e-6, 1.0], 0.01, Scale::Log);
        let (Answer::Found(value), _) = found(&least, |value| value >= 3e-4) else { panic!() };
        assert!((3e-4..=3.03e-4).contains(&value), "{value}");
    }

    #[test]
    fn the_first_change_counts() {
        let largest = search(Find::Largest, [0.0, 1.0], 1e-6, Scale::Linear);
        let (answer, _) = found(&largest, |value| !(0.25..=0.5).contains(&value));
        let Answer::Found(value) = answer else { panic!("{answer:?}") };
        assert!((value - 0.25).abs() < 2e-6);
    }

    #[test]
    fn limits_that_are_met_everywhere_or_nowhere_have_no_end() {
        for (find, at_all, at_none) in [(Find::Largest, 1.0, 0.0), (Find::Least, 0.0, 1.0)] {
            let search = search(find, [0.0, 1.0], 0.1, Scale::Linear);
            assert_eq!(found(&search, |_| true).0, Answer::Everywhere);
            assert_eq!(found(&search, |_| false).0, Answer::Nowhere);
            assert_eq!(search.shown(Answer::Everywhere), at_all);
            assert_eq!(search.shown(Answer::Nowhere), at_none);
        }
    }

    #[test]
    fn whole_numbers_are_searched_one_by_one() {
        let mut search = search(Find::Least, [1.0, 1000.0], 1.0, Scale::Linear);
        search.is_whole = true;
        assert_eq!(found(&search, |value| value >= 777.0).0, Answer::Found(777.0));
    }
}
