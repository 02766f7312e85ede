//! The histograms and converters of an array beside those of a single pixel.

use crate::firmware::histogram_builder::{self, Count, HistogramBuilder, Place};
use crate::kernel::U;

use super::{Params, TofTop, Wires};

impl Params {
    /// Returns the place of a histogram.
    #[inline(always)]
    fn place(&self, column: usize, bank: usize) -> Place {
        Place { scan: self.frame_ctrl.scan, column: column as u64, bank: bank == 1 }
    }
}

impl TofTop {
    /// Takes the edge's part of the histograms of an array, and of the converters of all columns but the first.
    #[inline(never)]
    pub(super) fn scan(&mut self, p: &Params) {
        let (tdc, histogram) = (Wires::tdc(self), Wires::histogram_builder(self));
        self.histogram_builder.tick(&histogram.at(&p.place(0, 0)), &p.histogram);
        if p.frame_ctrl.scan.banks > 1 {
            self.second_bank.tick(&histogram.at(&p.place(0, 1)), &p.histogram);
        }
        for (column, channel) in (1..).zip(&mut self.channels) {
            let decoder = &channel.tdc.tdc_decoder;
            let (tdc_valid, tdc_code) = (decoder.tdc_valid, decoder.tdc_code);
            let own = histogram_builder::In { tdc_valid, tdc_code, ..histogram };
            for (bank, histogram) in channel.banks.iter_mut().enumerate() {
                histogram.tick(&own.at(&p.place(column, bank)), &p.histogram);
            }
            channel.tdc.rise(&tdc, p.tdc_of(column), channel.sampled);
        }
    }

    /// Returns the word that is read, of whichever histogram it is.
    #[inline(never)]
    pub(super) fn shown(&self, p: &Params) -> Count {
        let i = Wires::histogram_builder(self);
        let count = |column: usize, bank: usize, histogram: &HistogramBuilder| {
            histogram.count(&i.at(&p.place(column, bank))).get()
        };
        let first = [&self.histogram_builder, &self.second_bank];
        let first = first.into_iter().take(p.frame_ctrl.scan.banks as usize);
        let first = first.enumerate().map(|(bank, histogram)| count(0, bank, histogram));
        let others = (1..).zip(&self.channels).flat_map(|(column, channel)| {
            let banks = channel.banks.iter().enumerate();
            banks.map(move |(bank, histogram)| count(column, bank, histogram))
        });
        U::new(first.chain(others).fold(0, |all, one| all | one))
    }
}
