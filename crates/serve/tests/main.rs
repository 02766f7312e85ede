//! Tests of the page, from the browser's and from the server's side.

mod common;

mod analyser;
mod board;
mod guard;
mod image;
mod image_page;
mod instrument;
mod load;
mod page;
mod requests;
