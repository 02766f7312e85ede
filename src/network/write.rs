//! Writer of network files, with a layout in which a change of few weights changes few lines.

use serde::Serialize;

use crate::kernel::WordFormat;

use super::file::{FLOAT_SECTION, Network};
use super::schema::{SCALING, SCHEMA};
use super::weights::Weights;

/// Number of weights per line.
const INTEGERS_A_LINE: usize = 16;
const FLOATS_A_LINE: usize = 4;

impl Network {
    /// Formats the network as a TOML text.
    pub fn to_toml(&self) -> String {
        let description = toml::Value::from(self.description.as_str());
        let mut text =
            format!("schema = \"{SCHEMA}\"\ndescription = {description}\n\n[training]\n");
        text += &keys(&self.training);
        if let Some(domain) = &self.domain {
            text += "\n# What it was trained for, by keys of the scenario: least and largest value, and words.\n";
            text += &format!("[domain.ranges]\n{}", keys(&domain.ranges));
            text += &format!("\n[domain.words]\n{}", keys(&domain.words));
        }
        if let Some(accuracy) = &self.accuracy {
            text +=
                "\n# Fixed point: twice the standard deviation of the depth, and its mean error.\n";
            text += "[accuracy]\n";
            text += &keys(accuracy);
        }
        text +=
            "\n# Raw counts in, metres out; the normalisation is part of w1 and b1.\n[scaling]\n";
        text.extend(SCALING.map(|(key, word)| format!("{key} = \"{word}\"\n")));
        text +=
            "\n# Signed words: width and how many of its bits, or more, are fraction.\n[formats]\n";
        let word = |(key, WordFormat { width, fraction })| {
            format!("{key} = {{ width = {width}, fraction = {fraction} }}\n")
        };
        text.extend(self.datapath.words().map(word));
        text += &format!(
            "tansig = {{ address_bits = {}, range = {} }}\n\n\
             # What the ROMs hold: w1[neuron][bin].\n[integers]\n",
            self.datapath.address_bits,
            1 << self.datapath.range_log2
        );
        let integer = |word: i32| word.to_string();
        let integers = self.fixed.map(integer, integer, integer, integer);
        text += &weights(&integers, INTEGERS_A_LINE);
        if let Some(float) = self.float.get() {
            let exact = |weight: f64| format!("{weight:?}");
            text += "\n# The weights before rounding.";
            text += FLOAT_SECTION;
            text += &weights(&float.map(exact, exact, exact, exact), FLOATS_A_LINE);
        }
        text
    }
}

/// Formats the keys of a serializable table.
fn keys(table: &impl Serialize) -> String {
    toml::to_string(table).unwrap_or_default()
}

fn weights(weights: &Weights<String, String, String, String>, a_line: usize) -> String {
    let Weights { w1, b1, w2, b2 } = weights;
    let rows: String = w1.iter().map(|row| list("  ", "  ", row, a_line, ",")).collect();
    let [b1, w2] =
        [("b1 = ", b1), ("w2 = ", w2)].map(|(key, values)| list(key, "", values, a_line, ""));
    format!("w1 = [\n{rows}]\n{b1}{w2}b2 = {b2}\n")
}

/// Formats a list with `a_line` items per line, preceded by `before` and followed by `after`.
fn list(before: &str, indent: &str, items: &[String], a_line: usize, after: &str) -> String {
    let lines = items.chunks(a_line).map(|line| format!("    {},\n", line.join(", ")));
    format!("{before}[\n{}{indent}]{after}\n", lines.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back_the_same() {
        let mut network = Network::builtin("ideal").unwrap().unwrap();
        network.description = "quotes \" and \\ and\nlines".to_owned();
        network.training.command = Some("tofsim train".to_owned());
        network.training.seed = Some(7);
        network.training.data = Some("0123".to_owned());
        if let Some(accuracy) = &mut network.accuracy {
            accuracy.mean_mm = Some(vec![-0.5; accuracy.distances_m.len()]);
        }
        assert_eq!(Network::parse(&network.to_toml(), "ideal").unwrap(), network);
        network.accuracy = None;
        assert_eq!(Network::parse(&network.to_toml(), "ideal").unwrap(), network);
    }
}
