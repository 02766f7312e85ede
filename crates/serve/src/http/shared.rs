//! What handlers work with.

use std::sync::Arc;

use tokio::sync::Semaphore;

use crate::engine::Engine;

/// What handlers work with.
#[derive(Clone)]
pub struct Shared {
    /// Who simulates.
    pub engine: Engine,
    /// Places for browsers that follow the run.
    pub followers: Arc<Semaphore>,
}
