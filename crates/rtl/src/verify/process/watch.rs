//! Watches a program that runs, and says when to give up.

use std::time::{Duration, Instant};

use super::limits::{End, LONGEST, Limits, Overrun, SHARE};
use super::processor_time;

/// Most processors that a program is taken to use at once, for the time to the next look at what it has used.
const PROCESSORS: u32 = 4;

/// A program under way.
pub struct Watch<'a> {
    limits: &'a Limits<'a>,
    begin: Instant,
    /// When its processor time may be up at the earliest.
    look: Instant,
    /// Output that it has written, and when it last wrote, by the clock and in processor time.
    written: (u64, Instant, Duration),
}

impl<'a> Watch<'a> {
    /// Begins with a program that has just been started.
    pub fn new(limits: &'a Limits<'a>) -> Self {
        let begin = Instant::now();
        let written = (0, begin, Duration::ZERO);
        Watch { limits, begin, look: begin + limits.time / PROCESSORS, written }
    }

    /// Returns why to end the leader of a group of processes, if there is a reason.
    pub fn look(&mut self, leader: u32, length: u64) -> Option<End> {
        let out_of_time = self.out_of_time(leader).map(End::OutOfTime);
        let silence = || self.silence(leader, length).map(End::Stalled);
        out_of_time.or_else(silence).or((length > LONGEST).then_some(End::Wild))
    }

    fn out_of_time(&mut self, leader: u32) -> Option<Overrun> {
        let (limit, now) = (self.limits.time, Instant::now());
        let by_clock = now - self.begin;
        if by_clock > limit * SHARE {
            return Some(Overrun::Clock(limit * SHARE));
        }
        if now < self.look {
            return None;
        }
        let used = processor_time::of_group(leader).unwrap_or(by_clock);
        self.look = now + limit.saturating_sub(used) / PROCESSORS;
        (used > limit).then_some(Overrun::Processor(limit))
    }

    /// Returns for how long it may write nothing, if it has written nothing for longer.
    fn silence(&mut self, leader: u32, length: u64) -> Option<Duration> {
        let limit = self.limits.silence?;
        let used = || processor_time::of_process(leader);
        if length != self.written.0 {
            self.written = (length, Instant::now(), used().unwrap_or_default());
        }
        let (_, spoke, before) = self.written;
        let silent = spoke.elapsed();
        let works = || used().is_none_or(|used| used.saturating_sub(before) > limit);
        (silent > limit * SHARE || silent > limit && works()).then_some(limit)
    }
}
