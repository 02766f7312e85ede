//! A number of frames that a request waits for.

/// A number of frames, after which the run stops.
#[derive(Clone, Copy, Debug)]
pub struct Batch {
    /// Frames in all.
    pub frames: u32,
    /// Frames that have ended.
    pub done: u32,
    /// Cycle in which the present frame began, or the batch if that came later.
    pub begun: u64,
}
