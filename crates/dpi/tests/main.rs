//! What a bench sees of the library.

mod header;
