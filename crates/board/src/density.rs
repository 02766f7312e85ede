//! The code density: hits of each `n` by a ring oscillator that is uncorrelated with the clock.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use tofsim::error::{Input, Result, poll_stop};
use tofsim::firmware::registers::map::{
    CODE_DENSITY, CONTROL, DENSITY_CLEAR, DENSITY_HITS, DSP_EN, DSP_RST, FRAMES_PERMITTED, RING_ON,
};
use tofsim::sim::setup::Setup;

use crate::board::Board;

impl Board {
    /// Counts at least so many hits of the ring oscillator, with the laser off, and returns how many of them had each
    /// `n`. Frames are held back afterwards. `counted` is told the number of hits so far.
    ///
    /// # Errors
    /// When the board does not answer, the ring gives no hits, or the counts do not add up; and when `stop` is set.
    pub fn code_density(
        &mut self,
        setup: &Setup,
        hits: u32,
        stop: Option<&AtomicBool>,
        counted: &mut dyn FnMut(u32),
    ) -> Result<Vec<u64>> {
        self.check_switch()?;
        self.laser_off()?;
        self.write_checked(&FRAMES_PERMITTED, 0)?;
        self.clear_density()?;
        self.write_checked(&CONTROL, RING_ON.with(DSP_EN.with(0, 1), 1))?;
        let total = self.wait_for_hits(hits, stop, counted);
        // The TDC is in reset while frames are held back, so that the counts keep still.
        self.write_checked(&CONTROL, DSP_RST.with(0, 1))?;
        total?;
        let total = self.read_word(&DENSITY_HITS)?;
        let words = setup.params.tdc.delays.taps() + 1;
        let counts = self.read_words(CODE_DENSITY.name, CODE_DENSITY.address, words)?;
        let sum: u64 = counts.iter().map(|&count| u64::from(count)).sum();
        if sum == u64::from(total) || total == u32::MAX {
            return Ok(counts.into_iter().map(u64::from).collect());
        }
        let expected = format!("expected {total}, as {} says", DENSITY_HITS.name);
        let field = format!("sum of {}", CODE_DENSITY.name);
        Err(Input::new(self.port(), expected).field(field).value(sum).into())
    }

    fn clear_density(&mut self) -> Result<()> {
        self.write(&DENSITY_CLEAR, 1)?;
        let begun = Instant::now();
        while self.read_word(&DENSITY_CLEAR)? != 0 {
            if begun.elapsed() > self.patience() {
                let expected = format!("expected 0 within {} s", self.patience().as_secs_f64());
                let fault = Input::new(self.port(), expected).field(DENSITY_CLEAR.name);
                return Err(fault.value(1).into());
            }
        }
        Ok(())
    }

    fn wait_for_hits(
        &mut self,
        hits: u32,
        stop: Option<&AtomicBool>,
        counted: &mut dyn FnMut(u32),
    ) -> Result<()> {
        let (mut before, mut last) = (0, Instant::now());
        loop {
            poll_stop(stop)?;
            let now = self.read_word(&DENSITY_HITS)?;
            counted(now.min(hits));
            if now >= hits {
                return Ok(());
            }
            if now != before {
                (before, last) = (now, Instant::now());
            } else if last.elapsed() > self.patience() {
                let expected = format!(
                    "expected {hits}: the ring gave no hit for {} s",
                    self.patience().as_secs_f64()
                );
                let fault = Input::new(self.port(), expected).field(DENSITY_HITS.name);
                return Err(fault.value(now).into());
            }
        }
    }
}
