//! Histograms of each kind: drawn from scenes, extreme ones, and others with a few hits more or less.

use tofsim::firmware::likelihood_estimator::words::BLOCKS;
use tofsim::optics::{BinProbabilities, Budget, Hazard};

use crate::golden::draw::Draw;

use super::Estimations;
use super::kinds::*;

/// Changes that make an even histogram uneven.
const SHAKES: u64 = 300;
/// Kinds of extreme histograms.
const EXTREMES: u64 = 8;

impl Estimations<'_> {
    /// Draws a histogram of some kind.
    pub(super) fn histogram(&self, kind: u64, draw: &mut Draw) -> Vec<u32> {
        match kind {
            EXTREME => self.extreme(draw),
            USED_UP | WAITS => self.used_up(14, draw),
            CERTAIN => {
                (0..SHAKES).fold(self.used_up(6, draw), |counts, _| Self::moved(&counts, draw))
            }
            DARK => self.dark(self.params.least_left() - self.begun % 2),
            kind => self.drawn(kind, draw),
        }
    }

    /// A histogram of a scene: an ordinary one, a faint echo, one at either end of the window, or two, of which one is
    /// faint; or a bin of the fit has too many hits.
    fn drawn(&self, kind: u64, draw: &mut Draw) -> Vec<u32> {
        let part = |draw: &mut Draw| draw.below(1000) as f64 / 1000.0;
        let place = match kind {
            AT_END | RISING => 0.99 + 0.06 * part(draw),
            AT_BEGIN => 0.002 + 0.009 * part(draw),
            // Late light is not to come after the window.
            LEAST => 0.85 + 0.1 * part(draw) - self.setup.scenario.laser.delay_ps / self.end_ps(),
            _ => 0.2 + 0.7 * part(draw),
        };
        // What comes back falls with the square of the distance.
        let faint = |place: f64, level: f64, draw: &mut Draw| {
            place * place * level * (1.0 + 0.5 * part(draw))
        };
        let ordinary = 0.03 + 0.9 * part(draw);
        let mut counts = match kind {
            FAINT => self.scene(place, faint(place, 0.0016, draw), 0.3, draw),
            LEAST => self.scene(place, faint(place, 0.0026, draw), 0.55, draw),
            SURE => self.scene(place, faint(place, 0.0016, draw), 0.3, draw),
            TWO | ODD | ANOTHER => self.scene(place, faint(place, 0.02, draw), 0.3, draw),
            AT_BEGIN => self.scene(place, faint(place, 0.2, draw), part(draw), draw),
            _ => self.scene(place, ordinary, part(draw), draw),
        };
        if kind == ODD {
            let peak = (0..counts.len()).max_by_key(|bin| counts[*bin]).unwrap_or(0);
            let odd = (peak + 8).min(counts.len() - 1);
            counts[odd] += counts[odd] / 4 + 100;
        }
        // With two dark blocks the scan expects more ambient light than the fit finds: only the score is low.
        if kind == LEAST {
            let block = counts.len() / BLOCKS;
            counts[block..3 * block].fill(0);
        }
        let other = match kind {
            TWO | ANOTHER => self.scene(1.1 - place, faint(1.1 - place, 0.005, draw), 0.3, draw),
            FALLING => self.scene(1.1 - place, faint(1.1 - place, 0.004, draw), 0.1, draw),
            _ => return counts,
        };
        counts.iter_mut().zip(other).for_each(|(count, other)| *count = (*count + other) / 2);
        counts
    }

    /// End of the window [ps].
    fn end_ps(&self) -> f64 {
        let bins = *self.params.edges.last().unwrap_or(&0) as f64 / 128.0;
        bins * self.setup.scenario.tdc.bin_ps
    }

    /// A histogram of a target at a part of the window.
    pub(super) fn scene(
        &self,
        place: f64,
        reflectance: f64,
        irradiance: f64,
        draw: &mut Draw,
    ) -> Vec<u32> {
        let mut scenario = self.setup.scenario.clone();
        scenario.target.distance_m = self.end_ps() * 1.5e-4 * place;
        scenario.target.reflectance = reflectance;
        scenario.ambient.irradiance_w_m2_nm = irradiance;
        let (pulse, mesh) = (self.setup.budget.pulse.clone(), self.setup.mesh.as_deref());
        let budget = Budget::of_scene(&scenario, pulse, mesh);
        let hazard = Hazard::new(&budget.with_dark_rates(&self.setup.dark));
        let chances = BinProbabilities::new(&hazard, &self.setup.bins());
        let counts = chances.draw(self.params.shots, draw.rng());
        let counts = counts.into_iter().map(|count| count as u32).collect();
        if self.params.glass.bins() > 0 { self.behind_glass(counts) } else { counts }
    }

    /// What is left of a histogram behind a cover glass, whose light ends shots first; without fluctuations.
    fn behind_glass(&self, counts: Vec<u32>) -> Vec<u32> {
        let glass = &self.params.glass;
        let light = self.pedestal * glass.light as f64 / 16_384.0 / 131_072.0;
        let (mut waiting, mut left) = (self.params.shots as f64, 1.0);
        let behind = |(bin, count): (usize, u32)| {
            let hazard = light * glass.part(bin) as f64;
            let passed = 1.0 - hazard + 0.5 * hazard * hazard;
            let hits = left * (waiting * (1.0 - passed) + f64::from(count) * passed);
            (waiting, left) = (waiting - f64::from(count), left * passed);
            hits.round() as u32
        };
        counts.into_iter().enumerate().map(behind).collect()
    }

    /// Ambient light, of so many photons a shot over the window, that leaves few shots for the echo, which takes them
    /// all.
    fn used_up(&self, ambient: u32, draw: &mut Draw) -> Vec<u32> {
        let bins = self.params.histogram.bins as u64;
        let echo = bins / 2 + draw.below(bins / 3);
        let mut left = self.params.shots as u32;
        let count = |bin: u64| {
            let now = if bin == echo { left } else { (left * ambient + 128) / bins as u32 };
            left -= now.min(left);
            now
        };
        (0..bins).map(count).collect()
    }

    /// Ambient light without fluctuations that leaves so many shots at the end of the window.
    fn dark(&self, left: u64) -> Vec<u32> {
        let (shots, edges) = (self.params.shots as f64, &self.params.edges);
        let (begin, end) = (f64::from(edges[0]), f64::from(edges[edges.len() - 1]));
        let waiting = |edge: &u32| {
            let part = (f64::from(*edge) - begin) / (end - begin);
            (shots * (left as f64 / shots).powf(part)).round() as u32
        };
        edges.windows(2).map(|bin| waiting(&bin[0]) - waiting(&bin[1])).collect()
    }

    fn extreme(&self, draw: &mut Draw) -> Vec<u32> {
        let most = self.params.histogram.most_hits();
        let bins = self.params.histogram.bins as u64;
        let full = draw.below(bins);
        let count = |kind: u64, bin: u64, random: u64| match kind {
            0 => 0,
            1 => most,
            2 if bin == 0 => most,
            3 if bin == full => most,
            4 if bin.is_multiple_of(2) => most / 2,
            5 if bin < full => most / bins,
            6 => random & most,
            7 => random % (most / bins + 1),
            _ => 0,
        };
        let kind = self.begun % EXTREMES;
        (0..bins).map(|bin| count(kind, bin, draw.bits()) as u32).collect()
    }

    /// Adds or takes away hits: one in a bin around that one, for a large change of its box's score, or a few in any,
    /// for a small one; one to four times.
    pub(super) fn nudged(&self, histogram: &[u32], around: u64, draw: &mut Draw) -> Vec<u32> {
        let size = &self.params.histogram;
        let (mut counts, bins, most) =
            (histogram.to_vec(), size.bins as u64, size.most_hits() as u32);
        for _ in 0..=draw.below(4) {
            let near = (around + draw.below(17)).saturating_sub(8).min(bins - 1);
            let (bin, hits) =
                if draw.one_in(2) { (near, 1) } else { (draw.below(bins), draw.below(8) as u32) };
            let count = &mut counts[bin as usize];
            *count =
                if draw.one_in(2) { (*count + hits).min(most) } else { count.saturating_sub(hits) };
        }
        counts
    }

    /// Moves hits between the last bin that has some, which takes all shots that are left, and one before it.
    pub(super) fn moved(histogram: &[u32], draw: &mut Draw) -> Vec<u32> {
        let mut counts = histogram.to_vec();
        let last = counts.iter().rposition(|&count| count > 0).unwrap_or(0);
        let bin = draw.below(last.max(1) as u64) as usize;
        let [from, to] = if draw.one_in(2) { [last, bin] } else { [bin, last] };
        let hits = counts[from].min(1 + draw.below(4) as u32);
        counts[from] -= hits;
        counts[to] += hits;
        counts
    }
}
