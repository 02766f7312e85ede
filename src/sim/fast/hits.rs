//! Hits on their way from the latch to their words, while nobody looks at the registers between.
//!
//! Each of those registers holds the last hit that has come to it, and no hit catches up with another.
//! So a hit is counted at once when a later one is through; that one and those after it are replayed
//! when somebody looks. Exact from when those registers rest, while resets, `clear` and `read_en` are low.

use std::collections::VecDeque;

use crate::firmware::carry_chain::Taps;
use crate::firmware::coarse_counter::Coarse;
use crate::firmware::tdc_decoder;
use crate::firmware::tof_top::{CodeSource, Params, TofTop};
use crate::kernel::Clocked;

use super::halves::{convert, count, count_hits, sample, skip_converter, skip_sampling};

/// Edges in which a code's word is written and all comes to rest, at most.
const COUNTING: u64 = 4;

/// A hit that the latch has kept.
struct Hit {
    /// The edge that takes it from the latch.
    taken: u64,
    coarse: Coarse,
    taps: Taps,
}

/// Hits that the registers behind the latch have not seen, oldest first.
#[derive(Default)]
pub struct Hits(VecDeque<Hit>);

impl Hits {
    /// Takes the converter's part of edge `cycle`, which samples `taps`.
    #[inline(always)]
    pub(super) fn convert(&mut self, top: &mut TofTop, p: &Params, taps: Taps, cycle: u64) {
        let from_tdc = matches!(p.code_source, CodeSource::Tdc);
        if !from_tdc || self.0.is_empty() && (top.tdc.has_hit() | top.histogram_builder.has_hit()) {
            return convert(top, p, taps);
        }
        sample(top, p, taps);
        let latch = &top.tdc.tdc_latch;
        if latch.hit {
            let (coarse, taps) = (latch.hit_coarse, latch.hit_taps);
            self.0.push_back(Hit { taken: cycle + 1, coarse, taps });
            let through = p.tdc.decoder.latency() + COUNTING;
            while self.0.get(1).is_some_and(|second| second.taken + through <= cycle) {
                self.count_oldest(top, p);
            }
        }
    }

    /// Skips quiet cycles of the converter.
    #[inline(always)]
    pub(super) fn skip(&self, top: &mut TofTop, p: &Params, cycles: u64) {
        if self.0.is_empty() {
            skip_converter(top, p, cycles);
        } else {
            skip_sampling(top, p, cycles);
        }
    }

    /// Brings the registers to their state after `cycle` edges.
    pub(super) fn replay(&mut self, top: &mut TofTop, p: &Params, cycle: u64) {
        let Some(first) = self.0.front() else { return };
        let mut done = first.taken;
        for Hit { taken, coarse, taps } in self.0.drain(..).take_while(|hit| hit.taken < cycle) {
            come_to_rest(top, p, taken - done);
            let hit = tdc_decoder::In {
                hit: true,
                hit_coarse: coarse,
                hit_taps: taps,
                ..Default::default()
            };
            decode(top, p, &hit);
            done = taken + 1;
        }
        come_to_rest(top, p, cycle - done);
    }

    /// Counts all hits, those in registers too, however far they are from their words.
    pub(super) fn finish(&mut self, top: &mut TofTop, p: &Params) {
        if self.0.is_empty() {
            count_hits(top, p, u64::MAX);
        }
        while !self.0.is_empty() {
            self.count_oldest(top, p);
        }
    }

    /// Counts the oldest hit, and keeps its code as the last one.
    #[inline(always)]
    fn count_oldest(&mut self, top: &mut TofTop, p: &Params) {
        let Some(hit) = self.0.pop_front() else { return };
        let (coarse, n) = (hit.coarse.get(), p.tdc.decoder.number(&hit.taps));
        if let Some(code) = p.tdc.decoder.code(coarse, n) {
            top.tdc.tdc_decoder.tdc_code = code;
            top.nets.tdc_code = code;
            top.histogram_builder.count_at_once(code, &p.histogram);
        }
    }
}

/// Takes so many edges of the registers behind the latch, without a hit.
fn come_to_rest(top: &mut TofTop, p: &Params, edges: u64) {
    let mut left = edges;
    while left > 0 && (top.tdc.tdc_decoder.has_hit() | top.histogram_builder.has_hit()) {
        decode(top, p, &tdc_decoder::In::default());
        left -= 1;
    }
}

/// Takes an edge of the registers behind the latch.
fn decode(top: &mut TofTop, p: &Params, i: &tdc_decoder::In) {
    count(top, p);
    top.tdc.tdc_decoder.tick(i, &p.tdc.decoder);
    top.take_code();
}
