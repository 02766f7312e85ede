//! Reader of `waveform.dmp`: one line of samples per bit, held in memory as bits.

use std::io::BufRead;

use tofsim::error::{Input, Result};

use super::buffer::Buffer;
use super::line::Line;
use super::opened::{LARGEST, WIDEST_SAMPLE, damaged};

/// Contents of a dump.
#[derive(Debug, Default)]
pub(super) struct Dump {
    /// Name of the core.
    pub(super) core: String,
    /// Bits per sample.
    pub(super) width: u32,
    /// Samples.
    pub(super) buffer: Buffer,
}

impl Dump {
    /// Reads a dump.
    pub(super) fn read(source: &str, mut file: impl BufRead) -> Result<Self> {
        let (mut dump, mut bit) = (Dump::default(), 0);
        let (mut width, mut samples) = (None, None);
        let (mut number, mut text) = (0, Vec::new());
        while file.read_until(b'\n', &mut text).map_err(|error| damaged(source, error))? > 0 {
            number += 1;
            let text = std::mem::take(&mut text);
            let Some(line) = Line::new(source, number, &text)? else { continue };
            match line.key.as_str() {
                "core_id" => dump.core = line.value(),
                "data_width" => width = Some(line.number()?),
                "sample_count" => samples = Some(line.number()?),
                "window_marks" => dump.buffer.windows = line.list()?,
                "trigger_marks" => dump.buffer.triggers = line.list()?,
                "gaps" => dump.buffer.gaps = line.list()?,
                key if key.starts_with("ch[") => {
                    if bit == 0 {
                        dump.size(source, width, samples)?;
                    }
                    if key != format!("ch[{bit}]") || bit == dump.width {
                        let expected = if bit == dump.width {
                            format!("expected no more than {bit} channels (data_width)")
                        } else {
                            format!("expected ch[{bit}] next")
                        };
                        return Err(line.fault(1, expected).into());
                    }
                    dump.buffer.channel(&line)?;
                    bit += 1;
                }
                _ => {}
            }
        }
        if bit == 0 {
            dump.size(source, width, samples)?;
        }
        if bit != dump.width && dump.buffer.samples > 0 {
            let text = format!("ends after {bit} channels, expected {} (data_width)", dump.width);
            return Err(Input::new(source, text).into());
        }
        dump.check_marks(source)?;
        Ok(dump)
    }

    fn size(&mut self, source: &str, width: Option<u64>, samples: Option<u64>) -> Result<()> {
        let fault = |text: String| Input::new(source, text);
        let (Some(width), Some(samples)) = (width, samples) else {
            let text = "expected data_width and sample_count before the channels";
            return Err(fault(text.into()).into());
        };
        if width > WIDEST_SAMPLE as u64 || (width == 0 && samples > 0) {
            let text = format!("expected 1 to {WIDEST_SAMPLE} bits");
            return Err(fault(text).field("data_width").value(width).into());
        }
        if width.saturating_mul(samples) > LARGEST {
            let text = format!(
                "{width} bits in each sample make more than {LARGEST} bits, more than any FPGA's \
                 block RAM holds"
            );
            return Err(fault(text).field("sample_count").value(samples).into());
        }
        self.width = width as u32;
        self.buffer.size(samples);
        Ok(())
    }

