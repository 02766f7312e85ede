//! Goes over the bins of a pass, and takes them off the rest.

use crate::firmware::likelihood_estimator::params::{Params, width};
use crate::firmware::likelihood_estimator::words::UNITS;
use crate::kernel::U;

use super::{Edge, In, Kept, Registers, Width};

impl Params {
    /// The ROM's word of a place in a column: width of the bin before it, and its time.
    pub fn rom_word(&self, column: usize, place: usize) -> (Width, Edge) {
        let edges = self.edges_of(column);
        let width = if place == 0 { 0 } else { width(&edges[place - 1..]) };
        (U::new(width.into()), U::new(edges[place].into()))
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
    /// Goes on with a pass, or begins one. A fit goes over the bins with light of a cover glass first, and with two
    /// echoes over the later bins last.
    pub(super) fn pass(&self, i: &In, p: &Params, d: &mut Self) {
        let glass = p.glass.bins() as u64;
        if i.pass {
            (d.passing, d.opening, d.tailing, d.scanning) = (true, true, false, i.scan);
            d.blank = false;
            d.in_glass = glass > 0 && !i.scan;
            d.in_later = false;
            d.index = if i.scan || glass > 0 { U::new(0) } else { i.fit_begin };
            d.tail = U::new(0);
        } else if self.passing && i.phase {
            d.opening = false;
            let (at_begin, at_end) = (self.index == i.fit_begin, self.index == i.fit_end);
            let past_end = self.index >= if self.in_later { i.later_end } else { i.fit_end };
            let last = match (self.scanning, p.has_more_light()) {
                (true, _) => self.index == p.histogram.bins as u64,
                (false, false) => at_end,
                (false, true) => past_end,
            };
            let is_narrow = !p.has_more_light();
            if self.in_glass && !self.opening && self.index == glass {
                (d.in_glass, d.opening) = (false, true);
                d.index = self.index.max(i.fit_begin);
            } else if self.in_glass || !last || self.opening && (self.scanning || is_narrow) {
                d.index = self.index + 1;
                d.bin = U::new(self.index.get() % p.histogram.bins as u64);
                if at_begin || at_end {
                    d.blank = self.scanning && !at_end && is_narrow;
                }
            } else if p.has_second() && i.wide && !self.scanning && !self.in_later {
                (d.in_later, d.opening) = (true, true);
                d.index = self.index.max(i.later_begin);
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
    pub(super) fn read(&self, i: &In, p: &Params, kept: &Kept, d: &mut Self) {
        let bin = self.passing && !self.opening && !self.tailing;
        d.read_bin = bin && !self.blank;
        d.read_rest = self.passing && self.tailing && !self.scanning;
        d.read_edge = self.passing && self.opening;
        d.read_slide = self.passing && self.scanning && !self.opening;
        d.read_first = self.index == if self.opening { 0 } else { 1 };
        (d.read_ended, d.read_waiting, d.read_exposure) = (kept.ended, kept.waiting, kept.exposure);
        d.read_glass = U::new(p.glass.part(self.bin.index()) as u64);
        d.read_window = bin && self.bin.get() == i.fit_begin.get();
        d.read_later = p.has_second() && bin && self.bin.get() == i.later_begin.get();
    }

    /// Hands a bin on, or all others; a bin without width is none.
    pub(super) fn word(&self, p: &Params, d: &mut Self) {
        d.word_bin = self.read_bin && self.fetched_width != 0;
        (d.word_rest, d.word_edge, d.word_first) =
            (self.read_rest, self.read_edge, self.read_first);
        d.word_slide = self.read_slide;
        d.word_glass = if self.read_bin { self.read_glass } else { U::new(0) };
        d.word_window = self.read_window;
        d.word_later = self.read_later;
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

    /// Sums over all bins and over the rest of them, with one adder: blocks are added to all. With a bin of a pass they
    /// change places twice, and it is subtracted from the rest on the way.
    pub(super) fn subtract(&self, i: &In, d: &mut Self) {
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
}
