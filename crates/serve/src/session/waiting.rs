//! Requests that wait for a number of frames.

use tofsim::error::{Input, Result};

use super::Session;
use super::batch::Batch;

impl Session {
    /// Begins a number of frames.
    pub(super) fn begin_batch(&mut self, frames: u32) -> Result<()> {
        if let Some(fault) = &self.fault {
            return Err(Input::new("run", fault).into());
        }
        self.batch = Some(Batch { frames, done: 0, begun: self.live.device().cycle() });
        self.running = true;
        Ok(())
    }

    /// Counts a frame if one has ended; ends the batch after its last frame, or if a frame does not end.
    pub(super) fn count(&mut self, frame_ended: bool) {
        let cycle = self.live.device().cycle();
        let Some(batch) = &mut self.batch else { return };
        if frame_ended {
            (batch.done, batch.begun) = (batch.done + 1, cycle);
            if batch.done == batch.frames {
                self.end_batch(Ok(()));
            }
        } else if cycle - batch.begun > self.live.setup().longest_run(1) {
            let held = self.held().unwrap_or("the control signals keep it from ending");
            self.end_batch(
                Err(Input::new("run", format!("the frame does not end: {held}")).into()),
            );
        }
    }

    /// Ends a batch because of another request to run or stop.
    pub(super) fn interrupt_batch(&mut self) {
        if let Some(Batch { frames, done, .. }) = self.batch {
            let expected = format!("stopped by another request after {done} of {frames} frames");
            self.end_batch(Err(Input::new("run", expected).into()));
        }
    }

    /// Stops the run if it was running for a batch.
    pub(super) fn end_batch(&mut self, outcome: Result<()>) {
        if self.batch.take().is_some() {
            self.batch_end = Some(outcome);
            self.running = false;
        }
    }
}
