//! State shared by all handlers.

use std::sync::Arc;

use tokio::sync::Semaphore;

use crate::engine::Engine;

/// State shared by all handlers.
#[derive(Clone)]
pub struct Shared {
    /// Handle of the simulating thread.
    pub engine: Engine,
    /// Permits for browsers that follow the run.
    pub followers: Arc<Semaphore>,
}
