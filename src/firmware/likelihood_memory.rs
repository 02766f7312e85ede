//! Counts, shots that wait and exposures, as the likelihood estimator goes through them.
//!
//! Mirrors `rtl_ref/likelihood_memory.v`. A load reads the histogram's words once, in order, and keeps of each bin
//! the shots that end in it, those that wait when it begins, and these times its width. Of each eighth of the bins
//! it gives the sums. A pass goes over bins from one to another, two cycles each (a beat, `phase` low and high):
//! first a beat for the edge where it begins, then the bins, and last a beat that stands for all other bins as one
//! or, in a scan, as many empty ones as let the box leave.
//!
//! ```text
//! beat       k                 k + 1                      k + 2
//! registers  index, kind       fetched, ended, waiting    word
//! ```

use crate::kernel::{U, scan};
use crate::{module_of_registers, signals};

use super::histogram_builder::{Bin, Count, MOST_BINS};
use super::likelihood_estimator::params::Params;

mod loading;
mod passing;

/// A place between bins, from 0 to as many as there are.
pub type Place = U<11>;
/// Time of an edge from the laser edge [half units].
pub type Edge = U<18>;
/// Width of a bin [units].
pub type Width = U<10>;
/// Shots times units.
pub type Exposure = U<44>;
/// Shots, of several bins together.
pub type Waiting = U<34>;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Begins a load.
        pub load: bool,
        /// Column of the histogram.
        #[only_if(Scanned)]
        pub depth_column: scan::Place,
        /// Word of the histogram at `read_addr` [hits].
        #[size(CountBits)]
        pub count: Count,
        /// Begins a pass.
        pub pass: bool,
        /// The pass is a scan: over all bins, and those of the fit are blanked.
        pub scan: bool,
        /// Begin of the fit [bins].
        #[size(PlaceBits)]
        pub fit_begin: Place,
        /// End of the fit [bins].
        #[size(PlaceBits)]
        pub fit_end: Place,
        /// A fit goes on over the later bins.
        #[only_if(HasSecond)]
        pub wide: bool,
        /// Begin of the later bins of a fit [bins].
        #[only_if(HasSecond)]
        #[size(PlaceBits)]
        pub later_begin: Place,
        /// Their end.
        #[only_if(HasSecond)]
        #[size(PlaceBits)]
        pub later_end: Place,
        /// Second cycle of a beat.
        pub phase: bool,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// The histogram's word at `read_addr` is being read.
        pub read_en: bool,
        /// Word of the histogram.
        #[size(BinBits)]
        pub read_addr: Bin,
        /// A block of bins is complete; one cycle.
        pub block_done: bool,
        /// Hits of the block, until the next one.
        #[size(RestBits)]
        pub block_ended: Waiting,
        /// Its exposure [shots units].
        #[size(ExposureBits)]
        pub block_exposure: Exposure,
        /// Shots that are left; between a load and the next one, those that the histogram does not count.
        #[size(CountBits)]
        pub left: Count,
        /// The word is a bin of the pass.
        pub word_bin: bool,
        /// The word stands for all other bins.
        pub word_rest: bool,
        /// The word is an edge without a bin.
        pub word_edge: bool,
        /// A box goes on with it.
        pub word_slide: bool,
        /// The word's bin is bin 0, or its edge the begin of bin 0.
        pub word_first: bool,
        /// Shots that end in it.
        #[size(RestBits)]
        pub word_ended: Waiting,
        /// Shots that wait when it begins.
        #[size(RestBits)]
        pub word_waiting: Waiting,
        /// Its width [units].
        #[size(WidthBits)]
        pub word_width: Width,
        /// End of the word [half units].
        #[size(EdgeBits)]
        pub word_end: Edge,
        /// Part of the cover glass's light in the bin, 17 fraction bits.
        #[only_if(Glass)]
        pub word_glass: U<17>,
        /// The word is the first one of the window around the echo.
        #[only_if(Glass)]
        pub word_window: bool,
        /// The word is the first one of the later bins.
        #[only_if(HasSecond)]
        pub word_later: bool,
        /// A word has been read in the last cycle.
        taken: bool,
        /// Its bin.
        #[size(BinBits)]
        taken_bin: Bin,
        /// The word.
        #[size(CountBits)]
        taken_ended: Count,
        /// Shots that waited.
        #[size(CountBits)]
        taken_waiting: Count,
        /// Its exposure is begun.
        begun: bool,
        /// Of this bin.
        #[size(BinBits)]
        begun_bin: Bin,
        /// The word.
        #[size(CountBits)]
        begun_ended: Count,
        /// Shots that waited.
        #[size(CountBits)]
        begun_waiting: Count,
        /// Three times these.
        #[size(ThreeBits)]
        begun_three: U<26>,
        /// The bits of the width that are left.
        begun_width: U<6>,
        /// The exposure of its low four bits.
        #[size(BegunBits)]
        begun_exposure: U<28>,
        /// The result is written.
        written: bool,
        /// To this word.
        #[size(BinBits)]
        written_bin: Bin,
        /// Shots that ended.
        #[size(CountBits)]
        written_ended: Count,
        /// Shots that waited.
        #[size(CountBits)]
        written_waiting: Count,
        /// Exposure: waiting shots times the width of the bin [shots units].
        #[size(ExposureBits)]
        written_exposure: Exposure,
        /// A block has been added to all bins in the last cycle.
        summed: bool,
        /// Hits of all bins; in the second cycle of a beat with a bin, of the rest.
        #[size(RestBits)]
        all_ended: Waiting,
        /// Their exposure.
        #[size(ExposureBits)]
        all_exposure: Exposure,
        /// Width of the bin that is looked up.
        #[size(WidthBits)]
        fetched_width: Width,
        /// End of the bin that is looked up.
        #[size(EdgeBits)]
        fetched_end: Edge,
        /// A pass is on the way.
        passing: bool,
        /// The pass is a scan.
        scanning: bool,
        /// Place of the edge that is looked up, one after its bin.
        #[size(PlaceBits)]
        index: Place,
        /// Bin that is looked up.
        #[size(BinBits)]
        bin: Bin,
        /// The bin is excluded from a scan, because the fit contains it.
        blank: bool,
        /// The first beat of a pass: an edge alone.
        opening: bool,
        /// The last bin has been.
        tailing: bool,
        /// Beats after it that have been.
        #[size(PlaceBits)]
        tail: Place,
        /// A bin is looked up.
        read_bin: bool,
        /// The rest is.
        read_rest: bool,
        /// An edge alone is.
        read_edge: bool,
        /// A box goes on.
        read_slide: bool,
        /// The bin or edge is that of bin 0.
        read_first: bool,
        /// Shots that end in the bin.
        #[size(CountBits)]
        read_ended: Count,
        /// Shots that wait.
        #[size(CountBits)]
        read_waiting: Count,
        /// Their exposure.
        #[size(ExposureBits)]
        read_exposure: Exposure,
        /// Part of the cover glass's light in the bin.
        #[only_if(Glass)]
        read_glass: U<17>,
        /// The bin is the first one of the window.
        #[only_if(Glass)]
        read_window: bool,
        /// The pass is at the bins with light of the cover glass.
        #[only_if(Glass)]
        in_glass: bool,
        /// The bin is the first one of the later bins.
        #[only_if(HasSecond)]
        read_later: bool,
        /// The pass is at the later bins.
        #[only_if(HasSecond)]
        in_later: bool,
        /// Hits outside of the fit, when it has been gone through.
        #[size(RestBits)]
        rest_ended: Waiting,
        /// Exposure outside of it.
        #[size(ExposureBits)]
        rest_exposure: Exposure,
    }
}

