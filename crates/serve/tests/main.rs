//! The page as a browser and its server see it.

mod common;

mod analyser;
mod guard;
mod instrument;
mod load;
mod page;
mod requests;
