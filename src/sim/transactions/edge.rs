//! An edge of `clk_sys`, as the parts of the recorder see it.

use std::collections::VecDeque;

use crate::firmware::tof_top::{Params, TofTop};
use crate::kernel::Time;
use crate::sim::shot_recorder::{OPEN, between};
use crate::sim::tdc_hits::may_be_of;

use super::{Origin, Stream};

/// The registers after an edge.
pub(super) struct EdgeState<'a> {
    /// Number of the edge.
    pub(super) cycle: u64,
    /// Its instant.
    pub(super) now: Time,
    /// Instant of the edge before.
    pub(super) before: Time,
    /// Instant of the next one.
    pub(super) next: Time,
    /// Frame under way.
    pub(super) frame: u64,
    pub(super) top: &'a TofTop,
    pub(super) p: &'a Params,
}

/// Numbers of transactions.
#[derive(Clone, Debug, Default)]
pub(super) struct Numbers(u64);

impl Numbers {
    /// Returns the next number.
    pub(super) fn next(&mut self) -> u64 {
        self.0 += 1;
        self.0
    }
}

/// A shot that transactions may belong to.
#[derive(Clone, Copy, Debug)]
pub(super) struct BegunShot {
    pub(super) id: u64,
    /// Shot in the frame.
    pub(super) shot: u64,
    /// Laser edge.
    pub(super) begin: Time,
    /// Cycle of `start`.
    pub(super) cycle: u64,
}

impl BegunShot {
    /// Returns the shot as the origin of another transaction.
    pub(super) fn as_origin(&self) -> Origin {
        Origin { stream: Stream::Shot, id: self.id }
    }

    /// Returns the time of an instant from the laser edge [fs].
    pub(super) fn time_fs(&self, at: Time) -> i64 {
        between(self.begin, at)
    }
}

/// The last shots of the frame.
#[derive(Clone, Debug, Default)]
pub(super) struct BegunShots {
    /// Oldest first.
    shots: VecDeque<BegunShot>,
    /// Shots begun in the frame.
    count: u64,
}

impl BegunShots {
    /// Adds a shot and returns it.
    pub(super) fn begin(&mut self, id: u64, edge: &EdgeState) -> BegunShot {
        let shot = BegunShot { id, shot: self.count, begin: edge.now, cycle: edge.cycle };
        self.count += 1;
        self.shots.push_back(shot);
        if self.shots.len() > OPEN {
            self.shots.pop_front();
        }
        shot
    }

    /// Returns the shot under way.
    pub(super) fn last(&self) -> Option<&BegunShot> {
        self.shots.back()
    }

    /// Returns the shot of a hit that is latched in a cycle.
    pub(super) fn of_hit(&self, latched: u64) -> Option<&BegunShot> {
        self.shots.iter().rfind(|shot| may_be_of(shot.cycle, latched))
    }
}
