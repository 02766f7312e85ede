//! WaveJSON, the timing diagrams of WaveDrom, with a column for each instant.

use std::io::{self, Error, ErrorKind, Write};
use std::path::Path;

use serde_json::json;

use tofsim::error::Result;
use tofsim::files::output::OutputFile;
use tofsim::waves::dump::{Dump, DumpValue};

use crate::source::SignalKind;

use super::columns::Columns;

/// Largest number of columns: diagrams of more cannot be drawn.
const MOST: usize = 4096;

/// A WaveJSON file under construction.
pub(super) struct WaveJson {
    file: OutputFile,
    columns: Columns,
    events: Vec<usize>,
    times: Vec<u64>,
    lanes: Vec<Lane>,
}

/// A signal's part of the diagram.
#[derive(Clone, Default)]
struct Lane {
    /// A brick for each column.
    wave: String,
    /// Labels of the bricks with data.
    data: Vec<String>,
    is_event: bool,
}

/// Extends a lane to a number of columns without a change. Until its first change an event has not occurred, and
/// another signal is unknown.
fn extend(wave: &mut String, is_event: bool, columns: usize) {
    let first = if is_event { '0' } else { 'x' };
    while wave.len() < columns {
        wave.push(if wave.is_empty() { first } else { '.' });
    }
}

impl WaveJson {
    pub(super) fn create(path: &Path, columns: Columns) -> Result<WaveJson> {
        let file = OutputFile::create(path)?;
        let (events, mut lanes) = (columns.events(), vec![Lane::default(); columns.signals.len()]);
        events.iter().for_each(|&event| lanes[event].is_event = true);
        Ok(WaveJson { file, columns, events, times: Vec::new(), lanes })
    }

    /// Puts a brick into the present column of a lane, in place of what it has there.
    fn put(&mut self, lane: usize, brick: char, data: Option<String>) {
        let Lane { wave, data: labels, is_event } = &mut self.lanes[lane];
        extend(wave, *is_event, self.times.len() - 1);
        if wave.len() == self.times.len() && wave.pop() == Some('=') {
            labels.pop();
        }
        wave.push(brick);
        labels.extend(data);
    }

    /// Ends the events of the previous column.
    fn end_events(&mut self) {
        for event in self.events.clone() {
            if self.lanes[event].wave.ends_with('1') {
                self.put(event, '0', None);
            }
        }
    }
}

impl Dump for WaveJson {
    fn begin(&mut self, at: u64) -> io::Result<()> {
        if self.times.last() == Some(&at) {
            return Ok(());
        }
        if self.times.len() == MOST {
            let expected = format!(
                "expected {MOST} instants at most in WaveJSON: write a part with `tofsim wave cut`"
            );
            return Err(Error::new(ErrorKind::InvalidInput, expected));
        }
        self.times.push(at);
        self.end_events();
        Ok(())
    }

    fn change(&mut self, id: usize, value: DumpValue<'_>) -> io::Result<()> {
        let width = self.columns.signals[id].width;
        let all = |value: &[u64], unknown: &[u64], digit: u8| {
            (0..width).all(|place| DumpValue::digit(value, unknown, place) == digit)
        };
        let brick = match value {
            DumpValue::Event => '1',
            DumpValue::Bits { value, unknown } if width == 1 => {
                DumpValue::digit(value, unknown, 0).into()
            }
            DumpValue::Bits { value, unknown } if all(value, unknown, b'x') => 'x',
            DumpValue::Bits { value, unknown } if all(value, unknown, b'z') => 'z',
            _ => '=',
        };
        let data = (brick == '=').then(|| self.columns.text(id, value));
        self.put(id, brick, data);
        Ok(())
    }

    fn finish(mut self: Box<Self>, at: u64) -> Result<()> {
        let begun = self.begin(at);
        begun.map_err(|error| self.file.fault(error))?;
        let columns = self.times.len();
        for lane in &mut self.lanes {
            extend(&mut lane.wave, lane.is_event, columns);
        }
        let WaveJson { mut file, columns: of, times, lanes, .. } = *self;
        let time = of.unit.map_or("sample".to_owned(), |unit| format!("time [{unit}]"));
        let labels: Vec<String> = times.iter().map(|&at| of.time(at).to_string()).collect();
        let time = json!({ "name": time, "wave": "=".repeat(columns), "data": labels });
        let lanes = of.signals.iter().zip(lanes).map(|(signal, Lane { wave, data, .. })| {
            let is_bit = signal.kind == SignalKind::Bits && signal.width == 1;
            let mut lane = json!({ "name": signal.name.text, "wave": wave });
            if !is_bit && signal.kind != SignalKind::Event {
                lane["data"] = json!(data);
            }
            lane
        });
        let lanes: Vec<String> = [time].into_iter().chain(lanes).map(|l| l.to_string()).collect();
        let written = writeln!(file, "{{\"signal\": [\n  {}\n]}}", lanes.join(",\n  "));
        written.map_err(|error| file.fault(error))?;
        file.commit()
    }
}
