//! A logic analyser's CSV files and archives as sources.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use tofsim::error::Result;

use crate::ila::Radix;
use crate::ila::read::{CaptureForm, CaptureRow, Column, open};

use super::names::Name;
use super::signals::{self, Axis, Signal, SignalKind, Source, SourceFormat, Words};
use super::stream::Cursor;

/// Path and radix of a capture.
#[derive(Clone, Debug)]
struct CaptureOrigin {
    path: PathBuf,
    radix: Option<Radix>,
}

/// Opens the capture at `path`, until `stop` is set.
pub(super) fn source(path: &Path, radix: Option<Radix>, stop: &AtomicBool) -> Result<Source> {
    let opened = open(path, radix, Some(stop))?;
    let format = match opened.form {
        CaptureForm::Csv => SourceFormat::IlaCsv,
        CaptureForm::LegacyCsv => SourceFormat::LegacyIlaCsv,
        CaptureForm::Archive => SourceFormat::Ila,
    };
    let columns = opened.columns.iter().enumerate();
    let signals = columns.map(|(id, column)| signal(column, id)).collect();
    let origin = CaptureOrigin { path: path.to_owned(), radix };
    let source = Source::new(path.display().to_string(), format, Axis::Samples, signals, origin);
    Ok(Source { radix_stated: opened.radix_stated, notes: opened.notes, ..source })
}

fn signal(column: &Column, id: usize) -> Signal {
    let kind = if column.text { SignalKind::Text } else { SignalKind::Bits };
    let (width, mixed, states) = (column.width, column.mixed, column.states.clone().into());
    let words = Words { width, mixed, states };
    let (width, radix, lsb) = (column.bits(), column.radix, i64::from(column.lsb));
    let (name, range) = (Name::new(&column.name), Some([lsb + i64::from(width) - 1, lsb]));
    let range = range.filter(|_| !column.text && width > 1);
    let (scopes, own) = (Arc::default(), column.name.clone());
    let (shape, description) = (None, None);
    Signal { name, scopes, own, width, lsb, range, kind, radix, shape, words, description, id }
}

impl signals::Origin for CaptureOrigin {
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor> {
        let mut opened = open(&self.path, self.radix, None)?;
        let places: Vec<_> = ids.iter().map(|&id| opened.columns[id].place()).collect();
        Ok(Cursor::spawn(widths, move |feed| {
            let (mut row, mut before) = (CaptureRow::default(), CaptureRow::default());
            while opened.rows.next(&mut row)? {
                if feed.at(row.sample).is_err() {
                    return Ok(());
                }
                feed.mark(|marks| {
                    marks.window = row.window_start;
                    marks.trigger = row.trigger;
                    marks.gap = row.gap;
                });
                for (signal, place) in places.iter().enumerate() {
                    let (value, unknown) = (&row.value[place.clone()], &row.unknown[place.clone()]);
                    let same = before.value.get(place.clone()) == Some(value)
                        && before.unknown.get(place.clone()) == Some(unknown);
                    if !same {
                        feed.change(signal, value, unknown);
                    }
                }
                std::mem::swap(&mut row, &mut before);
            }
            Ok(())
        }))
    }
}
