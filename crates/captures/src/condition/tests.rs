use super::*;

/// Looks up a test signal: `bit` (1), `bus` (8), `depth` (36, signed), `list[2]` (4), `a b` (8), `wide` (200).
fn find(name: &str) -> Result<Operand> {
    let known = [
        ("bit", 1, false),
        ("bus", 8, false),
        ("depth", 36, true),
        ("list[2]", 4, false),
        ("a b", 8, false),
        ("wide", 200, false),
    ];
    let index = known.iter().position(|known| known.0 == name);
    let index = index.ok_or_else(|| Input::new("", "unknown signal").value(name))?;
    Ok(Operand { index, width: known[index].1, signed: known[index].2 })
}

fn bound(text: &str) -> Bound {
    Condition::parse("--trigger", text).and_then(|c| c.bind(&mut find)).unwrap()
}

/// Evaluates a condition at samples of all test signals.
fn over(text: &str, samples: &[[u128; 5]]) -> Vec<bool> {
    let mut bound = bound(text);
    samples.iter().map(|s| bound.sample(|index| Level::known(s[index]))).collect()
}

fn holds(text: &str, sample: [u128; 5]) -> bool {
    over(text, &[sample])[0]
}

fn fault(text: &str) -> String {
    let condition = Condition::parse("--trigger", text);
    condition.and_then(|c| c.bind(&mut find)).unwrap_err().to_string()
}

#[test]
fn each_operator_compares() {
    for (operator, outcomes) in [
        ("==", [false, true, false]),
        ("!=", [true, false, true]),
        ("<", [true, false, false]),
        ("<=", [true, true, false]),
        (">", [false, false, true]),
        (">=", [false, true, true]),
    ] {
        let samples = [4, 5, 6].map(|bus| [0, bus, 0, 0, 0]);
        assert_eq!(over(&format!("bus {operator} 5"), &samples), outcomes, "{operator}");
        assert_eq!(over(&format!("bus{operator}0b101"), &samples), outcomes, "{operator}");
    }
}

#[test]
fn digits_that_do_not_matter_are_not_compared() {
    let samples = [0xa5, 0xa6, 0xb5, 0x25].map(|bus| [0, bus, 0, 0, 0]);
    assert_eq!(over("bus == 0xax", &samples), [true, true, false, false]);
    assert_eq!(over("bus != 0xaX", &samples), [false, false, true, true]);
    assert_eq!(over("bus == 0bx01x_xx01", &samples), [true, false, true, true]);
}

#[test]
fn a_signed_signal_is_compared_as_signed() {
    let minus_one = (1 << 36) - 1;
    assert!(holds("depth < 0", [0, 0, minus_one, 0, 0]));
    assert!(holds("depth == -1", [0, 0, minus_one, 0, 0]));
    assert!(holds("depth >= -2 && depth <= -1", [0, 0, minus_one, 0, 0]));
    assert!(holds("depth < 0xfffffffff", [0, 0, minus_one - 1, 0, 0]));
    assert!(!holds("depth[7:0] < 1", [0, 0, minus_one, 0, 0]), "a slice has no sign");
    assert!(holds("depth == -34359738368", [0, 0, 1 << 35, 0, 0]), "the lowest value");
}

#[test]
fn and_binds_tighter_than_or_and_not_takes_the_comparison() {
    assert!(holds("bit || bus == 1 && depth == 1", [1, 0, 0, 0, 0]));
    assert!(!holds("(bit or bus == 1) and depth == 1", [1, 0, 0, 0, 0]));
    assert!(holds("!bus == 5", [0, 4, 0, 0, 0]));
    assert!(holds("! !(bit && !bus == 5)", [1, 4, 0, 0, 0]));
}

#[test]
fn edges_hold_for_one_sample_and_never_at_the_first() {
    let samples = [1, 1, 0, 0, 1].map(|bit| [bit, 2 * bit, 0, 0, 0]);
    assert_eq!(over("bit rising", &samples), [false, false, false, false, true]);
    assert_eq!(over("bit falling", &samples), [false, false, true, false, false]);
    assert_eq!(over("bus changed", &samples), [false, false, true, false, true]);
    assert_eq!(over("bus[1] rising", &samples), [false, false, false, false, true]);
    assert_eq!(over("bus[7:2] changed", &samples), [false; 5]);
}

#[test]
fn edges_are_remembered_where_another_test_already_decides() {
    let samples = [[0, 0], [1, 0], [1, 1]].map(|[bit, bus]| [bit, bus, 0, 0, 0]);
    assert_eq!(over("bus == 1 && bit rising", &samples), [false; 3]);
}

#[test]
fn a_name_with_brackets_goes_before_a_slice() {
    assert!(holds("list[2] == 9", [0, 0, 0, 9, 0]));
    assert!(holds("list[2][3]", [0, 0, 0, 9, 0]));
    assert!(holds("bus[7:4] == 0xc", [0, 0xc3, 0, 0, 0]));
    assert!(holds("\"a b\" == 7 and \"a b\"[2:1] == 3", [0, 0, 0, 0, 7]));
}

