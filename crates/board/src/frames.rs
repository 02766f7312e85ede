//! Frames, one by one.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use tofsim::error::{Input, Result, poll_stop};
use tofsim::firmware::forward2::Depth;
use tofsim::firmware::registers::map::{
    ESTIMATE_CODE, FRAME, FRAMES, FRAMES_PERMITTED, HISTOGRAM, HITS, HOLD, SHOTS, STATUS_BITS,
};
use tofsim::firmware::tof_top::slot::{EstimateWords, SecondWords};
use tofsim::firmware::tof_top::status_code::StatusCode;
use tofsim::kernel::U;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;

use crate::board::Board;
use crate::names::set_bits;

/// Words from `hold` to `estimate_code`.
const RESULT_WORDS: usize = (ESTIMATE_CODE.address - HOLD.address) as usize + 1;

impl Board {
    /// Begins a series of frames: none is permitted, none is held. Returns the number of the last finished one plus
    /// one.
    ///
    /// # Errors
    /// When the board does not answer.
    pub fn begin_frames(&mut self) -> Result<u32> {
        self.write_checked(&FRAMES_PERMITTED, 0)?;
        self.write_checked(&HOLD, 0)?;
        self.read_word(&FRAME)
    }

    /// Permits one more frame, waits until it has finished, and reads it: depth, sigma, status, histogram.
    /// `before` is the number that [`Board::begin_frames`] returned, or `before + 1` of the frame before.
    ///
    /// The frame gets the number `index`. What a board does not count by frame is 0 in it.
    ///
    /// # Errors
    /// When the board does not answer, no shots are taken any more, or a frame has been missed; and when `stop` is set.
    pub fn next_frame(
        &mut self,
        setup: &Setup,
        (index, before): (u64, u32),
        stop: Option<&AtomicBool>,
    ) -> Result<Frame> {
        self.write(&FRAMES_PERMITTED, 1)?;
        let expected = before.wrapping_add(1);
        self.wait_for_frame(before, stop)?;
        self.write_checked(&HOLD, 1)?;
        let frame = self.read_held(setup, index, expected);
        self.write_checked(&HOLD, 0)?;
        frame
    }

    /// Waits until another frame than that has finished.
    fn wait_for_frame(&mut self, before: u32, stop: Option<&AtomicBool>) -> Result<()> {
        let (mut progress, mut last) = (self.progress()?, Instant::now());
        let mut next_look = self.patience() / 4;
        loop {
            poll_stop(stop)?;
            if self.read_word(&FRAME)? != before {
                return Ok(());
            }
            if last.elapsed() < next_look {
                continue;
            }
            let now = self.progress()?;
            if now != progress {
                (progress, last, next_look) = (now, Instant::now(), self.patience() / 4);
            } else if last.elapsed() > self.patience() {
                return Err(self.stalled(before)?.into());
            } else {
                next_look = self.patience();
            }
        }
    }

    /// Counts that rise while a frame goes on.
    fn progress(&mut self) -> Result<Vec<u32>> {
        debug_assert_eq!([SHOTS.address, HITS.address], [FRAMES.address + 1, FRAMES.address + 2]);
        self.read_words(FRAMES.name, FRAMES.address, 3)
    }

    /// Returns the error that a frame does not go on, and how the firmware is.
    fn stalled(&mut self, before: u32) -> Result<Input> {
        let state = self.laser_state()?;
        let status = set_bits(STATUS_BITS, state.status);
        let status = if status.is_empty() { "none".to_owned() } else { status.join(", ") };
        let expected = format!(
            "expected {}: for {} s neither shots nor hits were counted (status: {status})",
            before.wrapping_add(1),
            self.patience().as_secs_f64()
        );
        Ok(Input::new(self.port(), expected).field(FRAME.name).value(before))
    }

    fn read_held(&mut self, setup: &Setup, index: u64, expected: u32) -> Result<Frame> {
        let words = self.read_words(HOLD.name, HOLD.address, RESULT_WORDS)?;
        let number = words[1];
        if number != expected {
            let expected =
                format!("expected {expected}: a frame was missed, or the board was reset");
            return Err(Input::new(self.port(), expected).field(FRAME.name).value(number).into());
        }
        let wide = |upper: u32, lower: u32| u64::from(upper) << 32 | u64::from(lower);
        let bins = setup.params.histogram.bins;
        let histogram = self.read_words(HISTOGRAM.name, HISTOGRAM.address, bins)?;
        Ok(Frame {
            index,
            laser_en: self.has_laser,
            estimator: setup.params.estimator,
            words: EstimateWords {
                depth: Depth::new(wide(words[2], words[3]) as i64),
                sigma: U::new(wide(words[4], words[5])),
                status: U::new(words[6].into()),
                valid: words[7] == 1,
                code: StatusCode::of_number(words[RESULT_WORDS - 1].into()),
                // The registers hold the first target alone.
                second: SecondWords::default(),
            },
            shots: setup.params.frame_ctrl.shots_per_frame.into(),
            tdc_hits: 0,
            histogram,
            estimator_cycles: 0,
            frame_cycles: 0,
        })
    }
}
