//! Writer of the CSV: one row per sample, with or without a row of radices.

use std::io::{self, Write};

use bitvec::prelude::*;

use crate::words::extend;

use super::super::capture::{Capture, Probe, Radix};
use super::spill::spill;

/// Writes a capture as Vivado's CSV; `radix_row` selects whether it has a second row with radices.
pub fn csv(out: &mut dyn Write, capture: &Capture, radix_row: bool) -> io::Result<()> {
    head(out, capture, radix_row)?;
    let mut windows = capture.windows.iter().copied().peekable();
    let mut triggers = capture.triggers.iter().copied().peekable();
    let (mut begin, mut text) = (0, Vec::new());
    for sample in 0..capture.samples() {
        while let Some(window) = windows.next_if(|&window| window <= sample) {
            begin = window;
        }
        let trigger = triggers.next_if_eq(&sample).is_some() as u8;
        write!(text, "{sample},{},{trigger}", sample - begin)?;
        for (probe, place) in capture.probes.iter().zip(capture.places()) {
            text.push(b',');
            write_cell(&mut text, shown(probe), &capture.sample(sample)[place])?;
        }
        text.push(b'\n');
        spill(out, &mut text)?;
    }
    out.write_all(&text)
}

fn head(out: &mut dyn Write, capture: &Capture, radix_row: bool) -> io::Result<()> {
    let mut table = ::csv::WriterBuilder::new().flexible(true).from_writer(out);
    let fixed = ["Sample in Buffer", "Sample in Window", "TRIGGER"].map(str::to_owned);
    table.write_record(fixed.into_iter().chain(capture.probes.iter().map(|probe| probe.head())))?;
    if radix_row {
        let fixed = ["Radix - UNSIGNED", "UNSIGNED", "UNSIGNED"];
        let words = capture.probes.iter().map(|probe| shown(probe).into());
        table.write_record(fixed.into_iter().chain(words))?;
    }
    table.flush()
}

/// Returns the radix in which a probe is written: decimal only up to 128 bits.
fn shown(probe: &Probe) -> Radix {
    match probe.radix {
        Radix::Signed | Radix::Unsigned if probe.width > 128 => Radix::Hex,
        radix => radix,
    }
}

/// Writes the digits of a value.
pub(crate) fn write_cell(out: &mut Vec<u8>, radix: Radix, cell: &BitSlice<u64>) -> io::Result<()> {
    let digits = |bits| {
        let digit = |digit: &BitSlice<u64>| b"0123456789abcdef"[digit.load_le::<usize>()];
        cell.chunks(bits).rev().map(digit).collect::<Vec<u8>>()
    };
    match radix {
        Radix::Hex => out.write_all(&digits(4)),
        Radix::Octal => out.write_all(&digits(3)),
        Radix::Binary => out.write_all(&digits(1)),
        Radix::Unsigned => write!(out, "{}", cell.load_le::<u128>()),
        Radix::Signed => write!(out, "{}", extend(cell.load_le(), cell.len() as u32)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ila::Probe;

    fn probe(name: &str, width: u32, vector: bool, radix: Radix) -> Probe {
        Probe { name: name.to_owned(), width, lsb: 0, vector, radix }
    }

    fn text(capture: &Capture, radix_row: bool) -> String {
        let mut out = Vec::new();
        csv(&mut out, capture, radix_row).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn rows_are_laid_out_as_vivado_lays_them_out() {
        let mut capture = Capture::new(vec![
            probe("top/count", 9, true, Radix::Hex),
            probe("level", 4, true, Radix::Signed),
            probe("total", 4, true, Radix::Unsigned),
            probe("state", 3, true, Radix::Binary),
            probe("mode", 4, true, Radix::Octal),
            probe("a,\"b", 1, false, Radix::Hex),
        ]);
        capture.words = vec![0x0a, 0x1_ff | 0x8 << 9 | 0xe << 13 | 2 << 17 | 9 << 20 | 1 << 24];
        capture.windows = vec![0, 1];
        capture.triggers = vec![1];
        let heads = "top/count[8:0],level[3:0],total[3:0],state[2:0],mode[3:0],\"a,\"\"b\"";
        let rows = "0,0,0,00a,0,0,000,00,0\n1,0,1,1ff,-8,14,010,11,1\n";
        let fixed = "Sample in Buffer,Sample in Window,TRIGGER";
        let radices = "Radix - UNSIGNED,UNSIGNED,UNSIGNED,HEX,SIGNED,UNSIGNED,BINARY,OCTAL,HEX";
        assert_eq!(text(&capture, true), format!("{fixed},{heads}\n{radices}\n{rows}"));
        assert_eq!(text(&capture, false), format!("{fixed},{heads}\n{rows}"));
    }

    #[test]
    fn decimals_end_at_128_bits() {
        let mut capture = Capture::new(vec![
            probe("whole", 128, true, Radix::Unsigned),
            probe("least", 128, true, Radix::Signed),
            probe("wider", 129, true, Radix::Unsigned),
        ]);
        capture.words = vec![u64::MAX, u64::MAX, 0, 1 << 63, 5, 0, 1];
        capture.windows = vec![0];
        let text = text(&capture, true);
        assert!(text.contains("UNSIGNED,UNSIGNED,SIGNED,HEX\n"), "{text}");
        let wider = format!("1{}5", "0".repeat(31));
        let row = format!("0,0,0,{},{},{wider}\n", u128::MAX, i128::MIN);
        assert!(text.ends_with(&row), "{text}");
    }
}
