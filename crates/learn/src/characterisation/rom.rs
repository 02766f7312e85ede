//! The decoder's ROM from the counts of a code-density test.

use serde::Serialize;

use tofsim::error::Input;
use tofsim::firmware::{tdc, tdc_calibration};
use tofsim::{Note, NoteCode};

/// A word of the ROM.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RomEntry {
    /// Decoder's number for the taps.
    pub n: usize,
    /// Hits that had it.
    pub count: u64,
    /// Age of such a hit [ps].
    pub age_ps: f64,
    /// Standard error of that, by the number of hits [ps].
    pub age_se_ps: f64,
    /// The word, as `tdc_calibration` works it out of the same counts [units of the decoder].
    pub units: u64,
}

/// All words, and what they come of.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibratedRom {
    /// By `n`.
    pub entries: Vec<RomEntry>,
    /// Hits in all.
    pub hits: u64,
    /// Largest standard error of an age [ps].
    pub largest_se_ps: f64,
    /// Mean width of the taps from the first to the last that was hit [ps].
    pub lsb_ps: f64,
    /// Period of the clock [ps].
    pub period_ps: f64,
}

impl CalibratedRom {
    /// From hits that are spread evenly over a period, by `n` from 0 on. When a hit reaches tap 0 no count
    /// tells: that is the converter's own.
    ///
    /// # Errors
    /// When there are more counts than the chain has taps.
    pub fn new(source: &str, counts: &[u64], p: &tdc::Params) -> Result<Self, Input> {
        let taps = p.delays.taps();
        let last = counts.iter().rposition(|&count| count > 0).unwrap_or(0);
        if last > taps {
            let expected = format!("expected 0 for more than the {taps} taps of the chain");
            let fault = Input::new(source, expected).field(format!("count of n {last}"));
            return Err(fault.value(counts[last]));
        }
        let first = counts.iter().position(|&count| count > 0).unwrap_or(0);
        let hits: u64 = counts.iter().sum();
        let all = hits.max(1) as f64;
        let (scale, begin_ps) = (&p.decoder.scale, p.delays.tap_0().fs() as f64 * 1e-3);
        let period_ps = scale.period().fs() as f64 * 1e-3;
        let mut before = 0;
        let ages: Vec<_> = (0..=taps)
            .map(|n| {
                let count = counts.get(n).copied().unwrap_or(0);
                // Parts of all hits that come before it, and that have it.
                let (below, own) = (before as f64 / all, count as f64 / all);
                before += count;
                let place = below + own / 2.0;
                let variance = (below + own / 4.0 - place * place).max(0.0) / all;
                (count, begin_ps + period_ps * place, period_ps * variance.sqrt())
            })
            .collect();
        let own: Vec<_> = ages.iter().map(|(count, ..)| *count).collect();
        let words = tdc_calibration::Params::stand_in(p).ages(&own);
        let entries = ages.into_iter().zip(words).enumerate();
        let entries: Vec<_> = entries
            .map(|(n, ((count, age_ps, age_se_ps), word))| RomEntry {
                n,
                count,
                age_ps,
                age_se_ps,
                units: word,
            })
            .collect();
        let largest_se_ps = entries.iter().map(|entry| entry.age_se_ps).fold(0.0, f64::max);
        let lsb_ps = period_ps / (last - first + 1) as f64;
        Ok(CalibratedRom { entries, hits, largest_se_ps, lsb_ps, period_ps })
    }

    /// Hits with which the largest standard error, that in the middle of the period, is a mean tap.
    pub fn enough(&self) -> u64 {
        (self.period_ps / (2.0 * self.lsb_ps)).powi(2).ceil() as u64
    }

    /// Returns the note that the ages are not known to a tap, if they are not.
    pub fn note(&self) -> Option<Note> {
        let text = format!(
            "with so few hits the ages have standard errors up to {:.1} ps, more than a mean tap ({:.1} ps)",
            self.largest_se_ps, self.lsb_ps
        );
        let expected = format!("{} or more", self.enough());
        (self.largest_se_ps > self.lsb_ps)
            .then(|| Note::new(NoteCode::FewHits, "count", self.hits, expected, text))
    }
}
