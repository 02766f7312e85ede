//! Avalanches: from the SPAD until `tdc_stop` falls.

use crate::firmware::carry_chain::Transitions;
use crate::kernel::Time;
use crate::optics::hazard::Cause;
use crate::sim::tdc_hits::{ComingAvalanches, LastAvalanches};

use super::edge::{BegunShot, Numbers};
use super::{Content, Transaction};

/// Follows avalanches.
#[derive(Clone, Debug, Default)]
pub(super) struct Photons {
    /// Avalanches that no edge has passed yet.
    pub(super) coming: ComingAvalanches,
    /// Photons while `tdc_stop` is high.
    going: Vec<Transaction>,
    /// Number of each of the last photons.
    pub(super) avalanches: LastAvalanches<u64>,
    /// The last transition of `tdc_stop` that has been looked at.
    last_transition: Time,
}

impl Photons {
    /// Begins a photon, in `frame` and the shot under way.
    pub(super) fn begin(
        &mut self,
        (at, cause): (Time, Option<Cause>),
        frame: u64,
        shot: Option<&BegunShot>,
        numbers: &mut Numbers,
    ) {
        let id = numbers.next();
        self.avalanches.push(at, id);
        let arrival_fs = shot.map(|shot| shot.time_fs(at));
        self.going.push(Transaction {
            id,
            begin: at,
            end: at,
            frame,
            shot: shot.map(|shot| shot.shot),
            origin: shot.map(BegunShot::as_origin),
            content: Content::Photon { cause, arrival_fs },
        });
    }

    /// Ends photons where `tdc_stop` has fallen by `now`; its level is `stop` after the last transition.
    pub(super) fn end(
        &mut self,
        now: Time,
        (transitions, stop): (&Transitions, bool),
        complete: &mut Vec<Transaction>,
    ) {
        if self.going.is_empty() {
            self.last_transition = now;
            return;
        }
        let mut level = stop;
        let mut falls = Vec::new();
        let mut level_now = None;
        for at in transitions.since(self.last_transition) {
            if at <= now {
                level_now.get_or_insert(level);
                if !level {
                    falls.push(at);
                }
            }
            level = !level;
        }
        let is_high = level_now.unwrap_or(level);
        for fall in falls.into_iter().rev() {
            self.finish_where(complete, |photon| (photon.begin < fall).then_some(fall));
        }
        if !is_high {
            // Not to be seen on the wire.
            self.finish_where(complete, |photon| Some(photon.begin));
        }
        self.last_transition = now;
    }

    /// Ends all photons at `end`, which is that of the run.
    pub(super) fn finish(&mut self, end: Time, complete: &mut Vec<Transaction>) {
        self.finish_where(complete, |_| Some(end));
    }

    fn finish_where(
        &mut self,
        complete: &mut Vec<Transaction>,
        end: impl Fn(&Transaction) -> Option<Time>,
    ) {
        for mut photon in std::mem::take(&mut self.going) {
            match end(&photon) {
                Some(end) => {
                    photon.end = end;
                    complete.push(photon);
                }
                None => self.going.push(photon),
            }
        }
    }
}
