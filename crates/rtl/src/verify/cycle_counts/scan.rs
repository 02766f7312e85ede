//! The rows and columns of an array, as far as cycle counts depend on them.

use tofsim::firmware::frame_ctrl::timing::RowTiming;
use tofsim::firmware::frame_ctrl::{FrameCtrl, In, Params};
use tofsim::kernel::Clocked;
use tofsim::sim::setup::Setup;

use super::measured::Measured;

/// An array under shots and estimates that take as long as promised.
#[derive(Clone, Copy, Debug)]
pub struct CountedScan {
    /// Frame length, rows, columns and banks.
    pub frame_ctrl: Params,
    /// From start to start [cycles of clk_sys].
    pub laser_period: u64,
    /// From the edge that takes `algo_start` to the one that raises `algo_done` [cycles of clk_sys].
    pub estimator_cycles: u64,
}

impl CountedScan {
    /// Returns the array of a design; none of a single pixel.
    pub fn of(setup: &Setup) -> Option<Self> {
        let frame_ctrl = setup.params.frame_ctrl;
        (!frame_ctrl.scan.is_single()).then(|| CountedScan {
            frame_ctrl,
            laser_period: setup.laser_period(),
            estimator_cycles: setup.params.estimator_cycles(),
        })
    }

    /// Returns the promised cycles.
    pub fn timing(&self) -> RowTiming {
        self.frame_ctrl.timing(self.laser_period, self.estimator_cycles)
    }

    /// The macros that say how large the array is and how long its parts take.
    pub fn defines(&self) -> Vec<(&'static str, String)> {
        let (Params { histogram, scan, .. }, timing) = (self.frame_ctrl, self.timing());
        let numbers = [
            ("BINS", histogram.bins as u64),
            ("ROWS", scan.rows.into()),
            ("COLUMNS", scan.columns.into()),
            ("BANKS", scan.banks.into()),
            ("SHOTS", self.frame_ctrl.shots_per_frame.into()),
            ("PERIOD", self.laser_period),
            ("DRAIN", self.frame_ctrl.drain_cycles),
            ("ESTIMATE", self.estimator_cycles),
            ("ROW", timing.row),
            ("IMAGE", timing.image),
            ("LATENCY", timing.latency),
        ];
        numbers.map(|(name, number)| (name, number.to_string())).into()
    }

    /// Counts the cycles of rows and of an image in the model, and those from the fall of `acquire` to a row's last
    /// depth, as the bench does.
    pub fn measure(&self, measured: &mut Measured) {
        let (p, scan) = (&self.frame_ctrl, &self.frame_ctrl.scan);
        let (mut ctrl, mut since, mut working) = (FrameCtrl::default(), 0, 0);
        let (mut rows, mut row_at, mut image, mut ended, mut handed) = (0, 0, (0, 0), 0, 0);
        for cycle in 0..self.timing().image + 3 * self.timing().row {
            if ctrl.clear && ctrl.clear_addr == 0 {
                if rows > 1 {
                    measured.add("row_cycles", cycle - row_at);
                }
                if rows == 1 {
                    image = (cycle, ctrl.row.get());
                }
                if rows == scan.rows + 1 {
                    let is_whole = ctrl.row == image.1;
                    measured.add("image_cycles", if is_whole { cycle - image.0 } else { 0 });
                    return;
                }
                (row_at, rows) = (cycle, rows + 1);
            }
            let (start, acquired) = (ctrl.acquire && since == self.laser_period, ctrl.acquire);
            let algo_done = working == self.estimator_cycles + 1;
            if ctrl.algo_start && ctrl.depth_column == 0 {
                handed = ended;
            }
            if algo_done
                && ctrl.depth_column == scan.last_column()
                && (!scan.is_banked() || rows > 2)
            {
                measured.add("depth_latency", cycle - handed);
            }
            since = if start { 1 } else { since + 1 };
            working = match working {
                _ if algo_done => 0,
                0 if !ctrl.algo_start => 0,
                cycles => cycles + 1,
            };
            ctrl = ctrl.next(&In { start, algo_done, dsp_en: true, ..In::default() }, p);
            if !acquired {
                since = 0;
            } else if !ctrl.acquire {
                ended = cycle + 1;
            }
        }
    }
}