    fn check_marks(&mut self, source: &str) -> Result<()> {
        let Buffer { samples, windows, triggers, gaps, .. } = &mut self.buffer;
        // A last window without samples is marked at the end.
        windows.pop_if(|&mut window| window == *samples && window > 0);
        for (key, marks) in
            [("window_marks", &*windows), ("trigger_marks", &*triggers), ("gaps", &*gaps)]
        {
            let fault = |text: String, mark| Input::new(source, text).field(key).value(mark);
            if let Some(pair) = marks.windows(2).find(|pair| pair[0] >= pair[1]) {
                let text = format!("expected a sample after {}", pair[0]);
                return Err(fault(text, pair[1]).into());
            }
            if let Some(&last) = marks.last()
                && last >= (*samples).max(1)
            {
                let text = format!("expected a sample below {samples} (sample_count)");
                return Err(fault(text, last).into());
            }
        }
        if let Some(&first) = windows.first()
            && first != 0
        {
            let fault = Input::new(source, "expected the first window at 0");
            return Err(fault.field("window_marks").value(first).into());
        }
        let window = |trigger: u64| windows.partition_point(|&start| start <= trigger);
        if let Some(pair) = triggers.windows(2).find(|pair| window(pair[0]) == window(pair[1])) {
            let text = format!("a second trigger in the window that has one at {}", pair[0]);
            return Err(Input::new(source, text).field("trigger_marks").value(pair[1]).into());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ila::read::{CaptureRow, CaptureRows};

    const HEAD: &str = "core_id:7\ndata_width:2\nsample_count:3\nhas_timestamps:false\n";

    fn fault(rest: &str) -> String {
        let text = format!("{HEAD}{rest}");
        Dump::read("a.dmp", text.as_bytes()).err().map_or("fine".into(), |error| error.to_string())
    }

    #[test]
    fn bits_marks_and_gaps_are_read() {
        let text = "window_marks:0 2 3\r\ntrigger_marks:1 2\r\ngaps:1\r\ntimestamps:\r\nch[0]: 101\r\n\
                    ch[1]: 001";
        let dump = Dump::read("a.dmp", format!("{HEAD}{text}").as_bytes()).unwrap();
        assert_eq!((dump.core.as_str(), dump.width, dump.buffer.samples), ("7", 2, 3));
        let column = super::super::header::parse("a[1:0]").unwrap();
        let mut rows = dump.buffer.rows(vec![column], vec![0]);
        let (mut row, mut found) = (CaptureRow::default(), Vec::new());
        while rows.next(&mut row).unwrap() {
            found.push((
                row.in_window,
                row.window_start,
                row.trigger,
                row.value[0],
                row.unknown[0],
            ));
        }
        let expected = [(0, true, false, 1, 0), (1, false, true, 0, 3), (0, true, true, 3, 0)];
        assert_eq!(found, expected);
    }

    #[test]
    fn counts_that_do_not_hold_are_told_with_their_line() {
        assert_eq!(fault("ch[0]: 101\nch[1]:111\n"), "fine");
        assert_eq!(fault("ch[0]: 101\n"), "a.dmp: ends after 1 channels, expected 2 (data_width)");
        let few = "a.dmp:5:9: ch[0]: 2 samples, expected 3 (sample_count)";
        assert_eq!(fault("ch[0]: 10"), few);
        assert!(
            fault("ch[0]: 1011\n").starts_with("a.dmp:5:11: ch[0] = 1: expected no more than 3")
        );
        assert!(fault("ch[0]: 1x1\n").starts_with("a.dmp:5:9: ch[0] = x: expected 0 or 1"));
        assert!(fault("ch[1]: 101\n").starts_with("a.dmp:5:1: ch[1]: expected ch[0] next"));
        let more = "ch[0]:101\nch[1]:101\nch[2]:101\n";
        assert!(fault(more).starts_with("a.dmp:7:1: ch[2]: expected no more than 2 channels"));
        assert!(fault("nonsense\n").starts_with("a.dmp:5:1: nonsense: expected a key"));
    }

    #[test]
    fn marks_that_cannot_be_are_told() {
        let body = "\nch[0]: 101\nch[1]: 111\n";
        let fault = |marks| fault(&format!("{marks}{body}"));
        assert!(
            fault("window_marks:1").ends_with("window_marks = 1: expected the first window at 0")
        );
        assert!(
            fault("window_marks:0 4").ends_with("= 4: expected a sample below 3 (sample_count)")
        );
        assert!(fault("trigger_marks:1 1").ends_with("= 1: expected a sample after 1"));
        assert!(
            fault("trigger_marks:3").ends_with("= 3: expected a sample below 3 (sample_count)")
        );
        let twice = "trigger_marks = 2: a second trigger in the window that has one at 1";
        assert!(fault("window_marks:0\ntrigger_marks:1 2").ends_with(twice));
        assert!(fault("gaps:a").ends_with("a.dmp:5:6: gaps = a: expected numbers of samples"));
        assert_eq!(fault("window_marks:0 2\ntrigger_marks:1 2"), "fine");
    }

    #[test]
    fn more_than_a_block_ram_holds_is_refused_before_it_is_read() {
        let fault = |text: &str| Dump::read("a.dmp", text.as_bytes()).unwrap_err().to_string();
        let text = fault("data_width:1024\nsample_count:524289\nch[0]: 1");
        assert!(
            text.contains(
                "sample_count = 524289: 1024 bits in each sample make more than 536870912"
            )
        );
        assert!(
            fault("data_width:9999999\nsample_count:1\n").contains("expected 1 to 1048576 bits")
        );
        assert!(
            fault("data_width:-1\n").starts_with("a.dmp:1:12: data_width = -1: expected a whole")
        );
        assert!(fault("ch[0]: 1").contains("expected data_width and sample_count before"));
    }
}
