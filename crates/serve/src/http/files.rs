//! Downloads: captures, waveforms, and the run as a scenario.

use axum::extract::{Path, RawQuery, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};

use tofsim::WaveFormat;
use tofsim_captures::ila::export::CaptureFormat;

use super::answers::fault;
use super::requests::ask;
use super::shared::Shared;
use crate::session::request::Request;

/// Returns a file of the capture.
pub async fn ila(State(shared): State<Shared>, Path(ending): Path<String>) -> Response {
    let mut formats = CaptureFormat::ALL.iter().copied();
    match formats.find(|format| format.to_string() == ending) {
        Some(format) => ask(&shared, Request::IlaFile(format)).await,
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

/// Returns the waveform of a shot: `?shot=N` selects the shot of the last frame, `&signals=GLOB,GLOB` the signals.
pub async fn shot(
    State(shared): State<Shared>,
    Path(ending): Path<String>,
    RawQuery(query): RawQuery,
) -> Response {
    let format = match &*ending {
        "vcd" => WaveFormat::Vcd,
        "fst" => WaveFormat::Fst,
        _ => return StatusCode::NOT_FOUND.into_response(),
    };
    match question(query.as_deref().unwrap_or_default()) {
        Ok((shot, signals)) => ask(&shared, Request::Shot { shot, format, signals }).await,
        Err(expected) => fault(StatusCode::BAD_REQUEST, &expected),
    }
}

/// Returns the run so far as a scenario.
pub async fn scenario(State(shared): State<Shared>) -> Response {
    ask(&shared, Request::Scenario).await
}

fn question(query: &str) -> Result<(Option<u64>, Vec<String>), String> {
    let (mut shot, mut signals) = (None, Vec::new());
    for pair in query.split('&').filter(|pair| !pair.is_empty()) {
        match pair.split_once('=') {
            Some(("shot", number)) => {
                let number = number.parse();
                shot = Some(number.map_err(|_| format!("{pair}: expected a whole number"))?);
            }
            Some(("signals", globs)) => {
                signals = globs.split(',').map(str::to_owned).collect();
            }
            _ => return Err(format!("{pair}: expected shot=N or signals=GLOB,GLOB")),
        }
    }
    Ok((shot, signals))
}
