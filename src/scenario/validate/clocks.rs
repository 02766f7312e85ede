//! Checks of the PLL's settings against the limits of the part.

use std::ops::RangeInclusive;

use crate::error;
use crate::files::toml::Checked;
use crate::scenario::model::{Part, Pll};

/// Limits of a part's PLL.
struct Limits {
    /// Name of the PLL primitive.
    name: &'static str,
    /// Frequency of the board's oscillator [Hz].
    input_hz: RangeInclusive<u64>,
    /// Frequency at the phase detector [Hz].
    detector_hz: RangeInclusive<u64>,
    /// Frequency of the VCO [Hz].
    vco_hz: RangeInclusive<u64>,
    /// Highest frequency of `clk_laser`, the faster output [Hz].
    fastest_hz: u64,
    /// Ranges of the keys `multiply` and `divide`.
    dividers: [RangeInclusive<u64>; 2],
}

/// Limits of a Kintex-7 of speed grade -2 (DS182, PLL switching characteristics); `clk_laser` is limited by its
/// global clock buffer.
const KINTEX_7: Limits = Limits {
    name: "a PLLE2",
    input_hz: 19_000_000..=800_000_000,
    detector_hz: 19_000_000..=500_000_000,
    vco_hz: 800_000_000..=1_866_000_000,
    fastest_hz: 710_000_000,
    dividers: [2..=64, 1..=56],
};

/// Limits of an ECP5 (FPGA-DS-02012, sysCLOCK PLL timing).
const ECP5: Limits = Limits {
    name: "an EHXPLLL",
    input_hz: 8_000_000..=400_000_000,
    detector_hz: 10_000_000..=400_000_000,
    vco_hz: 400_000_000..=800_000_000,
    fastest_hz: 400_000_000,
    dividers: [1..=128, 1..=128],
};

/// Largest divider of an ECP5.
const MOST_OF_ECP5: u64 = 128;

/// A key of the table `pll`.
struct Key {
    name: &'static str,
    field: fn(&mut Pll) -> &mut u64,
}

static INPUT: Key = Key { name: "pll.input_hz", field: |pll| &mut pll.input_hz };
static MULTIPLY: Key = Key { name: "pll.multiply", field: |pll| &mut pll.multiply };
static DIVIDE: Key = Key { name: "pll.divide", field: |pll| &mut pll.divide };
static OUTPUT: Key = Key { name: "pll.output_divide", field: |pll| &mut pll.output_divide };

/// Range in which a fitting divider is searched.
const VALUES: RangeInclusive<u64> = 1..=128;

/// A key at fault, and what was expected of it.
type Fault = (&'static Key, String);

/// Checks that the part has the dividers, and that they keep its PLL within its limits.
///
/// # Errors
/// The key, its value, what was expected, and, if changing one divider suffices, a value that fits.
pub(super) fn check(pll: &Pll, checked: &Checked) -> error::Result<()> {
    let Err((key, expected)) = limits(pll) else { return Ok(()) };
    let others = [key, &MULTIPLY, &DIVIDE, &OUTPUT];
    let expected = match others.into_iter().find_map(|key| Some((key, fitting(pll, key)?))) {
        Some((key, value)) => format!("{expected}; {} = {value} fits", key.name),
        None => expected,
    };
    let value = *(key.field)(&mut pll.clone());
    Err(checked.fault(key.name, expected).value(value).into())
}

/// Returns the value of one divider that satisfies all limits and is nearest to the present value.
fn fitting(pll: &Pll, key: &Key) -> Option<u64> {
    let mut pll = pll.clone();
    let now = *(key.field)(&mut pll);
    let fits = |value: &u64| {
        *(key.field)(&mut pll) = *value;
        limits(&pll).is_ok()
    };
    VALUES.filter(fits).min_by_key(|value| value.abs_diff(now))
}

fn limits(pll: &Pll) -> Result<(), Fault> {
    let &Pll { input_hz, multiply, divide, output_divide, .. } = pll;
    let part = if pll.part == Part::Ecp5 { ECP5 } else { KINTEX_7 };
    let name = part.name;
    if !part.input_hz.contains(&input_hz) {
        return Err((&INPUT, format!("expected {} for {name}", in_mhz(&part.input_hz))));
    }
    for ((key, value), range) in
        [(&MULTIPLY, multiply), (&DIVIDE, divide)].into_iter().zip(&part.dividers)
    {
        if !range.contains(&value) {
            let expected = format!("expected {} to {} for {name}", range.start(), range.end());
            return Err((key, expected));
        }
    }
    if !output_divide.is_multiple_of(2) {
        let expected = "expected an even number: clk_laser has half of it";
        return Err((&OUTPUT, expected.to_owned()));
    }
    let within = |key: &'static Key, what: &str, hz: f64, range: &RangeInclusive<u64>| {
        if (*range.start() as f64..=*range.end() as f64).contains(&hz) {
            return Ok(());
        }
        let mhz = hz / 1e6;
        let expected = in_mhz(range);
        Err((key, format!("{what} would run at {mhz} MHz, expected {expected} for {name}")))
    };
    let hz = (input_hz * multiply) as f64 / divide as f64;
    within(&MULTIPLY, "the VCO", hz, &part.vco_hz)?;
    let hz = 2.0 * hz / output_divide as f64;
    within(&OUTPUT, "clk_laser", hz, &(0..=part.fastest_hz))?;
    let detected = match pll.part {
        Part::Kintex7 => divide,
        Part::Ecp5 => ecp5_dividers(pll)?,
    };
    let hz = input_hz as f64 / detected as f64;
    within(&DIVIDE, "the phase detector", hz, &part.detector_hz)
}

