//! WaveJSON, the timing diagrams of WaveDrom, with a column for each instant.

use std::io::{self, Error, ErrorKind, Write};
use std::path::Path;

use serde_json::json;

use tofsim::error::Result;
use tofsim::files::output::OutputFile;
use tofsim::waves::dump::{Dump, DumpValue};

use crate::source::SignalKind;

use super::columns::Columns;
use super::values::level;

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
}

impl WaveJson {
    pub(super) fn create(path: &Path, columns: Columns) -> Result<WaveJson> {
        let file = OutputFile::create(path)?;
        let (events, lanes) = (columns.events(), vec![Lane::default(); columns.signals.len()]);
        Ok(WaveJson { file, columns, events, times: Vec::new(), lanes })
    }

    /// Puts a brick into the present column of a lane, in place of what it has there.
    fn put(&mut self, lane: usize, brick: char, data: Option<String>) {
        let Lane { wave, data: labels } = &mut self.lanes[lane];
        // What has not changed since the first column is unknown.
        while wave.len() + 1 < self.times.len() {
            wave.push(if wave.is_empty() { 'x' } else { '.' });
        }
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
                "expected {MOST} instants at most in WaveJSON; --after and --until choose a part"
            );
            return Err(Error::new(ErrorKind::InvalidInput, expected));
        }
        self.times.push(at);
        self.end_events();
        Ok(())
    }

    fn change(&mut self, id: usize, value: DumpValue<'_>) -> io::Result<()> {
        let width = self.columns.signals[id].width;
        let all = |value: &[u64], unknown: &[u64], digit: char| {
            (0..width).all(|place| level(value, unknown, place) == digit)
        };
        let brick = match value {
            DumpValue::Event => '1',
            DumpValue::Bits { value, unknown } if width == 1 => level(value, unknown, 0),
            DumpValue::Bits { value, unknown } if all(value, unknown, 'x') => 'x',
            DumpValue::Bits { value, unknown } if all(value, unknown, 'z') => 'z',
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
            while lane.wave.len() < columns {
                lane.wave.push(if lane.wave.is_empty() { 'x' } else { '.' });
            }
        }
        let WaveJson { mut file, columns: of, times, lanes, .. } = *self;
        let time = of.unit.map_or("sample".to_owned(), |unit| format!("time [{unit}]"));
        let labels: Vec<String> = times.iter().map(|&at| of.time(at).to_string()).collect();
        let time = json!({ "name": time, "wave": "=".repeat(columns), "data": labels });
        let lanes = of.signals.iter().zip(lanes).map(|(signal, Lane { wave, data })| {
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
