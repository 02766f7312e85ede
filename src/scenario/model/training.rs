//! Keys for training an instrument's network.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

table! {
    /// Defaults of `train` and `build` for this instrument's network; options override them.
    pub struct Training {
        /// Number of hidden neurons; the recipe's by default.
        #[schemars(range(min = 1, max = 32), extend("unit" = "neurons", "source" = "thesis ch. 5: 8"))]
        #[serde(skip_serializing_if = "Option::is_none")]
        pub neurons: Option<u64> = None,
        /// Training and test scenes: a grid for each key, as in `--grid`, such as `"target.distance_m" =
        /// "0.05..0.9:0.0025"`. Empty: the thesis's scenes.
        #[schemars(extend("source" = "thesis ch. 5"))]
        #[serde(skip_serializing_if = "BTreeMap::is_empty")]
        pub grid: BTreeMap<String, String> = BTreeMap::new(),
        /// Recipe: `short` (minutes), `quick` (seconds, poor accuracy), `uniform-16`, `long`, or the path of a recipe
        /// file.
        #[schemars(extend("source" = "docs/accuracy.md"))]
        #[serde(skip_serializing_if = "Option::is_none")]
        pub recipe: Option<String> = None,
        /// Number formats of the weights; the thesis's by default.
        #[serde(skip_serializing_if = "WordFormats::is_default")]
        pub formats: WordFormats = WordFormats::default(),
        /// Address width of the activation table; the recipe's by default.
        #[schemars(range(min = 4, max = 16), extend("unit" = "bit", "source" = "Table 6.4: 12"))]
        #[serde(skip_serializing_if = "Option::is_none")]
        pub lut_bits: Option<u32> = None,
    }
}

table! {
    /// Number formats, each a text with the total width and the number of fraction bits, such as `"16.23"`.
    pub struct WordFormats {
        /// Weights of the hidden layer.
        #[schemars(extend("source" = "Table 6.4"))]
        #[serde(skip_serializing_if = "Option::is_none")]
        pub w1: Option<String> = None,
        /// Biases of the hidden layer.
        #[schemars(extend("source" = "Table 6.4"))]
        #[serde(skip_serializing_if = "Option::is_none")]
        pub b1: Option<String> = None,
        /// Weights of the output.
        #[schemars(extend("source" = "Table 6.4"))]
        #[serde(skip_serializing_if = "Option::is_none")]
        pub w2: Option<String> = None,
        /// Bias of the output.
        #[schemars(extend("source" = "Table 6.4"))]
        #[serde(skip_serializing_if = "Option::is_none")]
        pub b2: Option<String> = None,
        /// Activations.
        #[schemars(extend("source" = "Table 6.4"))]
        #[serde(skip_serializing_if = "Option::is_none")]
        pub l1_out: Option<String> = None,
    }
}

impl Training {
    /// Returns whether no key is set.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the scenes in the syntax of the option `--grid`; empty for the thesis's scenes.
    pub fn grid_options(&self) -> Vec<String> {
        self.grid.iter().map(|(key, values)| format!("{key}={values}")).collect()
    }
}

impl WordFormats {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the formats that are set, with their keys.
    pub fn given(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let WordFormats { w1, b1, w2, b2, l1_out } = self;
        let all = [("w1", w1), ("b1", b1), ("w2", w2), ("b2", b2), ("l1_out", l1_out)];
        all.into_iter().filter_map(|(name, format)| Some((name, format.as_deref()?)))
    }
}

#[cfg(test)]
mod tests {
    use crate::scenario::Scenario;
    use crate::scenario::show::show;

    #[test]
    fn a_training_moves_neither_the_hash_nor_what_is_shown_of_a_scenario_without_one() {
        let plain = Scenario::default();
        let mut trained = plain.clone();
        trained.training.neurons = Some(4);
        assert_eq!(format!("{plain:?}"), format!("{trained:?}"));
        assert!(!show(&plain).contains("training"));
        let shown = show(&trained);
        assert!(shown.contains("[training]\n") && shown.contains("\nneurons = 4\n"), "{shown}");
    }
}
