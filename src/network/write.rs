//! The text of a network file, laid out so that a change of a few weights is a change of few lines.

use std::fmt::{Display, Write};

use crate::firmware::tansig::ADDRESS_BITS;

use super::file::Network;
use super::formats::TANSIG_RANGE;
use super::schema::{FORMATS, SCALING, SCHEMA};

/// Weights on a line.
const INTEGERS_A_LINE: usize = 16;
const FLOATS_A_LINE: usize = 4;

impl Network {
    /// The network's file.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        // Writing to a string does not fail.
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, out: &mut String) -> std::fmt::Result {
        writeln!(out, "schema = \"{SCHEMA}\"")?;
        writeln!(out, "description = {}", quoted(&self.description))?;
        writeln!(out, "\n[training]")?;
        writeln!(out, "origin = {}", quoted(&self.training.origin))?;
        writeln!(out, "chain = {}", quoted(&self.training.chain))?;
        if let Some(command) = &self.training.command {
            writeln!(out, "command = {}", quoted(command))?;
        }
        if let Some(seed) = self.training.seed {
            writeln!(out, "seed = {seed}")?;
        }
        if let Some(data) = &self.training.data {
            writeln!(out, "data = {}", quoted(data))?;
        }
        if let Some(accuracy) = &self.accuracy {
            writeln!(
                out,
                "\n# Fixed point: twice the standard deviation of the depth, and its mean error."
            )?;
            writeln!(out, "[accuracy]")?;
            writeln!(out, "distances_m = {:?}", accuracy.distances_m)?;
            writeln!(out, "two_sd_mm = {:?}", accuracy.two_sd_mm)?;
            if let Some(mean_mm) = &accuracy.mean_mm {
                writeln!(out, "mean_mm = {mean_mm:?}")?;
            }
        }
        writeln!(out, "\n# Raw counts in, metres out; the normalisation is part of w1 and b1.")?;
        writeln!(out, "[scaling]")?;
        for (key, word) in SCALING {
            writeln!(out, "{key} = \"{word}\"")?;
        }
        writeln!(out, "\n# Signed words: width and how many of its bits, or more, are fraction.")?;
        writeln!(out, "[formats]")?;
        for (key, format) in FORMATS {
            let (width, fraction) = (format.width, format.fraction);
            writeln!(out, "{key} = {{ width = {width}, fraction = {fraction} }}")?;
        }
        writeln!(out, "tansig = {{ address_bits = {ADDRESS_BITS}, range = {TANSIG_RANGE} }}")?;
        self.write_weights(out)
    }

    fn write_weights(&self, out: &mut String) -> std::fmt::Result {
        let fixed = &self.fixed;
        writeln!(out, "\n# What the ROMs hold: w1[neuron][bin].\n[integers]")?;
        let rows = fixed.w1.iter().map(|row| row.map(|weight| weight.to_bits()));
        matrix(out, "w1", rows, INTEGERS_A_LINE)?;
        let b1: Vec<_> = fixed.b1.iter().map(|bias| bias.to_bits()).collect();
        list(out, "b1 = ", &b1, INTEGERS_A_LINE, "")?;
        let w2: Vec<_> = fixed.w2.iter().map(|weight| weight.to_bits()).collect();
        list(out, "w2 = ", &w2, INTEGERS_A_LINE, "")?;
        writeln!(out, "b2 = {}", fixed.b2.to_bits())?;
        if let Some(float) = &self.float {
            let exact = |number: f64| format!("{number:?}");
            writeln!(out, "\n# The weights before rounding.\n[float]")?;
            let rows = float.w1.iter().map(|row| row.map(exact));
            matrix(out, "w1", rows, FLOATS_A_LINE)?;
            let all = |values: &[f64]| values.iter().copied().map(exact).collect::<Vec<_>>();
            list(out, "b1 = ", &all(&float.b1), FLOATS_A_LINE, "")?;
            list(out, "w2 = ", &all(&float.w2), FLOATS_A_LINE, "")?;
            writeln!(out, "b2 = {:?}", float.b2)?;
        }
        Ok(())
    }
}

fn matrix<T: Display>(
    out: &mut String,
    key: &str,
    rows: impl Iterator<Item = [T; 256]>,
    a_line: usize,
) -> std::fmt::Result {
    writeln!(out, "{key} = [")?;
    for row in rows {
        list(out, "  ", &row, a_line, ",")?;
    }
    writeln!(out, "]")
}

fn list<T: Display>(
    out: &mut String,
    before: &str,
    items: &[T],
    a_line: usize,
    after: &str,
) -> std::fmt::Result {
    writeln!(out, "{before}[")?;
    for line in items.chunks(a_line) {
        let line: Vec<String> = line.iter().map(T::to_string).collect();
        writeln!(out, "    {},", line.join(", "))?;
    }
    let indent = if before.trim().is_empty() { before } else { "" };
    writeln!(out, "{indent}]{after}")
}

/// A basic string of TOML.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
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
