//! The histogram: words in distributed RAM, 256 of 16 bits on the KC705.
//!
//! Mirrors `rtl_ref/histogram_builder.v`. Asynchronous read, synchronous write, one address: clear goes
//! before hit, hit before read. A hit takes the two cycles after that of `tdc_valid`: its word is read in
//! the first, and written back, one more, in the second. So `tdc_valid` has to stay low and `tdc_code` to
//! hold for two cycles: codes are a shot apart, six cycles or more, or four where one is late and the next
//! early. A hit that meets `clear` in any of its three cycles is lost. Nothing has a reset. In an array there is one for
//! each column and bank, which is filled or read when it is the turn of both ([`In::at`]).

use crate::kernel::U;
use crate::kernel::scan::{self, Scan};
use crate::{module_of_registers, signals};

/// Words of the histogram unless elaboration says otherwise.
pub const BINS: usize = 256;
/// Most words that elaboration can ask for.
pub const MOST_BINS: usize = 1024;
/// Width of a word unless elaboration says otherwise [bits].
pub const COUNT_BITS: u32 = 16;

/// Number of a word.
pub type Bin = U<10>;
/// A word of the histogram [hits].
pub type Count = U<24>;

/// Verilog parameters: how large the histogram is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Params {
    /// Words, a power of two from 16 to [`MOST_BINS`].
    pub bins: usize,
    /// Width of a word, 8 to 24 [bits].
    pub count_bits: u32,
}

impl Default for Params {
    /// The KC705's.
    fn default() -> Self {
        Params { bins: BINS, count_bits: COUNT_BITS }
    }
}

impl Params {
    /// Number of the last word.
    #[inline(always)]
    pub fn last_bin(&self) -> u64 {
        self.bins as u64 - 1
    }

    /// The largest count that a word holds [hits].
    #[inline(always)]
    pub fn most_hits(&self) -> u64 {
        (1 << self.count_bits) - 1
    }

    /// A word that wraps as one of that width.
    #[inline(always)]
    fn word(&self, hits: u64) -> Count {
        Count::new(hits & self.most_hits())
    }
}

/// Place of a histogram in an array: Verilog parameters too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// How the array is scanned.
    pub scan: Scan,
    /// Column of this histogram.
    pub column: u64,
    /// Its bank.
    pub bank: bool,
}

signals! {
    /// Input ports.
    pub struct In {
        /// Sets the word at `clear_addr` to zero.
        pub clear: bool,
        /// Word to clear.
        #[size(BinBits)]
        pub clear_addr: Bin,
        /// Bank that is filled.
        #[only_if(Scanned)]
        pub bank: bool,
        /// Column that is read.
        #[only_if(Scanned)]
        pub depth_column: scan::Place,
        /// Counts a hit; low for the next two cycles.
        pub tdc_valid: bool,
        /// Word of the hit; holds for the next two cycles.
        #[size(BinBits)]
        pub tdc_code: Bin,
        /// Shows a word at `count`.
        pub read_en: bool,
        /// Word to show.
        #[size(BinBits)]
        pub read_addr: Bin,
    }
}

impl In {
    /// Returns what a histogram at `place` takes of it: `clear` and hits while its bank is filled, reads while the other
    /// one is and its column is read.
    #[inline(always)]
    pub fn at(self, place: &Place) -> Self {
        let Place { scan, column, bank } = *place;
        let fills = scan.banks == 1 || self.bank == bank;
        let shows = scan.banks == 1 || self.bank != bank;
        let shows = shows && (scan.columns == 1 || self.depth_column == column);
        In {
            clear: self.clear && fills,
            tdc_valid: self.tdc_valid && fills,
            read_en: self.read_en && shows,
            ..self
        }
    }
}

signals! {
    /// Registers.
    pub struct Registers {
        /// Either cycle of a hit.
        counting: bool,
        /// The second cycle of a hit.
        writing: bool,
        /// The word of the hit before it is counted [hits].
        #[size(CountBits)]
        #[view(heading = "Histogram", curve = true)]
        hit_word: Count,
    }
}

/// Registers and RAM. Too large to copy at every edge, so it is clocked in place.
#[derive(Clone, Debug, PartialEq)]
pub struct HistogramBuilder {
    /// Registers.
    pub registers: Registers,
    /// Counts [hits].
    pub ram: Box<[Count]>,
}

impl Default for HistogramBuilder {
    fn default() -> Self {
        HistogramBuilder::new(&Params::default())
    }
}

// The words of the RAM come after all registers (see `crate::hierarchy`).
module_of_registers!(HistogramBuilder);

impl HistogramBuilder {
    /// An empty histogram.
    pub fn new(p: &Params) -> Self {
        let ram = vec![Count::default(); p.bins].into();
        HistogramBuilder { registers: Registers::default(), ram }
    }

