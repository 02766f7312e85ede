//! What a bench sees of the library.

mod abi;
mod c;
mod common;
mod faults;
mod header;
mod refused;
mod whole;
