use super::*;
use crate::network::unrounded::Unrounded;

/// Returns the error message for the built-in file with a piece of its text replaced.
fn fault(from: &str, to: &str) -> String {
    let text = Network::builtin_text("uniform").unwrap();
    assert!(text.contains(from), "{from}");
    Network::parse(&text.replacen(from, to, 1), "a.toml").unwrap_err().to_string()
}

/// Returns the start of the file's first row of integers, and the same with the first integer replaced by `word`.
fn first(word: &str) -> (String, String) {
    let network = Network::builtin("uniform").unwrap().unwrap();
    let begin = |word: &str| format!("w1 = [\n  [\n    {word}");
    let old = format!("{}, ", network.fixed.w1[0][0]);
    (begin(&old), begin(word))
}

#[test]
fn a_weight_outside_its_word_is_named_with_its_range() {
    let (from, to) = first("40000, ");
    let message = fault(&from, &to);
    let expected = "integers.w1.0.0 = 40000: expected a whole number from -32768 to 32767";
    assert!(message.starts_with("a.toml:") && message.ends_with(expected), "{message}");
}

#[test]
fn a_weight_that_is_no_integer_is_named() {
    let (from, to) = first("-89.5, ");
    let message = fault(&from, &to);
    assert!(message.contains("integers.w1.0.0 = -89.5: expected a whole number"), "{message}");
}

#[test]
fn a_row_of_the_wrong_length_is_named() {
    let (from, to) = first("");
    let message = fault(&from, &to);
    assert!(
        message.contains("integers.w1.0 = a list of 255: expected a list of 16, 32, 64"),
        "{message}"
    );
}

#[test]
fn formats_that_cannot_be_built_are_refused() {
    let message = fault("fraction = 23", "fraction = 12");
    assert!(message.contains("formats.b1.fraction = 13: expected 0 to 12"), "{message}");
    let message = fault("address_bits = 12", "address_bits = 20");
    assert!(message.contains("formats.tansig.address_bits = 20: expected 4 to 16"), "{message}");
    let message = fault("range = 4", "range = 5");
    assert!(message.contains("formats.tansig.range = 5: expected 1, 2, 4"), "{message}");
}

#[test]
fn a_missing_field_and_an_unknown_key_are_named() {
    let message = fault("chain = ", "chian = ");
    assert!(message.contains("training.chain: missing"), "{message}");
    let message = fault("[scaling]\n", "[scaling]\noutptu = 1\n");
    let expected = "scaling.outptu: unknown key; did you mean `output`?";
    assert!(message.ends_with(expected), "{message}");
}

#[test]
fn a_fault_of_syntax_has_line_and_column() {
    let error = Network::parse("schema = \"x\"\nb = [1, 2\n", "a.toml").unwrap_err();
    assert!(error.to_string().starts_with("a.toml:2:"), "{error}");
    assert!(error.to_string().contains("unclosed array"), "{error}");
}

#[test]
fn values_of_the_wrong_kind_are_refused() {
    for (from, to, expected) in [
        ("\"counts\"", "3", "scaling.input = 3: expected a text in quotes"),
        ("\"counts\"", "\"hits\"", "scaling.input = \"hits\": expected \"counts\""),
        ("\"tofsim.network/1\"", "\"tofsim.network/9\"", "expected \"tofsim.network/1\""),
        (
            "\"target.distance_m\" = [0.1, 0.6]",
            "\"target.distance_m\" = [0.1]",
            "domain.ranges.target.distance_m = [0.1]: expected a list of 2",
        ),
        ("b2 = 3", "b2 = \"3\" #", "integers.b2 = \"3\": expected a whole number"),
        (
            "two_sd_mm = [",
            "two_sd_mm = [1.0, ",
            "accuracy.two_sd_mm = [1.0, 1.24, 2.29, 2.45, 2.27, 2.88, 4.7]: expected one a distance: 6",
        ),
        ("[float]\n", "[float]\nb3 = nan\n", "float.b3: unknown key"),
        ("w2 = [\n    ", "w2 = [\n    1, ", "integers.w2 = a list of 9: expected 8, one a neuron"),
        (
            "w1 = [\n  [",
            "w1 = [\n  [1],\n  [",
            "integers.w1.0 = [1]: expected a list of 16 to 1024",
        ),
    ] {
        let message = fault(from, to);
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn the_float_weights_may_be_absent() {
    let text = Network::builtin_text("uniform").unwrap();
    let (integers, _) = text.split_once("[float]").unwrap();
    assert_eq!(Network::parse(integers, "a.toml").unwrap().float, Unrounded::Unknown);
}
