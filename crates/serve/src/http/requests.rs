//! Handlers of the JSON requests that act on the run.

use axum::body::Bytes;
use axum::extract::State;
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use serde::de::DeserializeOwned;

use super::answers::{attachment, fault};
use super::shared::Shared;
use crate::engine::RequestError;
use crate::session::Reply;
use crate::session::request::Request;

/// Returns the state.
pub async fn state(State(shared): State<Shared>) -> Response {
    ask(&shared, Request::State).await
}

/// Returns the last image.
pub async fn image(State(shared): State<Shared>) -> Response {
    ask(&shared, Request::Image).await
}

/// Starts, stops, runs a number of frames, or restarts at power-up.
pub async fn run(State(shared): State<Shared>, body: Bytes) -> Response {
    read(&shared, "run", &body, Request::Run).await
}

/// Changes control signals.
pub async fn control(State(shared): State<Shared>, body: Bytes) -> Response {
    read(&shared, "control", &body, Request::Control).await
}

/// Changes the scene.
pub async fn scene(State(shared): State<Shared>, body: Bytes) -> Response {
    read(&shared, "scene", &body, Request::Scene).await
}

/// Arms or disarms the logic analyser.
pub async fn ila(State(shared): State<Shared>, body: Bytes) -> Response {
    read(&shared, "ila", &body, Request::Ila).await
}

async fn read<T: DeserializeOwned>(
    shared: &Shared,
    what: &str,
    body: &[u8],
    request: impl FnOnce(T) -> Request,
) -> Response {
    match serde_json::from_slice(body) {
        Ok(read) => ask(shared, request(read)).await,
        Err(error) => fault(StatusCode::BAD_REQUEST, &format!("{what}: {error}")),
    }
}

/// Sends a request to the simulating thread, and returns its answer.
pub async fn ask(shared: &Shared, request: Request) -> Response {
    match shared.engine.ask(request).await {
        Ok(Reply::State(json) | Reply::Image(json)) => {
            ([(CONTENT_TYPE, "application/json")], json.to_string()).into_response()
        }
        Ok(Reply::File(file)) => attachment(&file),
        Err(RequestError::Refused(error)) => fault(StatusCode::BAD_REQUEST, &error.to_string()),
        Err(RequestError::Busy) => fault(StatusCode::SERVICE_UNAVAILABLE, "too many requests wait"),
        Err(RequestError::Disconnected) => {
            fault(StatusCode::INTERNAL_SERVER_ERROR, "the simulation has ended")
        }
    }
}
