//! Bubbles: zeros below ones, in the physical order of the taps.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use tofsim::firmware::carry_chain::Delays;

use super::density::CodeDensity;

/// Longest pattern that is shown whole [taps].
const LONGEST: usize = 16;

/// What stands between the first zero and the last one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pattern {
    /// Levels from the first zero to the last one, tap 0's side first; empty without a bubble.
    pub levels: String,
    /// Part of the phases at which it is seen [1].
    pub share: f64,
    /// Numbers of taps that a hit has reached when it is.
    pub counts: usize,
}

/// What the taps look like as an edge samples them. It does not change from hit to hit: who has read a pattern
/// once will read it again at that phase.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bubbles {
    /// Part of the phases at which there is a bubble [1].
    pub share: f64,
    /// Part of the phases by the number of changes from tap to tap, one without a bubble [1].
    #[serde(serialize_with = "listed")]
    pub transitions: BTreeMap<usize, f64>,
    /// Patterns, the most frequent first.
    pub patterns: Vec<Pattern>,
    /// From the first zero to the last one, at most [taps].
    pub longest: usize,
}

/// Serializes the shares as a list of objects.
fn listed<S: Serializer>(transitions: &BTreeMap<usize, f64>, to: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Transitions {
        changes: usize,
        share: f64,
    }
    to.collect_seq(transitions.iter().map(|(&changes, &share)| Transitions { changes, share }))
}

impl Bubbles {
    /// Of a chain, at every phase of a test by the number of taps that a hit has reached.
    pub fn new(delays: &Delays, density: &CodeDensity) -> Self {
        let mut longest = 0;
        let mut transitions = BTreeMap::new();
        let mut found: BTreeMap<String, (f64, usize)> = BTreeMap::new();
        each_phase(delays, density, |levels, _, share| {
            let changes = levels.windows(2).filter(|pair| pair[0] != pair[1]).count();
            *transitions.entry(changes).or_default() += share;
            let pattern = between(levels);
            longest = longest.max(pattern.len());
            let entry = found.entry(shown(pattern)).or_default();
            *entry = (entry.0 + share, entry.1 + 1);
        });
        let clean = found.get("").map_or(0.0, |(share, _)| *share);
        let mut patterns: Vec<_> = found
            .into_iter()
            .map(|(levels, (share, counts))| Pattern { levels, share, counts })
            .collect();
        patterns.sort_by(|a, b| b.share.total_cmp(&a.share));
        let share = if clean == 0.0 { 1.0 } else { (1.0 - clean).max(0.0) };
        Bubbles { share, transitions, patterns, longest }
    }
}

/// Shows the levels of the taps, how many are reached, and the part of the phases at which they are so, of each
/// number of taps that a hit can have reached.
pub(super) fn each_phase(
    delays: &Delays,
    by_ones: &CodeDensity,
    mut see: impl FnMut(&[bool], usize, f64),
) {
    let (mut levels, mut reached) = (vec![false; delays.taps()], 0);
    for bin in by_ones.bins.iter().filter(|bin| bin.true_width_ps > 0.0) {
        let newly = &delays.order()[reached..bin.n];
        newly.iter().for_each(|&tap| levels[usize::from(tap)] = true);
        reached = bin.n;
        see(&levels, reached, bin.true_width_ps / by_ones.period_ps);
    }
}

/// From the first zero to the last one, if that comes later.
pub(super) fn between(levels: &[bool]) -> &[bool] {
    let zero = levels.iter().position(|level| !level);
    let one = levels.iter().rposition(|level| *level);
    match (zero, one) {
        (Some(zero), Some(one)) if zero < one => &levels[zero..=one],
        _ => &[],
    }
}

pub(super) fn shown(levels: &[bool]) -> String {
    let whole = levels.iter().take(LONGEST).map(|level| if *level { '1' } else { '0' });
    let rest = if levels.len() > LONGEST { "..." } else { "" };
    whole.collect::<String>() + rest
}
