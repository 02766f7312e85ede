//! Photons and the detector, for the bench's design.

use tofsim::sim::photons::{Photons, Shown};

use crate::arguments::{BenchTime, setup};

pub struct Source {
    photons: Photons,
    time: BenchTime,
}

impl Source {
    pub fn new(scenario: &str) -> Result<Self, String> {
        Ok(Source { photons: Photons::new(&*setup(scenario)?), time: BenchTime::default() })
    }

    pub fn edge(&mut self, time_fs: i64, shown: Shown) -> Result<(), String> {
        self.photons.edge(self.time.at(time_fs)?, shown);
        Ok(())
    }

    /// Returns the next change of `tdc_stop` that precedes the coming edge or coincides with it [fs], or -1.
    pub fn next_change(&mut self) -> i64 {
        self.photons.next_change().map_or(-1, |time| time.fs() as i64)
    }

    pub fn level(&self) -> bool {
        self.photons.level()
    }
}
