//! The fields of a network file and the rules they obey.

use crate::error::Result;
use crate::firmware::forward2::MOST_NEURONS;
use crate::firmware::tansig::ADDRESS_BITS;

use super::Network;
use super::file::{Accuracy, Training};
use super::float::Float;
use super::formats::{
    B1, B2, Fixed, Format, HiddenBias, HiddenWeight, L1_OUT, OutputBias, OutputWeight,
    TANSIG_RANGE, W1, W2,
};
use super::read::{Source, Table, Value};

/// Value of the key `schema`.
pub(super) const SCHEMA: &str = "tofsim.network/1";
/// Keys of `[scaling]`, each with the one value that the firmware's arithmetic allows.
pub(super) const SCALING: [(&str, &str); 3] =
    [("input", "counts"), ("output", "metres"), ("normalisation", "folded")];
/// Keys of `[formats]`, but for `tansig`.
pub(super) const FORMATS: [(&str, Format); 5] =
    [("w1", W1), ("b1", B1), ("w2", W2), ("b2", B2), ("l1_out", L1_OUT)];

impl Network {
    /// A network from the text of its file; messages name `source`.
    pub fn parse(text: &str, source: &str) -> Result<Network> {
        let source = Source { text, name: source };
        let tree = source.parse()?;
        let mut root = Table::root(source, &tree);
        root.required("schema")?.keyword(SCHEMA)?;
        let description = root.required("description")?.text()?;
        let training = training(root.required("training")?.table()?)?;
        let accuracy = section(root.optional("accuracy"), accuracy)?;
        scaling(root.required("scaling")?.table()?)?;
        formats(root.required("formats")?.table()?)?;
        let fixed = integers(root.required("integers")?.table()?)?;
        let float = section(root.optional("float"), |table| float(table, fixed.neurons()))?;
        let name = source.name.to_owned();
        let network = Network { name, description, training, accuracy, fixed, float };
        root.finish()?;
        Ok(network)
    }
}

fn section<T>(value: Option<Value>, read: impl FnOnce(Table) -> Result<T>) -> Result<Option<T>> {
    value.map(|value| read(value.table()?)).transpose()
}

fn training(mut table: Table) -> Result<Training> {
    let training = Training {
        origin: table.required("origin")?.text()?,
        chain: table.required("chain")?.text()?,
        command: table.optional("command").map(|command| command.text()).transpose()?,
        seed: table.optional("seed").map(|seed| seed.natural()).transpose()?,
        data: table.optional("data").map(|data| data.text()).transpose()?,
    };
    table.finish()?;
    Ok(training)
}

fn accuracy(mut table: Table) -> Result<Accuracy> {
    let numbers = |value: &Value| value.list()?.iter().map(Value::number).collect::<Result<_>>();
    let distances_m: Vec<f64> = numbers(&table.required("distances_m")?)?;
    let at_each = |value: Value| {
        let values: Vec<f64> = numbers(&value)?;
        match values.len() == distances_m.len() {
            true => Ok(values),
            false => {
                let (found, expected) = (values.len(), distances_m.len());
                let expected = format!("{found} values, expected one a distance: {expected}");
                Err(value.fault(expected))
            }
        }
    };
    let two_sd_mm = at_each(table.required("two_sd_mm")?)?;
    let mean_mm = table.optional("mean_mm").map(at_each).transpose()?;
    table.finish()?;
    Ok(Accuracy { distances_m, two_sd_mm, mean_mm })
}

fn scaling(mut table: Table) -> Result<()> {
    for (key, word) in SCALING {
        table.required(key)?.keyword(word)?;
    }
    table.finish()
}

fn formats(mut table: Table) -> Result<()> {
    for (key, format) in FORMATS {
        let mut word = table.required(key)?.table()?;
        word.required("width")?.exactly(format.width.into())?;
        word.required("fraction")?.exactly(format.fraction.into())?;
        word.finish()?;
    }
    let mut tansig = table.required("tansig")?.table()?;
    tansig.required("address_bits")?.exactly(ADDRESS_BITS.into())?;
    tansig.required("range")?.exactly(TANSIG_RANGE)?;
    tansig.finish()?;
    table.finish()
}

fn integers(mut table: Table) -> Result<Fixed> {
    let b1 = |v: &Value| Ok(HiddenBias::from_bits(word(v, B1)?));
    let w2 = |v: &Value| Ok(OutputWeight::from_bits(word(v, W2)?));
    let weight = |v: &Value| Ok(HiddenWeight::from_bits(word(v, W1)?.into()));
    let w1 =
        table.required("w1")?.many("rows", 1..=MOST_NEURONS, |row| row.array("weights", weight))?;
    let each = w1.len()..=w1.len();
    let fixed = Fixed {
        b1: table.required("b1")?.many("biases", each.clone(), b1)?,
        w2: table.required("w2")?.many("weights", each, w2)?,
        b2: OutputBias::from_bits(word(&table.required("b2")?, B2)?.into()),
        w1,
    };
    table.finish()?;
    Ok(fixed)
}

