//! What a TDC's stimulus should reach.

use tofsim::firmware::tdc::Params;
use tofsim::firmware::tdc_decoder::code;

use crate::golden::prelude::*;

use super::light::{self, Ages};

/// Last cycle after a start in which there is a reset.
pub(super) const LAST_RESET: usize = 11;

/// Goals, and what has to be remembered for them.
pub(super) struct Goals {
    taps: Cover,
    codes: Cover,
    coarse: Cover,
    rises: Cover,
    resets: Cover,
    corners: Cover,
    last_code: Option<u64>,
    /// Place of physical tap 0 in the order of arrival.
    tap_0: usize,
}

impl Goals {
    /// For hits of those ages.
    pub(super) fn new(ages: &[Ages], params: &Params) -> Self {
        let code_of = |ages: &Ages| {
            Some(code(light::coarse(ages.first), ages.taps as usize, &params.cal)?.get())
        };
        Goals {
            taps: Cover::new("taps of a hit", ages.iter().map(|ages| ages.taps)),
            codes: Cover::new("codes", ages.iter().filter_map(code_of)),
            coarse: Cover::new("coarse of a hit", 0..8),
            rises: Cover::new("edges from the one of start to the one that sees a rise", 0..10),
            resets: Cover::new("reset in cycle after start", 0..=LAST_RESET as u64),
            corners: Cover::new(
                "level held over, second hit, hit kept with start, last edge, equal codes",
                0..5,
            ),
            last_code: None,
            tap_0: params.delays.tap_0_position(),
        }
    }

    /// What has come to pass, so many cycles after the last start; the taps of a hit, if one has been
    /// counted.
    pub(super) fn see(
        &mut self,
        since: usize,
        start: bool,
        rst: bool,
        top: &TofTop,
    ) -> Option<u64> {
        let (latch, decoder) = (&top.tdc.tdc_latch, &top.tdc.tdc_decoder);
        let (window, coarse) = (top.tdc.coarse_counter.window, top.tdc.coarse_counter.coarse);
        let high = top.tdc.carry_chain.taps.tap(self.tap_0);
        let (used, before) = latch.before();
        let rise = high && !before && !rst;
        if let Some(edges) = since.checked_sub(1) {
            self.rises.see_if(rise, edges as u64);
        }
        self.resets.see_if(rst, if start { 0 } else { since as u64 });
        self.corners.see_if(start && high && before, 0);
        self.corners.see_if(rise && window && used, 1);
        self.corners.see_if(rise && window && !used && start, 2);
        self.corners.see_if(rise && window && coarse == 7, 3);
        if decoder.tdc_valid {
            let code = decoder.tdc_code.get();
            self.codes.see(code);
            self.corners.see_if(self.last_code == Some(code), 4);
            self.last_code = Some(code);
        }
        let (taps, coarse) = decoder.decoding().filter(|_| !rst)?;
        self.taps.see(taps);
        self.coarse.see(coarse);
        Some(taps)
    }

    /// All of them.
    pub(super) fn coverage(self) -> Vec<Cover> {
        vec![self.taps, self.codes, self.coarse, self.rises, self.resets, self.corners]
    }
}
