//! Timings in rounds, one of each contender per round, so that all see the same machine load.

use std::time::Instant;

use crate::contender::{Contender, Context, Work};
use crate::{Result, ours};

/// Smallest number of rounds, even if time is short.
const FEWEST: usize = 2;

/// Number of rounds, and time limit.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Number of rounds.
    pub rounds: usize,
    /// Number of rounds for contenders that take seconds.
    pub slow_rounds: usize,
    /// Time after which no round begins.
    pub until: Option<Instant>,
}

/// Timings of a contender.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Peer; `None` for tofsim.
    pub peer: Option<Contender>,
    /// Kind of work.
    pub work: Work,
    /// Timings, sorted [ms].
    times: Vec<f64>,
    /// Number of frames per timing.
    frames: u64,
}

impl Measured {
    fn ours(work: Work, context: &Context) -> Result<Self> {
        let frames = ours::frames(work, &context.setup, &context.folder)?;
        Ok(Measured { peer: None, work, times: Vec::new(), frames })
    }

    fn of(peer: &Contender) -> Self {
        let (work, frames) = (peer.work, peer.frames);
        Measured { peer: Some(peer.clone()), work, times: Vec::new(), frames }
    }

    fn time(&mut self, context: &Context) -> Result<()> {
        self.times.push(match &self.peer {
            Some(peer) => peer.time(context)?,
            None => ours::time(self.work, &context.setup, self.frames, &context.folder)?,
        });
        Ok(())
    }

    fn is_slow(&self) -> bool {
        self.peer.as_ref().is_some_and(|peer| peer.is_slow)
    }

    /// Returns the name of the contender.
    pub fn name(&self) -> String {
        self.peer.as_ref().map_or_else(|| "tofsim".into(), Contender::to_string)
    }

    /// Returns the median [ms].
    pub fn median(&self) -> f64 {
        let (half, last) = (self.times.len() / 2, self.times.len().saturating_sub(1));
        (self.at(half) + self.at(last - last.min(half))) / 2.0
    }

    /// Returns the shortest timing [ms].
    pub fn min(&self) -> f64 {
        self.at(0)
    }

    /// Returns the longest timing [ms].
    pub fn max(&self) -> f64 {
        self.at(self.times.len().saturating_sub(1))
    }

    fn at(&self, index: usize) -> f64 {
        self.times.get(index).copied().unwrap_or(f64::NAN)
    }

    /// Returns the number of timings.
    pub fn count(&self) -> usize {
        self.times.len()
    }
}

/// Times tofsim and its peers.
pub fn run(peers: &[Contender], context: &Context, plan: &Plan) -> Result<Vec<Measured>> {
    let ours = Work::ALL.into_iter().map(|work| Measured::ours(work, context));
    let mut all: Vec<_> = ours.collect::<Result<_>>()?;
    all.extend(peers.iter().map(Measured::of));
    for round in 0..plan.rounds {
        if round >= FEWEST && plan.until.is_some_and(|until| Instant::now() > until) {
            break;
        }
        eprintln!(
            "peers: laser_freq {}, round {} of {}",
            context.laser_freq,
            round + 1,
            plan.rounds
        );
        for measured in &mut all {
            if round < plan.slow_rounds || !measured.is_slow() {
                measured.time(context)?;
            }
        }
    }
    all.iter_mut().for_each(|measured| measured.times.sort_by(f64::total_cmp));
    Ok(all)
}
