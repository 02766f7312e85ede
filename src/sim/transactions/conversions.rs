//! The TDC's pipeline: hits and their codes.

use std::collections::VecDeque;

use crate::firmware::tof_top::CodeSource;
use crate::kernel::Time;

use super::edge::{BegunShot, BegunShots, EdgeState, Numbers};
use super::photons::Photons;
use super::{Content, Origin, Stream, Transaction};

/// Follows hits to their codes.
#[derive(Clone, Debug, Default)]
pub(super) struct Conversions {
    /// Hits on their way to a code, oldest first.
    hits: VecDeque<Transaction>,
    /// Whether the coming edge makes the code of a hit, or finds that there is none.
    decides: bool,
}

impl Conversions {
    /// Follows an edge; returns the code that is new with it.
    pub(super) fn edge(
        &mut self,
        edge: &EdgeState,
        (shots, photons): (&BegunShots, &Photons),
        numbers: &mut Numbers,
        complete: &mut Vec<Transaction>,
    ) -> Option<Transaction> {
        let code = match edge.p.code_source {
            CodeSource::Tdc => self.follow_tdc(edge, numbers, complete),
            CodeSource::Preload(_) => preloaded(edge, shots.last(), numbers),
        };
        if edge.top.tdc.tdc_latch.hit && !edge.top.tdc_calibration.registers.calibrating {
            let photon = photons.avalanches.of_hit(edge.before, edge.p);
            let shot = shots.of_hit(edge.cycle);
            self.hits.push_back(Transaction {
                id: numbers.next(),
                begin: photon.map_or(edge.before, |(at, _)| at),
                end: edge.now,
                frame: edge.frame,
                shot: shot.map(|shot| shot.shot),
                origin: photon.map(|(_, id)| Origin { stream: Stream::Photon, id }),
                content: Content::Hit { n: None, coarse: None },
            });
        }
        complete.extend(code.clone());
        code
    }

    fn follow_tdc(
        &mut self,
        edge: &EdgeState,
        numbers: &mut Numbers,
        complete: &mut Vec<Transaction>,
    ) -> Option<Transaction> {
        let decoder = &edge.top.tdc.tdc_decoder;
        let is_decided = self.decides && self.hits.front().is_some_and(is_counted);
        let decided = if is_decided { self.hits.pop_front() } else { None };
        self.decides = decoder.decides();
        if let Some((n, coarse)) = decoder.counted()
            && let Some(hit) = self.hits.iter_mut().find(|hit| !is_counted(hit))
        {
            hit.content = Content::Hit { n: Some(n), coarse: Some(coarse) };
        }
        let hit = decided?;
        let code = decoder.tdc_valid.then(|| {
            code_of(edge, decoder.tdc_code.get(), hit.shot, Some(hit.as_origin()), numbers)
        });
        complete.push(hit);
        code
    }

    /// Ends the hits that have no code yet: the frame begins again, or the run has ended.
    pub(super) fn finish(&mut self, complete: &mut Vec<Transaction>) {
        complete.extend(self.hits.drain(..));
    }
}

/// Returns whether the ones count of a hit is known.
fn is_counted(hit: &Transaction) -> bool {
    matches!(hit.content, Content::Hit { n: Some(_), .. })
}

/// Returns the preloaded code that is new with an edge.
fn preloaded(
    edge: &EdgeState,
    shot: Option<&BegunShot>,
    numbers: &mut Numbers,
) -> Option<Transaction> {
    let preload = &edge.top.code_preload;
    let origin = shot.map(BegunShot::as_origin);
    let shot = shot.map(|shot| shot.shot);
    let code = || code_of(edge, preload.tdc_code.get(), shot, origin, numbers);
    preload.tdc_valid.then(code)
}

fn code_of(
    edge: &EdgeState,
    code: u64,
    shot: Option<u64>,
    origin: Option<Origin>,
    numbers: &mut Numbers,
) -> Transaction {
    let scale = &edge.p.tdc.decoder.scale;
    let time = scale.first() + Time::from_fs(code * scale.bin().fs());
    Transaction {
        id: numbers.next(),
        begin: edge.now,
        end: edge.next,
        frame: edge.frame,
        shot,
        origin,
        content: Content::Code { code, time },
    }
}