/// An integer of a 16-bit word.
fn word(value: &Value, format: Format) -> Result<i16> {
    let (min, max) = (format.min(), format.max());
    let fraction = format.fraction;
    let expected =
        format_args!("expected an integer from {min} to {max} (16 bits, {fraction} fraction)");
    Ok(value.integer(min..=max, expected)? as i16)
}

/// The weights before rounding of a network with so many neurons.
fn float(mut table: Table, neurons: usize) -> Result<Float> {
    let each = neurons..=neurons;
    let row = |row: &Value| row.array("weights", Value::number);
    let float = Float {
        w1: table.required("w1")?.many("rows", each.clone(), row)?,
        b1: table.required("b1")?.many("biases", each.clone(), Value::number)?,
        w2: table.required("w2")?.many("weights", each, Value::number)?,
        b2: table.required("b2")?.number()?,
    };
    table.finish()?;
    Ok(float)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The message about the built-in file after replacing a piece of it.
    fn fault(from: &str, to: &str) -> String {
        let text = Network::builtin_text("uniform").unwrap();
        assert!(text.contains(from), "{from}");
        Network::parse(&text.replacen(from, to, 1), "a.toml").unwrap_err().to_string()
    }

    /// What the file's first row of integers begins with, and the same with `word` in place of the
    /// first one.
    fn first(word: &str) -> (String, String) {
        let network = Network::builtin("uniform").unwrap().unwrap();
        let begin = |word: &str| format!("w1 = [\n  [\n    {word}");
        let old = format!("{}, ", network.fixed.w1[0][0].to_bits());
        (begin(&old), begin(word))
    }

    #[test]
    fn a_weight_outside_its_word_is_named_with_its_range() {
        let (from, to) = first("40000, ");
        let message = fault(&from, &to);
        let expected = "integers.w1[0][0] = 40000: expected an integer from -32768 to 32767 \
                        (16 bits, 23 fraction)";
        assert!(message.starts_with("a.toml:") && message.ends_with(expected), "{message}");
    }

    #[test]
    fn a_weight_that_is_no_integer_is_named() {
        let (from, to) = first("-89.5, ");
        let message = fault(&from, &to);
        assert!(message.contains("integers.w1[0][0] = -89.5: expected an integer"), "{message}");
    }

    #[test]
    fn a_row_of_the_wrong_length_is_named() {
        let (from, to) = first("");
        let message = fault(&from, &to);
        assert!(message.contains("integers.w1[0]: 255 weights, expected 256"), "{message}");
    }

    #[test]
    fn formats_other_than_the_firmware_s_are_refused() {
        let message = fault("fraction = 23", "fraction = 22");
        assert!(message.contains("formats.w1.fraction = 22: expected 23"), "{message}");
        let message = fault("address_bits = 12", "address_bits = 10");
        assert!(message.contains("formats.tansig.address_bits = 10: expected 12"), "{message}");
    }

    #[test]
    fn a_missing_field_and_an_unknown_key_are_named() {
        let message = fault("chain = ", "chian = ");
        assert!(message.contains("training.chain: missing"), "{message}");
        let message = fault("[scaling]\n", "[scaling]\noutptu = 1\n");
        let expected = "scaling.outptu: unknown key; did you mean output?";
        assert!(message.ends_with(expected), "{message}");
    }

    #[test]
    fn a_fault_of_syntax_has_line_and_column() {
        let error = Network::parse("schema = \"x\"\nb = [1, 2\n", "a.toml").unwrap_err();
        assert!(error.to_string().starts_with("a.toml:2:"), "{error}");
        assert!(error.to_string().contains("not TOML"), "{error}");
    }

    #[test]
    fn values_of_the_wrong_kind_are_refused() {
        for (from, to, expected) in [
            ("\"counts\"", "3", "expected \"counts\""),
            ("\"tofsim.network/1\"", "\"tofsim.network/9\"", "expected \"tofsim.network/1\""),
            ("b2 = 3", "b2 = \"3\" #", "integers.b2 = \"3\": expected an integer"),
            ("two_sd_mm = [", "two_sd_mm = [1.0, ", "7 values, expected one a distance: 6"),
            ("[float]\n", "[float]\nb3 = nan\n", "float.b3: unknown key"),
            ("w2 = [\n    ", "w2 = [\n    1, ", "integers.w2: 9 weights, expected 8"),
            ("w1 = [\n  [", "w1 = [\n  [1],\n  [", "integers.w1[0]: 1 weights, expected 256"),
        ] {
            let message = fault(from, to);
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn the_float_weights_may_be_absent() {
        let text = Network::builtin_text("uniform").unwrap();
        let (integers, _) = text.split_once("[float]").unwrap();
        assert_eq!(Network::parse(integers, "a.toml").unwrap().float, None);
    }
}
