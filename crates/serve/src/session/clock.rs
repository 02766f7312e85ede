//! What a run takes here, beside what it takes on the board.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Frames over which the speed is a mean.
const MEAN_OVER: usize = 32;

/// Time that is spent on frames.
#[derive(Debug, Default)]
pub struct Clock {
    /// On simulating alone.
    pub busy: Duration,
    ends: VecDeque<Instant>,
}

impl Clock {
    /// A frame has ended.
    pub fn frame(&mut self) {
        if self.ends.len() == MEAN_OVER {
            self.ends.pop_front();
        }
        self.ends.push_back(Instant::now());
    }

    /// The run stands still, so that the frames to come have none before them.
    pub fn stop(&mut self) {
        self.ends.clear();
    }

    /// Frames a second, of the last ones.
    pub fn frames_per_second(&self) -> Option<f64> {
        let (first, last) = (self.ends.front()?, self.ends.back()?);
        let seconds = last.duration_since(*first).as_secs_f64();
        (seconds > 0.0).then(|| (self.ends.len() - 1) as f64 / seconds)
    }
}
