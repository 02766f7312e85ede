//! Sources of frames: a simulated run, images of an array, or a board.

use std::sync::Arc;

use tofsim::error::Result;

use super::reply::Reply;
use super::request::Request;

/// Source of the frames that browsers see, and the requests that act on it.
pub trait Source: Send {
    /// Returns the state as JSON, with an increased version.
    fn state(&mut self) -> Arc<str>;

    /// Carries out a request.
    ///
    /// # Errors
    /// If the request is invalid; it then has no effect.
    fn answer(&mut self, request: Request) -> Result<Reply>;

    /// Returns whether frames are taken rather than stopped.
    fn is_running(&self) -> bool;

    /// Returns whether the control signals prevent the frame from ending.
    fn is_held(&self) -> bool;

    /// Returns the completed fraction of the present frame [1].
    fn part_of_frame(&self) -> f64;

    /// Goes on for up to `cycles` cycles where they are simulated, or to the end of a frame; returns whether a frame
    /// ended.
    fn advance(&mut self, cycles: u64) -> bool;

    /// Returns whether a request waits for frames.
    fn has_batch(&self) -> bool;

    /// Returns the outcome of a batch that has ended, once.
    fn take_batch_end(&mut self) -> Option<Result<()>>;
}
