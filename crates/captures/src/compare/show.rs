//! Formatting of values in the radix of their signals, and as numbers.

use tofsim::kernel::signals::SignalFormat as Shape;

use crate::ila::Radix;
use crate::ila::read::word;
use crate::source::{Signal, SignalKind, known_shape};
use crate::words::{Bits, extend};

/// Format of a signal's values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Show {
    /// As the firmware's signal; bits are one digit, or hexadecimal.
    Shape(Shape),
    /// Binary digits.
    #[default]
    Binary,
    /// Fixed-point number with the given number of fraction bits.
    Fixed(u32),
    /// Floating-point number.
    Real,
    /// Words.
    Text,
}

impl Show {
    /// Returns the format of a pair: that of either signal or, if neither has one, that of the firmware's signal of
    /// the same name.
    pub(super) fn of(a: &Signal, b: &Signal) -> Show {
        if a.kind == SignalKind::Real {
            return Show::Real;
        }
        if a.kind == SignalKind::Text {
            return Show::Text;
        }
        if a.kind == SignalKind::Event {
            return Show::Shape(Shape::Unsigned);
        }
        let shape = a.shape.or(b.shape).map(Show::Shape);
        let shown = shape.or_else(|| a.radix.or(b.radix).map(Show::radix));
        let known = || known_shape(&[&a.name, &b.name]).map(Show::Shape);
        shown.or_else(known).unwrap_or(Show::Shape(Shape::Bits))
    }

    /// Returns the format for a radix.
    pub(super) fn radix(radix: Radix) -> Show {
        match radix {
            Radix::Hex | Radix::Octal => Show::Shape(Shape::Bits),
            Radix::Signed => Show::Shape(Shape::Signed { fraction: 0 }),
            Radix::Unsigned => Show::Shape(Shape::Unsigned),
            Radix::Binary => Show::Binary,
        }
    }

    /// Returns whether values are in two's complement.
    pub(super) fn is_signed(self) -> bool {
        matches!(self, Show::Shape(Shape::Signed { .. }))
    }

    /// Formats a value.
    pub(super) fn text(self, bits: &Bits, width: u32) -> String {
        if self == Show::Text {
            return if bits.is_known() { word(&bits.value) } else { "x".to_owned() };
        }
        let digits = digits(bits, width);
        let Some(number) = bits.number() else {
            return match self {
                Show::Shape(Shape::Taps) if bits.is_known() => {
                    let ones: u32 = bits.value.iter().map(|word| word.count_ones()).sum();
                    format!("{ones} of {width} taps high")
                }
                _ => shorten(digits),
            };
        };
        match self {
            Show::Shape(Shape::Bits) => digits,
            Show::Binary => format!("0b{number:0width$b}", width = width as usize),
            Show::Shape(Shape::Unsigned) if width == 1 => digits,
            Show::Shape(Shape::Unsigned) => number.to_string(),
            Show::Shape(Shape::Signed { fraction: 0 }) => extend(number, width).to_string(),
            Show::Shape(Shape::Signed { fraction }) => {
                format!("{} ({digits})", scaled(extend(number, width) as f64, fraction))
            }
            Show::Fixed(fraction) => format!("{} ({digits})", scaled(number as f64, fraction)),
            Show::Shape(Shape::State(states)) => match states.get(number as usize) {
                Some(state) => format!("{state} ({number})"),
                None => format!("no state ({number})"),
            },
            Show::Shape(Shape::Taps) => format!("{} of {width} taps high", number.count_ones()),
            Show::Text => digits,
            Show::Real => f64::from_bits(number as u64).to_string(),
        }
    }
}

/// Formats a fixed-point number, with up to nine decimals.
fn scaled(value: f64, fraction: u32) -> String {
    let text = format!("{:.9}", value / 2f64.powi(fraction as i32));
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Formats the digits of a value: one for a single bit, binary if a bit is unknown, otherwise hexadecimal.
fn digits(bits: &Bits, width: u32) -> String {
    if width == 1 || !bits.is_known() {
        let text: String = (0..width).rev().map(|bit| bits.level(bit).to_string()).collect();
        let first = text.chars().next().unwrap_or('x');
        let all = text.chars().all(|digit| digit == first);
        return match width {
            1 => text,
            _ if all => first.to_string(),
            _ => format!("0b{text}"),
        };
    }
    let text: String = bits.value.iter().rev().map(|word| format!("{word:016x}")).collect();
    let count = width.div_ceil(4) as usize;
    format!("0x{}", &text[text.len().saturating_sub(count)..])
}

/// Shortens a long text in its middle.
fn shorten(text: String) -> String {
    const LONGEST: usize = 44;
    if text.len() > LONGEST {
        format!("{}..{}", &text[..20], &text[text.len() - 20..])
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(value: u64) -> Bits {
        Bits { value: vec![value], unknown: vec![0] }
    }

    #[test]
    fn values_are_shown_as_what_they_are() {
        assert_eq!(Show::Shape(Shape::Bits).text(&known(0xa5), 12), "0x0a5");
        assert_eq!(Show::Shape(Shape::Bits).text(&known(1), 1), "1");
        assert_eq!(Show::Binary.text(&known(5), 4), "0b0101");
        assert_eq!(Show::Shape(Shape::Signed { fraction: 0 }).text(&known(0xff), 8), "-1");
        assert_eq!(Show::Shape(Shape::Signed { fraction: 4 }).text(&known(0xf8), 8), "-0.5 (0xf8)");
        assert_eq!(
            Show::Shape(Shape::State(&["Clear", "Acquire"])).text(&known(1), 2),
            "Acquire (1)"
        );
        assert_eq!(Show::Shape(Shape::State(&["Clear"])).text(&known(3), 2), "no state (3)");
        assert_eq!(Show::Real.text(&known(1.5f64.to_bits()), 64), "1.5");
    }

    #[test]
    fn unknown_bits_are_shown_as_such() {
        let bits = Bits { value: vec![0b100], unknown: vec![0b110] };
        assert_eq!(Show::Shape(Shape::Unsigned).text(&bits, 4), "0b0zx0");
        assert_eq!(
            Show::Shape(Shape::Unsigned).text(&Bits { value: vec![0], unknown: vec![0xf] }, 4),
            "x"
        );
        let taps = Bits { value: vec![u64::MAX, 1, 0], unknown: vec![0; 3] };
        assert_eq!(Show::Shape(Shape::Taps).text(&taps, 190), "65 of 190 taps high");
    }
}
