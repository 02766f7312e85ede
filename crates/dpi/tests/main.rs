//! Tests of the library as a bench sees it.

mod abi;
mod c;
mod common;
mod faults;
mod header;
mod refused;
mod whole;
