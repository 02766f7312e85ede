//! How the sides of a comparison are brought together, and what came of it.

use std::str::FromStr;

use tofsim::kernel::Time;

use super::super::samples::time;
use super::super::selection::Piece;

/// How the sides are brought together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Align {
    /// The first samples belong together; of waveforms those of the same time.
    Start,
    /// The samples that triggered belong together.
    Trigger,
    /// The first edges of a signal belong together.
    Edge(String),
    /// Where the sides agree best in those signals, or in all.
    Correlation(Vec<String>),
    /// The same for each window alone.
    Windows(Vec<String>),
    /// The second side is so many samples late.
    Offset(i64),
    /// The second side is that much late.
    Shift {
        /// How much.
        by: Time,
        /// It is early instead.
        early: bool,
    },
}

impl FromStr for Align {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let (word, rest) = text.split_once([' ', ':']).unwrap_or((text, ""));
        let rest = rest.trim();
        let list = || rest.split(',').map(|name| name.trim().to_owned()).collect::<Vec<_>>();
        let names = || if rest.is_empty() { Vec::new() } else { list() };
        match word {
            "start" if rest.is_empty() => Ok(Align::Start),
            "trigger" if rest.is_empty() => Ok(Align::Trigger),
            "edge" if !rest.is_empty() => Ok(Align::Edge(rest.to_owned())),
            "correlation" => Ok(Align::Correlation(names())),
            "windows" => Ok(Align::Windows(names())),
            "offset" => {
                if let Ok(samples) = rest.parse() {
                    return Ok(Align::Offset(samples));
                }
                let (early, size) = match rest.strip_prefix('-') {
                    Some(size) => (true, size),
                    None => (false, rest),
                };
                let by = time(size).ok_or("expected samples or a time, as `offset 8ns`")?;
                Ok(Align::Shift { by, early })
            }
            _ => Err("expected start, trigger, edge SIGNAL, correlation, windows, offset N or \
                offset 8ns"
                .to_owned()),
        }
    }
}

/// Samples that belong together: piece by piece, one by one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Alignment {
    /// The pieces of each side.
    pub(crate) pieces: [Vec<Piece>; 2],
    /// How they were found.
    pub(crate) found: String,
    /// Samples that the second side is later, if it is one number.
    pub(crate) offset: Option<i64>,
    /// What is different already.
    pub(crate) differences: Vec<String>,
    /// What may be the reason where the samples differ.
    pub(crate) doubts: Vec<String>,
}

impl Alignment {
    /// One piece on each side, the second `offset` samples later.
    pub(super) fn shifted(offset: i64, found: String) -> Alignment {
        let a = Piece::Run(offset.min(0).unsigned_abs(), None);
        let b = Piece::Run(offset.max(0).unsigned_abs(), None);
        let pieces = [vec![a], vec![b]];
        Alignment { pieces, found, offset: Some(offset), ..Alignment::default() }
    }
}
