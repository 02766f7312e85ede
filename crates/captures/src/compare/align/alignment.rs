//! Methods of alignment, and their result.

use std::str::FromStr;

use tofsim::kernel::Time;

use super::super::samples::time;
use super::super::selection::Piece;

/// Method of alignment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Align {
    /// Align the first samples; waveforms by time.
    Start,
    /// Align the samples that triggered.
    Trigger,
    /// Align the first edges of a signal.
    Edge(String),
    /// Align for best agreement of the given signals, or of all.
    Correlation(Vec<String>),
    /// Align each window separately for best agreement of the given signals, or of all.
    Windows(Vec<String>),
    /// Delay the second side by a number of samples.
    Offset(i64),
    /// Shift the second side by a time.
    Shift {
        /// Magnitude of the shift.
        by: Time,
        /// Whether the second side is early rather than late.
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

/// Pairs of samples: pieces of both sides, sample by sample.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Alignment {
    /// Pieces of each side.
    pub(crate) pieces: [Vec<Piece>; 2],
    /// Description of how they were found.
    pub(crate) found: String,
    /// Delay of the second side, if it is constant [samples].
    pub(crate) offset: Option<i64>,
    /// Differences found during alignment.
    pub(crate) differences: Vec<String>,
    /// Possible reasons for differences of the samples.
    pub(crate) doubts: Vec<String>,
}

impl Alignment {
    /// Creates an alignment of one piece per side, the second `offset` samples later.
    pub(super) fn shifted(offset: i64, found: String) -> Alignment {
        let a = Piece::Run(offset.min(0).unsigned_abs(), None);
        let b = Piece::Run(offset.max(0).unsigned_abs(), None);
        let pieces = [vec![a], vec![b]];
        Alignment { pieces, found, offset: Some(offset), ..Alignment::default() }
    }
}
