//! Accepts connections, and bounds those that have not shown the token.
//!
//! A connection has a descriptor from its start, but only its first request tells whether it is the page's. The newest
//! connection therefore replaces the oldest one without an admitted request, so that connections that never send one
//! cannot lock the page out.

use std::collections::VecDeque;
use std::io::{Error, ErrorKind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use axum::{Extension, Router};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};
use tokio::task::AbortHandle;

/// Largest number of connections without an admitted request.
const MOST_STRANGERS: usize = 16;
/// Longest time until a connection has sent its first or next request.
const LONGEST_SILENCE: Duration = Duration::from_secs(5);
/// Pause after a connection could not be accepted, in which another one is closed.
const PAUSE: Duration = Duration::from_millis(10);

/// Whether a connection has sent an admitted request.
#[derive(Clone, Default)]
pub struct Admission(Arc<AtomicBool>);

impl Admission {
    /// Marks the connection as the page's.
    pub fn admit(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    fn is_admitted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Serves connections until the program ends.
pub async fn serve(listener: TcpListener, app: Router) -> ! {
    let mut strangers = Strangers::default();
    loop {
        match listener.accept().await {
            Ok((stream, _)) => strangers.add(stream, &app),
            Err(error) if is_of_peer(&error) => {}
            // Descriptors are scarce.
            Err(_) => {
                strangers.close_oldest();
                tokio::time::sleep(PAUSE).await;
            }
        }
    }
}

/// Returns whether the peer closed the connection before it was accepted.
fn is_of_peer(error: &Error) -> bool {
    matches!(error.kind(), ErrorKind::ConnectionAborted | ErrorKind::ConnectionReset)
}

/// Connections without an admitted request, oldest first.
#[derive(Default)]
struct Strangers(VecDeque<(AbortHandle, Admission)>);

impl Strangers {
    fn add(&mut self, stream: TcpStream, app: &Router) {
        self.0.retain(|(task, admission)| !task.is_finished() && !admission.is_admitted());
        if self.0.len() == MOST_STRANGERS {
            self.close_oldest();
        }
        let admission = Admission::default();
        let app = app.clone().layer(Extension(admission.clone()));
        let connection = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(LONGEST_SILENCE)
            .serve_connection(TokioIo::new(stream), TowerToHyperService::new(app));
        // A connection that fails concerns its peer only.
        let task = tokio::spawn(async { drop(connection.await) });
        self.0.push_back((task.abort_handle(), admission));
    }

    fn close_oldest(&mut self) {
        if let Some((task, _)) = self.0.pop_front() {
            task.abort();
        }
    }
}
