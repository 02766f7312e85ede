//! Answers to browsers.

use std::sync::Arc;

use super::file::File;

/// Answer to a request.
#[derive(Clone, Debug)]
pub enum Reply {
    /// The state as JSON.
    State(Arc<str>),
    /// An image as JSON.
    Image(Arc<str>),
    /// A file to save.
    File(File),
}
