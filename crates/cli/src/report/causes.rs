//! The histogram's counts by what set the avalanche off.

use tofsim::firmware::histogram_builder::BINS;
use tofsim::optics::hazard::Cause;
use tofsim::sim::shot_recorder::Shot;

/// Counts of each bin for each cause of [`CAUSES`] [hits].
#[derive(Clone, Debug)]
pub struct Causes {
    counts: Vec<[u32; BINS]>,
}

/// Causes in the order in which they are stacked; `None` is unknown.
pub const CAUSES: [Option<Cause>; 4] =
    [Some(Cause::Dark), Some(Cause::Ambient), Some(Cause::Signal), None];

impl Default for Causes {
    fn default() -> Self {
        Causes { counts: vec![[0; BINS]; CAUSES.len()] }
    }
}

impl Causes {
    /// Counts a shot, if it has a code.
    pub fn add(&mut self, shot: &Shot) {
        let cause = CAUSES.iter().position(|cause| *cause == shot.cause);
        if let (Some(cause), Some(code)) = (cause, shot.code) {
            self.counts[cause][code as usize] += 1;
        }
    }

    /// Whether nothing has been counted.
    pub fn is_empty(&self) -> bool {
        CAUSES.iter().all(|&cause| self.total(cause) == 0)
    }

    /// Adds a whole histogram whose hits have no known cause.
    pub fn add_unknown(&mut self, histogram: &[u16; BINS]) {
        let counts = &mut self.counts[CAUSES.len() - 1];
        counts.iter_mut().zip(histogram).for_each(|(sum, &count)| *sum += count as u32);
    }

    /// Counts of a cause.
    pub fn of(&self, cause: Option<Cause>) -> &[u32; BINS] {
        let place = CAUSES.iter().position(|known| *known == cause);
        &self.counts[place.unwrap_or(CAUSES.len() - 1)]
    }

    /// Hits of a cause over all bins.
    pub fn total(&self, cause: Option<Cause>) -> u64 {
        self.of(cause).iter().map(|&count| count as u64).sum()
    }
}

/// The word for a cause in files and plots.
pub fn name(cause: Option<Cause>) -> &'static str {
    match cause {
        Some(Cause::Signal) => "signal",
        Some(Cause::Ambient) => "ambient",
        Some(Cause::Dark) => "dark",
        None => "hits",
    }
}
