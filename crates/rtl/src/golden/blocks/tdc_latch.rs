//! Hits with every number of taps, in every order with start, window and reset; levels held over;
//! old pulses beside the hit.

use tofsim::firmware::carry_chain::Taps;
use tofsim::firmware::tdc_latch::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    stream: Some(19),
    reset: Some("rst"),
    latency: &[
        Latency { from: "taps", to: "hit", cycles: |_| 0 },
        Latency { from: "taps", to: "hit_taps", cycles: |_| 0 },
        Latency { from: "coarse", to: "hit_coarse", cycles: |_| 0 },
    ],
    ..Spec::new("tdc_latch", "tdc.tdc_latch", record::<TdcLatch>)
};

struct TdcLatch {
    /// Place of physical tap 0 in the order of arrival.
    tap_0: usize,
    /// Taps that may be high.
    taps: usize,
    /// Taps of the next hit.
    rank: usize,
    hits: Cover,
    coarse: Cover,
    situations: Cover,
}

impl TdcLatch {
    /// Taps with tap 0 high or low, and perhaps a pulse behind.
    fn draw(&self, high: bool, draw: &mut Draw) -> Taps {
        let first = if high { self.rank } else { self.tap_0 + 1 };
        let mut rank = || first + draw.below((self.taps - first + 1) as u64) as usize;
        let mut behind = [rank(), rank()];
        behind.sort();
        let [begin, end] = behind;
        match (high, draw.one_in(2)) {
            (true, true) => Taps::new(true, [first]),
            (true, false) => Taps::new(true, [first, begin, end]),
            (false, true) => Taps::settled(false),
            (false, false) => Taps::new(false, [begin, end]),
        }
    }
}

impl Block for TdcLatch {
    type Stimulus = In;

    fn new(setting: &Setting) -> Self {
        let (tap_0, taps) = (setting.setup.params.tdc.delays.tap_0_position(), setting.places());
        TdcLatch {
            tap_0,
            taps,
            rank: tap_0 + 1,
            hits: Cover::new(
                "taps that the rise of a hit has reached",
                tap_0 as u64 + 1..=taps as u64,
            ),
            coarse: Cover::new("coarse of a hit", 0..8),
            situations: Cover::new("rst, start, window, tap 0, before, used as bits", 0..64),
        }
    }

    fn stimulus(&mut self, cycle: usize, top: &TofTop, draw: &mut Draw) -> In {
        let (used, before) = top.tdc.tdc_latch.before();
        // A hit at the first edge shows how the registers begin.
        let first = cycle == 0;
        let high = first || draw.one_in(2);
        let i = In {
            rst: !first && draw.one_in(10),
            start: draw.one_in(3),
            window: first || !draw.one_in(3),
            coarse: draw.word(),
            taps: self.draw(high, draw),
        };
        self.situations.see(bits([i.rst, i.start, i.window, high, before, used]));
        if high && !before && i.window && !used && !i.rst {
            self.hits.see(self.rank as u64);
            self.coarse.see(i.coarse.get());
            self.rank = if self.rank == self.taps { self.tap_0 + 1 } else { self.rank + 1 };
        }
        i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.tdc.tdc_latch = top.tdc.tdc_latch.next(i, &self.tap_0);
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.hits, self.coarse, self.situations]
    }
}
