//! A point of the fit, and what each bin says of it.

use std::ops::Range;

use crate::firmware::likelihood_estimator::words::{
    AMBIENT_FRACTION, HAZARD_FRACTION, SIGNAL_FRACTION, UNITS,
};

use super::histogram::Shots;
use super::instrument::Instrument;
use super::number::Number;
use super::terms::{Bin, Terms};

/// Parameters of the scene in a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<N> {
    /// Arrival of the echo [units / 16].
    pub arrival: N,
    /// S [photons a shot, 14 fraction bits].
    pub signal: N,
    /// b [1 / unit, 30 fraction bits].
    pub ambient: N,
    /// Light from the cover glass [photons a shot, 14 fraction bits].
    pub glass: N,
    /// The other echo of a fit of two; without signal, only its bins are fitted.
    pub other: Option<Echo<N>>,
}

/// An echo that a fit holds still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Echo<N> {
    /// Arrival [units / 16].
    pub arrival: N,
    /// S [photons a shot, 14 fraction bits].
    pub signal: N,
}

impl<N: Number> Point<N> {
    /// Returns a point without an echo.
    pub fn dark(ambient: N, glass: N) -> Self {
        Point { arrival: N::default(), signal: N::default(), ambient, glass, other: None }
    }

    /// Computes the terms of each bin of a fit, with its z, followed by all other bins as one.
    pub fn terms(&self, p: &impl Instrument<Number = N>, shots: &Shots<N>) -> Vec<(Terms<N>, N)> {
        let none = N::default();
        let (mut ended, mut exposure) = (shots.all_ended, shots.exposure);
        let ranges = self.fitted(p);
        let mut all = Vec::with_capacity(ranges.iter().map(|range| range.len()).sum::<usize>() + 1);
        for range in ranges {
            for (bin, light) in range.clone().zip(self.light(p, range)) {
                let (count, waiting, width) = (shots.ended(bin), shots.waiting(bin), p.width(bin));
                ended = ended - count;
                exposure = exposure - waiting * width;
                let terms = if p.has(bin) {
                    light.bin(count, waiting).terms(p.words().histogram.count_bits)
                } else {
                    Terms::default()
                };
                all.push((terms, light.z));
            }
        }
        let size = p.words().histogram;
        let waiting =
            exposure.floored(UNITS.ilog2().into()).filled(size.count_bits + size.bins.ilog2());
        let ambient = self.ambient_in(N::whole(UNITS));
        let rest = Light { ambient, ..Light::default() };
        all.push((rest.bin(ended, waiting).terms(size.count_bits), none));
        all
    }

    /// Returns the bins of a fit, in ranges one after the other: those with light of the glass, and those around each
    /// echo.
    pub fn fitted(&self, p: &impl Instrument<Number = N>) -> [Range<usize>; 3] {
        let own = self.window(p);
        let other = self.other.map_or(own.end..own.end, |other| p.window(other.arrival));
        let [first, second] = if other.start < own.start { [other, own] } else { [own, other] };
        let glass = p.words().glass.bins();
        let after = |range: Range<usize>, end: usize| range.start.max(end)..range.end.max(end);
        let first = after(first, glass);
        let end = first.end;
        [0..glass, first, after(second, end)]
    }

    /// Returns the point with the echoes in each other's place.
    pub fn swapped(self) -> Self {
        let Point { arrival, signal, other, .. } = self;
        match other {
            Some(now) => Point {
                arrival: now.arrival,
                signal: now.signal,
                other: Some(Echo { arrival, signal }),
                ..self
            },
            None => self,
        }
    }

    /// Returns the bins of the fit; none without an echo.
    fn window(&self, p: &impl Instrument<Number = N>) -> Range<usize> {
        if self.signal > N::default() { p.window(self.arrival) } else { 0..0 }
    }

    /// Returns the hazards of consecutive bins.
    pub fn light<I: Instrument<Number = N>>(
        &self,
        p: &I,
        bins: Range<usize>,
    ) -> impl Iterator<Item = Light<N>> {
        let none = [N::default(); 3];
        let is_lit = self.signal > N::default();
        let has_glass = p.has_glass();
        let other = self.other.filter(|other| other.signal > N::default());
        let mut other_part = match other {
            Some(other) if bins.start > 0 => p.pulse(bins.start, other.arrival)[0],
            _ => N::default(),
        };
        let [mut part, mut slope, _] =
            if is_lit && bins.start > 0 { p.pulse(bins.start, self.arrival) } else { none };
        bins.map(move |bin| {
            let mut light = Light { ambient: self.ambient_in(p.width(bin)), ..Light::default() };
            if has_glass {
                light.glass = photons(self.glass, p.glass(bin));
            }
            if is_lit {
                let [next, next_slope, first] = p.pulse(bin + 1, self.arrival);
                light.signal = photons(self.signal, next - part);
                light.z = if bin == 0 { first } else { (slope + next_slope).floored(1) };
                (part, slope) = (next, next_slope);
            }
            if let Some(other) = other {
                let [next, ..] = p.pulse(bin + 1, other.arrival);
                light.other = photons(other.signal, next - other_part);
                other_part = next;
            }
            light
        })
    }

    /// Hazard of ambient light in a bin of some width.
    fn ambient_in(&self, width: N) -> N {
        (self.ambient * width).shifted(i64::from(AMBIENT_FRACTION - HAZARD_FRACTION))
    }
}

/// Hazard of a part of the light of a pulse.
fn photons<N: Number>(level: N, part: N) -> N {
    (level * part).shifted(i64::from(17 + SIGNAL_FRACTION - HAZARD_FRACTION))
}

/// Hazards of a bin, and its z.
#[derive(Clone, Copy, Debug, Default)]
pub struct Light<N> {
    signal: N,
    ambient: N,
    glass: N,
    other: N,
    z: N,
}

impl<N: Number> Light<N> {
    /// Returns a bin with this light.
    pub fn bin(&self, ended: N, waiting: N) -> Bin<N> {
        let Light { signal, ambient, glass, other, .. } = *self;
        Bin { ended, waiting, signal, ambient, glass, other }
    }
}
