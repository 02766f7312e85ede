//! The lowest, the highest and any sum of each address, for each neuron apart from the others; sums
//! beyond both ends of the table.

use std::sync::Arc;

use tofsim::firmware::forward1::L1In;
use tofsim::firmware::forward2::MOST_NEURONS;
use tofsim::firmware::tansig::{ENTRIES, In, Rom, address};

use crate::golden::prelude::*;

/// Sums of an address.
const STEP: i64 = 1 << 14;
/// Addresses of either sign.
const HALF: i64 = ENTRIES as i64 / 2;
/// Just beyond the rounded ends of the table, and the ends of the word.
const BEYOND: [i64; 4] =
    [-HALF * STEP - STEP / 2 - 1, HALF * STEP - STEP / 2, -(1 << 35), (1 << 35) - 1];

pub(super) const SPEC: Spec = Spec {
    stream: Some(16),
    reset: Some("rst"),
    latency: &[Latency { from: "l1_in_0", to: "l1_out_0", cycles: |_| 0 }],
    ..Spec::new("tansig", "depth_estimator.tansig", record::<Tansig>)
};

struct Tansig {
    rom: Arc<Rom>,
    neurons: usize,
    /// Lines of the sweep.
    swept: usize,
    lowest: Cover,
    highest: Cover,
    beyond: Cover,
    situations: Cover,
}

impl Tansig {
    /// The sum of a neuron in the sweep: other addresses for other neurons.
    fn sweep(&self, neuron: usize, draw: &mut Draw) -> L1In {
        let place = (self.swept * 5 + neuron * 517) % ENTRIES;
        let offset = match self.swept / ENTRIES {
            0 => -STEP / 2,
            1 => STEP / 2 - 1,
            _ => draw.below(STEP as u64) as i64 - STEP / 2,
        };
        S::new((place as i64 - HALF) * STEP + offset)
    }

    fn see(&mut self, neuron: usize, l1_in: L1In) {
        let case = (neuron * ENTRIES + address(l1_in)) as u64;
        let offset = (l1_in.get() + STEP / 2).rem_euclid(STEP);
        let inside = (-HALF * STEP - STEP / 2..HALF * STEP - STEP / 2).contains(&l1_in.get());
        self.lowest.see_if(inside && offset == 0, case);
        self.highest.see_if(inside && offset == STEP - 1, case);
        if let Some(place) = BEYOND.iter().position(|&sum| sum == l1_in.get()) {
            self.beyond.see((neuron * BEYOND.len() + place) as u64);
        }
    }
}

impl Block for Tansig {
    type Stimulus = In;

    fn new(setting: &Setting) -> Self {
        let neurons = setting.neurons();
        let cases = neurons as u64 * ENTRIES as u64;
        Tansig {
            rom: setting.setup.params.depth_estimator.tansig.clone(),
            neurons,
            swept: 0,
            lowest: Cover::new("lowest sum of neuron x 4096 + address", 0..cases),
            highest: Cover::new("highest sum of neuron x 4096 + address", 0..cases),
            beyond: Cover::new(
                "neuron x 4 + just below, just above, lowest, highest of all",
                0..neurons as u64 * 4,
            ),
            situations: Cover::new("rst x 2 + tansig_en", 0..4),
        }
    }

    fn stimulus(&mut self, _: usize, _: &TofTop, draw: &mut Draw) -> In {
        let (rst, tansig_en, special) = (draw.one_in(32), !draw.one_in(4), draw.one_in(8));
        let mut l1_in = [S::new(0); MOST_NEURONS];
        for (neuron, sum) in l1_in[..self.neurons].iter_mut().enumerate() {
            *sum = match (special, draw.below(3)) {
                (true, 0) => draw.signed(),
                (true, _) => S::new(BEYOND[draw.below(BEYOND.len() as u64) as usize]),
                (false, _) => self.sweep(neuron, draw),
            };
        }
        self.situations.see(bits([rst, tansig_en]));
        if tansig_en && !rst {
            let sums = l1_in[..self.neurons].iter().enumerate();
            sums.for_each(|(neuron, sum)| self.see(neuron, *sum));
            self.swept += usize::from(!special);
        }
        In { rst, tansig_en, l1_in }
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        let tansig = &mut top.depth_estimator.tansig;
        *tansig = tansig.next(i, &self.rom);
    }

    fn parameters(&self) -> Parameters {
        parameters::with_neurons(files(["TansigFile"], [mem::tansig(&self.rom)]), self.neurons)
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.lowest, self.highest, self.beyond, self.situations]
    }
}
