//! Parts of a page that is one HTML file with all in it, without scripts, and XML too.

pub mod html;
pub mod plot;
pub mod timing;
pub mod trace;
