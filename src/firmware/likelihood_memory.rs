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

use crate::kernel::U;
use crate::kernel::module::{Module, Visitor};
use crate::signals;

use super::histogram_builder::{Bin, Count, MOST_BINS};
use super::likelihood_estimator::params::Params;
use super::likelihood_estimator::words::UNITS;

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
        /// Shots that are left.
        #[size(CountBits)]
        left: Count,
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

impl Module for LikelihoodMemory {
    const COUNT: usize = <Registers as Module>::COUNT;

    #[inline(always)]
    fn visit(&self, then: Option<&mut Self>, visitor: &mut impl Visitor) {
        visitor.signals("registers", &self.registers, then.map(|then| &mut then.registers));
    }
}

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
            q.read(&self.ram[q.bin.index()], &mut d);
        }
        q.pass(i, p, &mut d);
        if i.phase || q.read_en {
            let place = if q.read_en { q.read_addr.index() + 1 } else { q.index.index() };
            (d.fetched_width, d.fetched_end) = p.rom_word(place);
        }
        if i.rst { Registers::default() } else { d }
    }
}

impl Params {
    /// The ROM's word of a place: width of the bin before it, and its time.
    pub fn rom_word(&self, place: usize) -> (Width, Edge) {
        let width = if place == 0 { 0 } else { self.width(place - 1) };
        (U::new(width as u64), U::new(self.edges[place].into()))
    }

    /// Beats of a scan after its last bin, less one.
    pub fn scan_tail(&self) -> u64 {
        self.box_back() as u64 - 1
    }

    /// Bins from the middle of a box to the one after its last.
    pub fn box_back(&self) -> usize {
        self.box_bins - self.box_bins / 2
    }
}

impl Registers {
    /// Reads the histogram.
    fn load(&self, i: &In, p: &Params, d: &mut Self) {
        let last = self.read_addr == p.histogram.last_bin();
        if i.load {
            (d.read_en, d.read_addr) = (true, U::new(0));
            d.left = U::new(p.shots);
        } else if self.read_en {
            d.read_en = !last;
            d.read_addr = U::new(if last { 0 } else { self.read_addr.get() + 1 });
            d.left = U::new(self.left.get().saturating_sub(i.count.get()));
        }
        d.taken = self.read_en;
        (d.taken_bin, d.taken_ended, d.taken_waiting) = (self.read_addr, i.count, self.left);
        d.begun = self.taken;
        (d.begun_bin, d.begun_ended) = (self.taken_bin, self.taken_ended);
        (d.begun_waiting, d.begun_three) =
            (self.taken_waiting, U::new(3 * self.taken_waiting.get()));
        let width = self.fetched_width.get();
        d.begun_width = U::new(width >> 4);
        d.begun_exposure = U::new(self.taken_waiting.get() * (width & 15));
        d.written = self.begun;
        (d.written_bin, d.written_ended) = (self.begun_bin, self.begun_ended);
        d.written_waiting = self.begun_waiting;
        let exposure = (self.begun_waiting.get() * self.begun_width.get()) << 4;
        d.written_exposure = U::new(exposure + self.begun_exposure.get());
    }

    /// Sums over a block.
    fn sum(&self, p: &Params, d: &mut Self) {
        let block = p.histogram.bins as u64 / 8;
        let place = self.written_bin.get() % block;
        d.block_done = self.written && place == block - 1;
        if self.written {
            let (ended, exposure) = (self.written_ended.get(), self.written_exposure.get());
            let first = place == 0;
            d.block_ended = U::new(if first { ended } else { self.block_ended.get() + ended });
            d.block_exposure =
                U::new(if first { exposure } else { self.block_exposure.get() + exposure });
        }
    }

    /// Sums over all bins and over the rest of them, with one adder: blocks are added to all. With a bin of a pass they
    /// change places twice, and it is subtracted from the rest on the way.
    fn subtract(&self, i: &In, d: &mut Self) {
        d.summed = self.block_done;
        if self.block_done {
            d.all_ended = self.rest_ended + self.block_ended.get();
            d.all_exposure = self.rest_exposure + self.block_exposure.get();
        } else if self.read_bin {
            let part = |word: u64| if i.phase { 0 } else { word };
            d.all_ended = self.rest_ended - part(self.read_ended.get());
            d.all_exposure = self.rest_exposure - part(self.read_exposure.get());
        }
        if self.summed || i.pass || self.read_bin {
            (d.rest_ended, d.rest_exposure) = (self.all_ended, self.all_exposure);
        }
        if i.load {
            (d.all_ended, d.all_exposure) = Default::default();
            (d.rest_ended, d.rest_exposure) = Default::default();
        }
    }

    /// Goes on with a pass, or begins one.
    fn pass(&self, i: &In, p: &Params, d: &mut Self) {
        if i.pass {
            (d.passing, d.opening, d.tailing, d.scanning) = (true, true, false, i.scan);
            d.blank = false;
            d.index = if i.scan { U::new(0) } else { i.fit_begin };
            d.tail = U::new(0);
        } else if self.passing && i.phase {
            d.opening = false;
            let (at_begin, at_end) = (self.index == i.fit_begin, self.index == i.fit_end);
            let last = if self.scanning { self.index == p.histogram.bins as u64 } else { at_end };
            if self.opening || !last {
                d.index = self.index + 1;
                d.bin = U::new(self.index.get() % p.histogram.bins as u64);
                if at_begin || at_end {
                    d.blank = self.scanning && !at_end;
                }
            } else if !self.tailing {
                d.tailing = true;
            } else if !self.scanning || self.tail == p.scan_tail() {
                d.passing = false;
            } else {
                d.tail = self.tail + 1;
            }
        }
    }

    /// Looks up a bin; one that is blanked is none.
    fn read(&self, kept: &Kept, d: &mut Self) {
        let bin = self.passing && !self.opening && !self.tailing;
        d.read_bin = bin && !self.blank;
        d.read_rest = self.passing && self.tailing && !self.scanning;
        d.read_edge = self.passing && self.opening;
        d.read_slide = self.passing && self.scanning && !self.opening;
        d.read_first = self.index == if self.opening { 0 } else { 1 };
        (d.read_ended, d.read_waiting, d.read_exposure) = (kept.ended, kept.waiting, kept.exposure);
    }

    /// Hands a bin on, or all others; a bin without width is none.
    fn word(&self, p: &Params, d: &mut Self) {
        d.word_bin = self.read_bin && self.fetched_width != 0;
        (d.word_rest, d.word_edge, d.word_first) =
            (self.read_rest, self.read_edge, self.read_first);
        d.word_slide = self.read_slide;
        d.word_end = self.fetched_end;
        (d.word_ended, d.word_waiting, d.word_width) = match self.read_rest {
            true => {
                let most = (1 << (p.histogram.count_bits + p.histogram.bins.ilog2())) - 1;
                let waiting = (self.rest_exposure.get() >> UNITS.ilog2()).min(most);
                (self.rest_ended, U::new(waiting), U::new(UNITS as u64))
            }
            false => {
                let [ended, waiting] =
                    [self.read_ended, self.read_waiting].map(|shots| U::new(shots.get()));
                (ended, waiting, self.fetched_width)
            }
        };
    }
}
