//! Parts of a page that is one HTML file with all in it, without scripts, and XML too.

pub mod document;
pub mod html;
pub mod plot;
pub mod scope;
pub mod timing;
pub mod trace;
pub mod wavejson;
