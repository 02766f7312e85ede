//! Recordings of shots and of transactions, in one run.

use crate::error::Result;
use crate::firmware::tof_top::Params;
use crate::kernel::Time;
use crate::optics::hazard::Cause;

use super::callback::Callback;
use super::device::{AvalancheListener, Device};
use super::frames::Frames;
use super::shot_recorder::{Recording, Shot, ShotListener};
use super::transactions::Transaction;
use super::transactions::recorder::TransactionRecording;

/// Those that somebody wants.
pub(super) struct Recordings<'a> {
    shots: Option<Recording<'a>>,
    transactions: Option<TransactionRecording<'a>>,
}

impl<'a> Recordings<'a> {
    /// Calls back with every shot and transaction from power-up on, if anything is wanted.
    pub(super) fn of(
        shots: Option<Callback<'a, Shot>>,
        transactions: Option<Callback<'a, Transaction>>,
    ) -> Option<Self> {
        let wanted = shots.is_some() || transactions.is_some();
        wanted.then(|| Recordings {
            shots: shots.map(Recording::new),
            transactions: transactions.map(TransactionRecording::new),
        })
    }

    /// Hands on the transactions that have not ended by `end`, that of the run.
    ///
    /// # Errors
    /// When a callback fails.
    pub(super) fn finish(self, end: Time) -> Result<()> {
        self.transactions.map_or(Ok(()), |transactions| transactions.finish(end))
    }
}

impl AvalancheListener for Recordings<'_> {
    const ON: bool = true;

    fn avalanche(&mut self, at: Time, cause: Option<Cause>) {
        if let Some(shots) = &mut self.shots {
            shots.avalanche(at, cause);
        }
        if let Some(transactions) = &mut self.transactions {
            transactions.avalanche(at, cause);
        }
    }
}

impl ShotListener for Recordings<'_> {
    fn after_edge(&mut self, device: &mut Device, frames: &Frames, p: &Params) -> Result<()> {
        if let Some(shots) = &mut self.shots {
            shots.after_edge(device, frames, p)?;
        }
        match &mut self.transactions {
            None => Ok(()),
            Some(transactions) => transactions.after_edge(device, frames, p),
        }
    }
}
