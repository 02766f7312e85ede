//! Static files of the page, which are built into the program.

use axum::extract::Path;
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use rust_embed::RustEmbed;

#[derive(RustEmbed)]
#[folder = "page/"]
struct Assets;

/// Returns the page.
pub async fn index() -> Response {
    file("index.html")
}

/// Returns a file of the page.
pub async fn asset(Path(name): Path<String>) -> Response {
    file(&name)
}

fn file(name: &str) -> Response {
    let media_type = match name.rsplit_once('.') {
        Some((_, "html")) => "text/html; charset=utf-8",
        Some((_, "css")) => "text/css; charset=utf-8",
        Some((_, "js")) => "text/javascript; charset=utf-8",
        Some((_, "svg")) => "image/svg+xml",
        _ => "application/octet-stream",
    };
    match Assets::get(name) {
        Some(file) => ([(CONTENT_TYPE, media_type)], file.data).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}