/// A word of the memory.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Kept {
    ended: Count,
    waiting: Count,
    exposure: Exposure,
}

/// Registers and memory.
#[derive(Clone, Debug, PartialEq)]
pub struct LikelihoodMemory {
    /// Registers.
    pub registers: Registers,
    /// A word for each bin, without reset.
    ram: Box<[Kept; MOST_BINS]>,
}

impl Default for LikelihoodMemory {
    fn default() -> Self {
        let ram = Box::new([Kept::default(); MOST_BINS]);
        LikelihoodMemory { registers: Registers::default(), ram }
    }
}

module_of_registers!(LikelihoodMemory);

impl LikelihoodMemory {
    /// The rising edge of `clk_sys`.
    pub fn rise(&mut self, i: &In, p: &Params) {
        let (q, d) = (self.registers, self.next(i, p));
        if q.written {
            self.ram[q.written_bin.index()] = Kept {
                ended: q.written_ended,
                waiting: q.written_waiting,
                exposure: q.written_exposure,
            };
        }
        self.registers = d;
    }

    /// Whether no edge changes anything until an input does.
    pub fn rests(&self, i: &In, p: &Params) -> bool {
        !self.registers.written && self.next(i, p) == self.registers
    }

    fn next(&self, i: &In, p: &Params) -> Registers {
        let q = self.registers;
        let mut d = q;
        q.load(i, p, &mut d);
        q.sum(p, &mut d);
        q.subtract(i, &mut d);
        if i.phase {
            q.word(p, &mut d);
            q.read(i, p, &self.ram[q.bin.index()], &mut d);
        }
        q.pass(i, p, &mut d);
        if i.phase || q.read_en {
            let place = if q.read_en { q.read_addr.index() + 1 } else { q.index.index() };
            (d.fetched_width, d.fetched_end) = p.rom_word(i.depth_column.index(), place);
        }
        if i.rst { Registers::default() } else { d }
    }
}
