//! Statistics of the frames of a run.

use tofsim::sim::frames::Frame;

use crate::echo::EchoShift;
use crate::figure::Figure;

/// Statistics of the frames of a run.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Hits in the histograms.
    pub hits: Counts,
    /// Hits that the TDC registered.
    pub tdc_hits: Counts,
    /// Hits around the echo.
    pub echo: EchoShift,
    /// Duration of the last frame's estimation [cycles of `clk_sys`].
    pub estimator_cycles: f64,
    /// Duration of the last frame [cycles of `clk_sys`].
    pub frame_cycles: f64,
    /// Duration of the last frame [ms].
    pub frame_ms: f64,
    /// Period of `clk_sys` [ms].
    pub cycle_ms: f64,
}

impl Tally {
    /// Adds a frame.
    pub fn take(&mut self, frame: &Frame) {
        self.hits.add(frame.hits());
        self.tdc_hits.add(frame.tdc_hits);
        if frame.laser_en {
            self.echo.take(frame);
        }
        self.estimator_cycles = frame.estimator_cycles as f64;
        self.frame_cycles = frame.frame_cycles as f64;
        self.frame_ms = self.frame_cycles * self.cycle_ms;
    }
}

/// Sums of integers and of their squares, which do not depend on the order of summation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    count: u64,
    sum: u128,
    squares: u128,
}

impl Counts {
    fn add(&mut self, number: u64) {
        self.count += 1;
        self.sum += u128::from(number);
        self.squares += u128::from(number) * u128::from(number);
    }

    /// Returns the mean.
    pub fn mean(&self) -> Figure {
        let (count, sum) = (self.count as f64, self.sum as f64);
        if self.count == 0 {
            return Figure::default();
        }
        // Exact as long as the product fits, which it does for 10^9 frames of 2^24 hits.
        let scatter = (u128::from(self.count) * self.squares).saturating_sub(self.sum * self.sum);
        let se = (self.count > 1).then(|| (scatter as f64 / (count - 1.0)).sqrt() / count);
        Figure::new(Some(sum / count), se)
    }
}