/// Computes the input divider of an ECP5, whose loop is closed over `clk_laser`: the oscillator's frequency times
/// CLKFB_DIV / CLKI_DIV.
fn ecp5_dividers(pll: &Pll) -> Result<u64, Fault> {
    let (feedback, input) = (2 * pll.multiply, pll.divide * pll.output_divide);
    let common = greatest_common_divisor(feedback, input);
    let (feedback, input) = (feedback / common, input / common);
    if feedback.max(input) <= MOST_OF_ECP5 {
        return Ok(input);
    }
    let expected = format!(
        "clk_laser would be {feedback}/{input} of the input, expected numbers up to {MOST_OF_ECP5}"
    );
    Err((&MULTIPLY, format!("{expected}: CLKFB_DIV and CLKI_DIV of {}", ECP5.name)))
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

fn in_mhz(range: &RangeInclusive<u64>) -> String {
    let [least, most] = [range.start(), range.end()].map(|hz| *hz as f64 / 1e6);
    if least == 0.0 { format!("{most} MHz at most") } else { format!("{least} to {most} MHz") }
}

#[cfg(test)]
mod tests {
    use crate::scenario::load;

    fn refusal(set: &[&str]) -> String {
        let set: Vec<_> = set.iter().map(|key| format!("pll.{key}")).collect();
        load("kc705", &set).map_or_else(|error| error.to_string(), |_| String::new())
    }

    #[test]
    fn a_refusal_names_the_key_and_a_value_that_fits() {
        for (set, expected) in [
            (
                &["multiply=3"][..],
                "pll.multiply = 3: the VCO would run at 600 MHz, expected 800 to 1866 MHz for a PLLE2; pll.multiply = 4 fits",
            ),
            (
                &["multiply=10"],
                "would run at 2000 MHz, expected 800 to 1866 MHz for a PLLE2; pll.multiply = 9 fits",
            ),
            (
                &["output_divide=5"],
                "pll.output_divide = 5: expected an even number: clk_laser has half of it; pll.output_divide = 4 fits",
            ),
            (
                &["output_divide=2"],
                "clk_laser would run at 1000 MHz, expected 710 MHz at most for a PLLE2; pll.output_divide = 4 fits",
            ),
            (
                &["multiply=65"],
                "pll.multiply = 65: expected 2 to 64 for a PLLE2; pll.multiply = 9 fits",
            ),
            (&["divide=57", "multiply=64"], "pll.divide = 57: expected 1 to 56 for a PLLE2"),
            (&["divide=11", "multiply=55"], "the phase detector would run at 18.181"),
            (&["input_hz=10000000"], "pll.input_hz = 10000000: expected 19 to 800 MHz for a PLLE2"),
            (&["input_hz=800000000"], "the VCO would run at 4000 MHz"),
            (
                &["part=ecp5"],
                "the VCO would run at 1000 MHz, expected 400 to 800 MHz for an EHXPLLL; pll.multiply = 4 fits",
            ),
            (
                &["part=ecp5", "divide=2", "output_divide=2"],
                "clk_laser would run at 500 MHz, expected 400 MHz at most",
            ),
            (
                &["part=ecp5", "input_hz=25000000", "multiply=127", "divide=5", "output_divide=64"],
                "pll.multiply = 127: clk_laser would be 127/160 of the input, expected numbers up to 128: CLKFB_DIV and CLKI_DIV of an EHXPLLL",
            ),
            (
                &["part=ecp5", "input_hz=12000000", "multiply=125", "divide=3", "output_divide=4"],
                "the phase detector would run at 2 MHz, expected 10 to 400 MHz",
            ),
            (
                &["part=ecp5", "input_hz=500000000", "divide=4"],
                "pll.input_hz = 500000000: expected 8 to 400 MHz",
            ),
            (&["part=spartan"], "expected"),
        ] {
            let found = refusal(set);
            assert!(found.contains(expected), "{found}\n{expected}");
        }
    }

    #[test]
    fn what_a_part_can_make_is_taken() {
        for set in [
            &[][..],
            &["output_divide=10"],
            &["input_hz=150000000", "multiply=10", "output_divide=12"],
            &["part=ecp5", "divide=2", "output_divide=4"],
            &["part=ecp5", "input_hz=25000000", "multiply=24", "output_divide=6"],
        ] {
            assert_eq!(refusal(set), "", "{set:?}");
        }
    }
}