#[test]
fn what_hangs_on_an_unknown_bit_does_not_hold_nor_does_its_opposite() {
    let at = |text: &str, unknown| bound(text).sample(|_| Level { value: 0x10, unknown });
    for text in ["bus == 0x10", "bus != 0x11", "bus < 0x20", "!(bus == 0x11)", "!bus > 0x20"] {
        assert!(at(text, 0), "{text}");
        assert!(!at(text, 1), "{text}");
    }
    assert!(at("bus == 0x1x", 1), "an unknown bit that does not matter");
    assert!(at("bus != 0x00", 1), "a known bit decides");
    assert!(at("bus == 0x1x || bus == 0x11", 1));
    assert!(!at("bus == 0x1x && bus == 0x10", 1));
    assert!(at("bus[7:4] == 1", 1), "an unknown bit outside the slice");
}

#[test]
fn a_bit_that_becomes_unknown_has_changed_but_not_fallen() {
    let levels = [(1, 0), (0, 1), (1, 1), (1, 0)].map(|(value, unknown)| Level { value, unknown });
    let over = |text: &str| {
        let mut bound = bound(text);
        levels.map(|level| bound.sample(|_| level))
    };
    assert_eq!(over("bit changed"), [false, true, false, true]);
    assert_eq!(over("bit rising || bit falling"), [false; 4]);
}

#[test]
fn a_fault_has_its_column() {
    for (text, expected) in [
        ("", "--trigger:1:1: the end: expected the name of a signal"),
        ("bus == ", "--trigger:1:8: the end: expected a value"),
        ("bus = 5", "--trigger:1:5: =: expected `==`"),
        ("bus < 0x1x", "--trigger:1:7: 0x1x: expected all digits: x is for == and != only"),
        ("bus == 256", "--trigger:1:8: 256: expected 0 to 255, a value of 8 bits"),
        ("bus == -1", "--trigger:1:8: -1: expected 0 to 255, a value of 8 bits"),
        ("bus[3:0] == 16", "--trigger:1:13: 16: expected 0 to 15, a value of 4 bits"),
        ("bus == 1 bit", "--trigger:1:10: bit: expected `&&`, `||` or the end of the condition"),
        ("(bit", "--trigger:1:5: the end: expected `)`"),
        ("bit && bus", "--trigger:1:8: bus: expected a signal of one bit, not 8"),
        ("bus rising", "--trigger:1:1: bus: expected a signal of one bit, not 8"),
        ("bit && but", "--trigger:1:8: but: unknown signal"),
        ("buy[7:4] == 1", "--trigger:1:1: buy: unknown signal"),
        ("bus[8]", "--trigger:1:1: bus[8]: `bus` has the bits [7:0], the higher first"),
        ("bus[0:1] == 1", "--trigger:1:1: bus[0:1]: `bus` has the bits [7:0], the higher first"),
        ("bit && \"bus", "--trigger:1:8: \"bus: expected a closing quote"),
        ("bit & bit", "--trigger:1:5: &: expected a name, a value or an operator"),
        ("wide changed", "--trigger:1:1: wide: expected a signal of at most 128 bits, not 200"),
        ("wide[128]", "--trigger:1:1: wide[128]: expected bits of the lowest 128"),
        ("wide[130:120] == 1", "--trigger:1:1: wide[130:120]: expected bits of the lowest 128"),
    ] {
        assert_eq!(fault(text), expected, "{text}");
    }
    assert!(fault("bus == 0b102").contains("expected a value: decimal"));
    assert!(fault("bus == 0x").contains("expected a value: decimal"));
    assert!(fault(&format!("bus == 0x{}", "1".repeat(33))).contains("at most 128 bits"));
    assert!(fault("depth == 34359738368").contains("-34359738368 to 34359738367"));
}

#[test]
fn values_go_up_to_128_bits() {
    let mut find = |name: &str| match name {
        "x" => Ok(Operand { index: 0, width: 128, signed: true }),
        _ => Err(Input::new("", "unknown signal").into()),
    };
    let mut holds = |text: &str, value| {
        let condition = Condition::parse("", text).unwrap();
        condition.bind(&mut find).unwrap().sample(|_| Level::known(value))
    };
    assert!(holds("x < -170141183460469231731687303715884105727", 1 << 127));
    assert!(holds("x == 0x8000_0000_0000_0000_0000_0000_0000_0000", 1 << 127));
    assert!(holds("x[127:126] == 2", 1 << 127));
}

#[test]
fn parentheses_without_end_are_refused() {
    assert!(fault(&"(".repeat(100_000)).contains("at most 64 parentheses"));
    assert!(holds(&format!("{}bit", "!".repeat(100_000)), [1, 0, 0, 0, 0]));
}
