//! Every number of ones, in one run or several, at every coarse count; with the scenario's
//! calibration but for the last words, which give times exactly at both ends of the range.

use tofsim::firmware::carry_chain::Taps;
use tofsim::firmware::tdc_decoder::{CYCLE, Calibration, In, code};

use crate::golden::prelude::*;

/// Last time before the range, its first, its last, and the first after it [25/16 ps].
const ENDS: [i64; 4] = [-1, 0, 4095, 4096];
/// Coarse counts of which a word of 14 bits can make such a time.
const COARSE: u64 = 3;

pub(super) const SPEC: Spec = Spec {
    stream: Some(18),
    reset: Some("rst"),
    latency: &[
        Latency { from: "hit", to: "tdc_valid", cycles: |_| 1 },
        Latency { from: "hit_taps", to: "tdc_code", cycles: |_| 1 },
    ],
    ..Spec::new("tdc_decoder", "tdc.tdc_decoder", record::<TdcDecoder>)
};

struct TdcDecoder {
    cal: Box<Calibration>,
    taps: usize,
    /// Coarse and ones count for a time at an end of the range.
    ends: Vec<(u64, usize)>,
    /// Hits swept.
    hits: usize,
    ones: Cover,
    coarse: Cover,
    codes: Cover,
    times: Cover,
    situations: Cover,
}

impl TdcDecoder {
    /// So many ones, in one run or two, with the gaps anywhere.
    fn draw(&self, n: usize, draw: &mut Draw) -> Taps {
        let zeros = self.taps - n;
        let mut below = |n: usize| draw.below(n as u64 + 1) as usize;
        let (begin, first) = (below(zeros), below(n));
        let gap = below(zeros - begin);
        let second = begin + first + gap;
        match below(2) {
            0 => Taps::new(true, [n]),
            1 => Taps::new(false, [begin, begin + n]),
            _ => Taps::new(false, [begin, begin + first, second, second + n - first]),
        }
    }
}

impl Block for TdcDecoder {
    type Stimulus = In;

    fn new(setting: &Setting) -> Self {
        let (mut cal, taps) = (setting.setup.params.tdc.cal.clone(), setting.places());
        let times = (0..COARSE).flat_map(|coarse| ENDS.map(|end| (coarse, end)));
        let mut ends = Vec::new();
        for (n, (coarse, end)) in (0..=taps).rev().zip(times) {
            cal[n] = U::new((CYCLE * (coarse as i64 + 1) - end) as u64);
            ends.push((coarse, n));
        }
        let all = (0..=taps).flat_map(|n| (0..COARSE).map(move |coarse| (coarse, n)));
        let codes = all.filter_map(|(coarse, n)| Some(code(coarse, n, &cal)?.get()));
        TdcDecoder {
            codes: Cover::new("codes", codes),
            ones: Cover::new("ones count", 0..=taps as u64),
            coarse: Cover::new("coarse", 0..8),
            times: Cover::new("coarse x 4 + time -1, 0, 4095, 4096", 0..ends.len() as u64),
            situations: Cover::new("rst, hit, hit before as bits", 0..8),
            cal,
            taps,
            ends,
            hits: 0,
        }
    }

    fn stimulus(&mut self, cycle: usize, top: &TofTop, draw: &mut Draw) -> In {
        let decoder = &top.tdc.tdc_decoder;
        let (rst, hit) = (cycle > 0 && draw.one_in(40), draw.one_in(2));
        let (round, n) = (self.hits / (self.taps + 1), self.hits % (self.taps + 1));
        let special = draw.below(8);
        let (coarse, n) = match special {
            0 => self.ends[draw.below(self.ends.len() as u64) as usize],
            1 => (draw.below(8), n),
            _ => (round as u64 % COARSE, n),
        };
        self.hits += usize::from(hit && !rst && special > 1);

        let before = decoder.decoding();
        self.situations.see(bits([rst, hit, before.is_some()]));
        self.codes.see_if(decoder.tdc_valid, decoder.tdc_code.get());
        if let Some((n, coarse)) = before.filter(|_| !rst) {
            self.ones.see(n);
            self.coarse.see(coarse);
            let ends = self.ends.iter().zip(0..).filter(|(end, _)| **end == (coarse, n as usize));
            ends.for_each(|(_, case)| self.times.see(case));
        }
        In { rst, hit, hit_coarse: U::new(coarse), hit_taps: self.draw(n, draw) }
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.tdc.tdc_decoder = top.tdc.tdc_decoder.next(i, &self.cal);
    }

    fn parameters(&self) -> Parameters {
        files(["CalFile"], [mem::tdc_decoder(&self.cal)])
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.ones, self.coarse, self.codes, self.times, self.situations]
    }
}
