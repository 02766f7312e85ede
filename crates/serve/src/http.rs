//! The HTTP server: the page, a stream of states, and requests.

mod answers;
mod assets;
mod connections;
mod files;
mod guard;
mod requests;
mod shared;

use std::convert::Infallible;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::{DefaultBodyLimit, State};
use axum::http::StatusCode;
use axum::middleware;
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use tokio::net::TcpListener;
use tokio::sync::Semaphore;
use tokio_stream::StreamExt;
use tokio_stream::wrappers::WatchStream;

use tofsim::error::{Input, Result};

use crate::engine::Engine;
use guard::Guard;
use shared::Shared;

/// Size limit of a request; a probe configuration is by far the longest [bytes].
const LONGEST: usize = 1 << 16;
/// Largest number of browsers that may follow the run at once.
const FOLLOWERS: usize = 32;

/// A server that is ready to run.
pub struct Server {
    listener: TcpListener,
    guard: Arc<Guard>,
    engine: Engine,
}

impl Server {
    /// Binds to a port on the loopback address; port 0 selects any free one.
    ///
    /// # Errors
    /// If the port is taken, or the system has no random numbers.
    pub async fn bind(engine: Engine, port: u16) -> Result<Self> {
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let taken = |error: std::io::Error| Input::new("--port", error).value(port);
        let listener = TcpListener::bind(address).await.map_err(taken)?;
        let port = listener.local_addr().map_err(taken)?.port();
        let guard = Guard::new(port).map_err(|error| Input::new("token", error))?;
        Ok(Server { listener, guard: Arc::new(guard), engine })
    }

    /// Returns the page's URL, including its token.
    pub fn url(&self) -> String {
        self.guard.url()
    }

    /// Serves the page until the program ends.
    pub async fn run(self) -> ! {
        let app = router(self.engine, &self.guard);
        connections::serve(self.listener, app).await
    }
}

fn router(engine: Engine, guard: &Arc<Guard>) -> Router {
    let followers = Arc::new(Semaphore::new(FOLLOWERS));
    let page = Router::new()
        .route("/page/{name}", get(assets::asset))
        .route("/state", get(requests::state))
        .route("/image", get(requests::image))
        .route("/events", get(events))
        .route("/run", post(requests::run))
        .route("/control", post(requests::control))
        .route("/scene", post(requests::scene))
        .route("/ila", post(requests::ila))
        .route("/ila.{ending}", get(files::ila))
        .route("/shot.{ending}", get(files::shot))
        .route("/run.toml", get(files::scenario))
        .with_state(Shared { engine, followers });
    Router::new()
        .route(&format!("{}/", guard.path()), get(assets::index))
        .nest(&guard.path(), page)
        .fallback(|| async { StatusCode::NOT_FOUND })
        .layer(DefaultBodyLimit::max(LONGEST))
        .layer(middleware::from_fn_with_state(Arc::clone(guard), guard::check))
}

/// Streams states as server-sent events, starting with the present one.
async fn events(State(shared): State<Shared>) -> Response {
    let Ok(place) = shared.followers.try_acquire_owned() else {
        let expected = format!("{FOLLOWERS} browsers follow the run already");
        return answers::fault(StatusCode::SERVICE_UNAVAILABLE, &expected);
    };
    let states = WatchStream::new(shared.engine.states());
    let events = states.map(move |state| {
        // Held for as long as the stream is.
        let _ = &place;
        Ok::<_, Infallible>(Event::default().data(&*state))
    });
    let alive = KeepAlive::new().interval(Duration::from_secs(15));
    Sse::new(events).keep_alive(alive).into_response()
}
