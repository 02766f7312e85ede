//! Simulation speed relative to the board.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Number of frames over which the speed is averaged.
const MEAN_OVER: usize = 32;

/// Time spent on frames.
#[derive(Debug, Default)]
pub struct Clock {
    /// Time spent on simulation alone.
    pub busy: Duration,
    ends: VecDeque<Instant>,
}

impl Clock {
    /// Registers the end of a frame.
    pub fn frame(&mut self) {
        if self.ends.len() == MEAN_OVER {
            self.ends.pop_front();
        }
        self.ends.push_back(Instant::now());
    }

    /// Registers that the run stops, so that the average restarts.
    pub fn stop(&mut self) {
        self.ends.clear();
    }

    /// Returns the recent number of frames per second.
    pub fn frames_per_second(&self) -> Option<f64> {
        let (first, last) = (self.ends.front()?, self.ends.back()?);
        let seconds = last.duration_since(*first).as_secs_f64();
        (seconds > 0.0).then(|| (self.ends.len() - 1) as f64 / seconds)
    }
}
