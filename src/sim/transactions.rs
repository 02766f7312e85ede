//! Transactions: what a run does from one instant to another, from the laser edge to the depth.
//!
//! A shot contains photons; a photon becomes a hit, a hit a code, a code a count, and counts an estimation. Each names
//! the transaction that it comes from, so that a photon can be followed from its arrival to its bin. Instants are those
//! of the waveform's edges.

use crate::kernel::Time;
use crate::optics::hazard::Cause;

use super::estimates::Estimate;

mod conversions;
mod counts;
mod edge;
mod photons;
pub(super) mod recorder;

/// A stream of transactions of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stream {
    /// From the laser edge until the TDC's window closes, or the next laser edge if that comes first.
    Shot,
    /// From an avalanche of the SPAD until `tdc_stop` falls.
    Photon,
    /// From the avalanche to the edge at which `tdc_latch.hit` rises.
    Hit,
    /// The cycle of `tdc_valid`.
    Code,
    /// From the edge that ends `tdc_valid` to the one that writes the histogram's word.
    Count,
    /// From the edge that takes `algo_start` to the one at which `algo_done` rises.
    Estimation,
}

impl Stream {
    /// Every stream, in the order of the way from the laser to the depth.
    pub const ALL: [Stream; 6] = [
        Stream::Shot,
        Stream::Photon,
        Stream::Hit,
        Stream::Code,
        Stream::Count,
        Stream::Estimation,
    ];

    /// Returns its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Stream::Shot => "shot",
            Stream::Photon => "photon",
            Stream::Hit => "hit",
            Stream::Code => "code",
            Stream::Count => "count",
            Stream::Estimation => "estimation",
        }
    }
}

/// A transaction and its stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Its stream.
    pub stream: Stream,
    /// Its number.
    pub id: u64,
}

/// A transaction that has ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Transaction {
    /// Number in the run, from 1, in the order in which transactions begin to be known.
    pub id: u64,
    /// Begin.
    pub begin: Time,
    /// End.
    pub end: Time,
    /// Frame, from 0.
    pub frame: u64,
    /// Shot in the frame, from 0; none outside of all shots.
    pub shot: Option<u64>,
    /// The transaction that this one comes from; of an estimation, the first of its counts.
    pub origin: Option<Origin>,
    /// What is known of it.
    pub content: Content,
}

impl Transaction {
    /// Returns its stream.
    pub fn stream(&self) -> Stream {
        match self.content {
            Content::Shot { .. } => Stream::Shot,
            Content::Photon { .. } => Stream::Photon,
            Content::Hit { .. } => Stream::Hit,
            Content::Code { .. } => Stream::Code,
            Content::Count { .. } => Stream::Count,
            Content::Estimation(_) => Stream::Estimation,
        }
    }

    /// Returns the transaction as the origin of another.
    pub fn as_origin(&self) -> Origin {
        Origin { stream: self.stream(), id: self.id }
    }

    /// Returns every transaction that this one comes from.
    pub fn origins(&self) -> impl Iterator<Item = Origin> {
        let counts = match &self.content {
            Content::Estimation(estimation) => &estimation.counts[..],
            _ => &[],
        };
        let counts = counts.iter().map(|&id| Origin { stream: Stream::Count, id });
        self.origin
            .filter(|_| !matches!(self.content, Content::Estimation(_)))
            .into_iter()
            .chain(counts)
    }
}

/// What is known of a transaction beside its time.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// A shot.
    Shot {
        /// `laser_en` as the driver took it.
        laser_en: bool,
    },
    /// An avalanche.
    Photon {
        /// Its cause; unknown for given photons.
        cause: Option<Cause>,
        /// Time from the laser edge of its shot [fs].
        arrival_fs: Option<i64>,
    },
    /// A hit that the TDC kept.
    Hit {
        /// Ones count of the taps; none if a reset comes before it.
        n: Option<u64>,
        /// Coarse count.
        coarse: Option<u64>,
    },
    /// A code.
    Code {
        /// TDC code.
        code: u64,
        /// Begin of its bin, from the laser edge.
        time: Time,
    },
    /// A count in the histogram.
    Count {
        /// Word of the histogram.
        bin: u64,
        /// The word before [hits].
        before: u64,
        /// The word after [hits].
        after: u64,
    },
    /// An estimation.
    Estimation(Box<Estimation>),
}

/// What is known of an estimation.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimation {
    /// Depth, sigma and status.
    pub estimate: Estimate,
    /// Hits in its histogram.
    pub hits: u64,
    /// Numbers of the counts in its histogram, in order; empty for a preloaded one.
    pub counts: Vec<u64>,
}