    /// Output port `count`: the word at the address, zero while `read_en` is low.
    #[inline(always)]
    pub fn count(&self, i: &In) -> Count {
        if i.read_en { self.ram[self.address(i).index()] } else { U::new(0) }
    }

    /// Returns whether a hit is on its way to its word.
    #[inline(always)]
    pub fn has_hit(&self) -> bool {
        self.registers.counting
    }

    /// The rising edge of `clk_sys`.
    #[inline(always)]
    pub fn tick(&mut self, i: &In, p: &Params) {
        let q = self.registers;
        // Nothing is to be cleared, and no hit is being counted.
        if !(i.clear | i.tdc_valid | q.counting) {
            return;
        }
        let reading = q.counting && !q.writing;
        if i.clear | q.counting {
            let word = &mut self.ram[self.address(i).index()];
            if reading {
                self.registers.hit_word = *word;
            }
            if i.clear {
                *word = U::new(0);
            } else if q.writing {
                *word = p.word(q.hit_word.get() + 1);
            }
        }
        self.registers.counting = (i.tdc_valid || reading) && !i.clear;
        self.registers.writing = reading && !i.clear;
    }

    /// Stands for the three edges of a hit that meets no `clear`.
    #[inline(always)]
    pub fn count_at_once(&mut self, code: Bin, p: &Params) {
        let word = &mut self.ram[code.index()];
        (self.registers.hit_word, *word) = (*word, p.word(word.get() + 1));
    }

    #[inline(always)]
    fn address(&self, i: &In) -> Bin {
        match (i.clear, self.registers.counting) {
            (true, _) => i.clear_addr,
            (false, true) => i.tdc_code,
            (false, false) => i.read_addr,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const READ_9: In = In {
        clear: false,
        clear_addr: U::new(3),
        bank: false,
        depth_column: U::new(0),
        tdc_valid: false,
        tdc_code: U::new(9),
        read_en: true,
        read_addr: U::new(9),
    };

    /// A hit of word 9, with `clear` in its cycle of that number.
    fn hit(histogram: &mut HistogramBuilder, cleared: Option<usize>) {
        for cycle in 0..3 {
            let (tdc_valid, clear) = (cycle == 0, cleared == Some(cycle));
            histogram.tick(&In { tdc_valid, clear, ..READ_9 }, &Params::default());
        }
    }

    #[test]
    fn equal_codes_three_cycles_apart_both_count() {
        let mut histogram = HistogramBuilder::default();
        for count in 1..4 {
            hit(&mut histogram, None);
            assert_eq!(histogram.count(&READ_9), count);
        }
    }

    #[test]
    fn a_hit_that_meets_clear_is_lost() {
        for cycle in 0..3 {
            let mut histogram = HistogramBuilder::default();
            histogram.ram[3] = U::new(70);
            histogram.ram[9] = U::new(5);
            hit(&mut histogram, Some(cycle));
            histogram.tick(&READ_9, &Params::default());
            assert_eq!((histogram.ram[3].get(), histogram.ram[9].get()), (0, 5));
        }
    }

    #[test]
    fn a_full_word_wraps() {
        let p = Params { bins: 16, count_bits: 8 };
        let mut histogram = HistogramBuilder::new(&p);
        histogram.ram[9] = U::new(255);
        for (cycle, counting) in [(0, false), (1, true), (2, true)] {
            assert_eq!(histogram.has_hit(), counting);
            histogram.tick(&In { tdc_valid: cycle == 0, ..READ_9 }, &p);
        }
        assert_eq!((histogram.ram.len(), histogram.ram[9].get()), (16, 0));
    }

    #[test]
    fn a_histogram_of_an_array_waits_for_its_turn() {
        let scan = Scan { rows: 4, columns: 3, banks: 2 };
        let all = In { clear: true, tdc_valid: true, read_en: true, ..READ_9 };
        for (bank, column) in [(false, 0), (false, 2), (true, 0), (true, 2)] {
            let i = In { bank, depth_column: U::new(column), ..all };
            let own = i.at(&Place { scan, column: 2, bank: true });
            assert_eq!([own.clear, own.tdc_valid], [bank; 2]);
            assert_eq!(own.read_en, !bank && column == 2);
            assert_eq!(i.at(&Place { scan: Scan::default(), column: 0, bank: false }), i);
        }
    }

    #[test]
    fn a_hit_goes_before_a_read() {
        let mut histogram = HistogramBuilder::default();
        histogram.ram[9] = U::new(5);
        let elsewhere = In { read_addr: U::new(3), ..READ_9 };
        histogram.tick(&In { tdc_valid: true, ..elsewhere }, &Params::default());
        assert_eq!(histogram.count(&elsewhere), 5);
    }
}
