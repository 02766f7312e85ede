//! The command lines that make the parts of a report.

use tofsim_learn::dataset::grid::{DISTANCE, IRRADIANCE, REFLECTANCE};

/// Options that all command lines have.
pub struct Words<'a> {
    /// Name or path.
    pub scenario: &'a str,
    /// The overrides, as given.
    pub set: &'a [String],
    /// Seed in place of the scenario's.
    pub seed: Option<u64>,
    /// The grid that the scenario says itself, as options; without any the evaluation has the thesis's.
    pub grid: Vec<String>,
}

impl Words<'_> {
    /// A verb and what goes before the scenario, the scenario, its keys and its seed.
    pub fn of(&self, verb: &[&str]) -> Vec<String> {
        let mut words = self.without_seed(verb, self.set);
        words.extend(self.seed.iter().flat_map(|seed| ["--seed".to_owned(), seed.to_string()]));
        words
    }

    /// Returns the words of the evaluation, without keys that its grid sets.
    pub fn evaluation(&self) -> Vec<String> {
        let own = self.grid.iter().filter_map(|option| option.split('=').next());
        let mut keys: Vec<_> = own.collect();
        if keys.is_empty() {
            keys = vec![DISTANCE, REFLECTANCE, IRRADIANCE];
        }
        let key = |set: &String| set.split('=').next().unwrap_or_default().trim().to_owned();
        let is_free = |set: &&String| !keys.contains(&&*key(set));
        let set: Vec<_> = self.set.iter().filter(is_free).cloned().collect();
        Words { set: &set, grid: Vec::new(), ..*self }.of(&["evaluate", "--scenario"])
    }

    /// Returns the commands that make each part by itself.
    pub fn by_hand(&self) -> Vec<String> {
        let line = |words: Vec<String>, more: &str| format!("tofsim {}{more}", words.join(" "));
        vec![
            line(self.without_seed(&["budget"], self.set), ""),
            line(self.of(&["run"]), " -o frame"),
            line(self.without_seed(&["tdc"], self.set), " -o tdc"),
            line(self.of(&["budget", "--errors"]), ""),
            line(self.evaluation(), ""),
            line(self.without_seed(&["verify", "--scenario"], self.set), ""),
        ]
    }

    fn without_seed(&self, verb: &[&str], set: &[String]) -> Vec<String> {
        let words = verb.iter().copied().chain([self.scenario]).map(str::to_owned);
        words.chain(set.iter().flat_map(|set| ["-s".to_owned(), set.clone()])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_evaluation_leaves_out_keys_that_its_grid_has() {
        let set = ["target.distance_m=0.3", "tdc.profile=kintex7"].map(str::to_owned);
        let words = Words { scenario: "far", set: &set, seed: Some(7), grid: Vec::new() };
        let of_thesis = "evaluate --scenario far -s tdc.profile=kintex7 --seed 7";
        assert_eq!(words.evaluation().join(" "), of_thesis);
        let own = Words { grid: vec!["tdc.profile=a,b".to_owned()], ..words };
        assert!(own.evaluation().contains(&set[0]) && !own.evaluation().contains(&set[1]));
        assert_eq!(
            own.by_hand()[3],
            "tofsim budget --errors far -s target.distance_m=0.3 -s tdc.profile=kintex7 --seed 7"
        );
    }
}
