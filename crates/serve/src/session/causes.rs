//! The histogram by cause of the avalanches.

use serde::Serialize;

use tofsim::Shot;
use tofsim::optics::Cause;
use tofsim::optics::hazard::BY_CAUSE;
use tofsim::sim::frames::Frame;

use super::instrument::Instrument;

/// Causes in stacking order; `None` is unknown.
const CAUSES: [(Option<Cause>, &str); 6] = [
    (Some(Cause::Dark), Cause::Dark.word()),
    (Some(Cause::Ambient), Cause::Ambient.word()),
    (Some(Cause::Cover), Cause::Cover.word()),
    (Some(Cause::Signal), Cause::Signal.word()),
    (Some(Cause::Afterpulse), Cause::Afterpulse.word()),
    (None, "unknown"),
];

/// Counts of one cause, for each bin.
#[derive(Clone, Debug, Serialize)]
pub struct Layer {
    cause: &'static str,
    counts: Vec<f64>,
}

/// Causes of a frame's hits, as far as they were observed.
#[derive(Clone, Debug)]
pub struct Causes {
    seen: [Vec<u32>; CAUSES.len()],
}

impl Causes {
    /// Creates empty counts of `bins` bins.
    pub fn new(bins: usize) -> Self {
        Causes { seen: std::array::from_fn(|_| vec![0; bins]) }
    }

    /// Counts a shot, if it has a code.
    pub fn add(&mut self, shot: &Shot) {
        let Some(code) = shot.code else { return };
        for ((cause, _), counts) in CAUSES.iter().zip(&mut self.seen) {
            if *cause == shot.cause
                && let Some(count) = counts.get_mut(code as usize)
            {
                *count += 1;
            }
        }
    }

    /// Clears all counts.
    pub fn clear(&mut self) {
        self.seen.iter_mut().for_each(|counts| counts.fill(0));
    }

    /// Returns a frame's histogram by observed cause; hits that were not observed count as unknown.
    pub fn seen(&self, frame: &Frame) -> Vec<Layer> {
        let mut seen = self.seen.clone();
        for (bin, &count) in frame.histogram.iter().enumerate() {
            let known: u32 = seen.iter().map(|counts| counts[bin]).sum();
            seen[CAUSES.len() - 1][bin] += count.saturating_sub(known);
        }
        let layers = CAUSES.iter().zip(seen);
        layers
            .map(|((_, cause), counts)| {
                let counts = counts.into_iter().map(f64::from).collect();
                Layer { cause, counts }
            })
            .filter(Layer::is_any)
            .collect()
    }
}

impl Layer {
    fn is_any(&self) -> bool {
        self.counts.iter().any(|count| *count > 0.0)
    }
}

/// Returns a frame's histogram of hits whose causes nobody knows.
pub fn unknown(frame: &Frame) -> Vec<Layer> {
    let counts = frame.histogram.iter().map(|&count| count.into()).collect();
    vec![Layer { cause: "unknown", counts }]
}

/// Returns a frame's histogram by expected cause.
pub fn expected(instrument: &Instrument, frame: &Frame) -> Vec<Layer> {
    let expected = instrument.expected_causes(frame);
    let of = |cause: Cause| {
        BY_CAUSE
            .iter()
            .zip(&expected)
            .find_map(|(of, counts)| (*of == cause).then(|| counts.clone()))
    };
    let layer = |(cause, name): &(Option<Cause>, &'static str)| {
        Some(Layer { cause: name, counts: of((*cause)?)? })
    };
    let mut layers: Vec<_> = CAUSES.iter().filter_map(layer).collect();
    // Without light there is nothing to expect.
    let is_known = |bin: usize| layers.iter().any(|layer| layer.counts[bin] > 0.0);
    let unknown = frame.histogram.iter().enumerate();
    let unknown =
        unknown.map(|(bin, &count)| if is_known(bin) { 0.0 } else { f64::from(count) }).collect();
    layers.push(Layer { cause: "unknown", counts: unknown });
    layers.retain(Layer::is_any);
    layers
}
