//! The host's side of a board: its registers over a serial port.
//!
//! [`uartbone`] is the protocol, [`Board`] a board whose registers have names. `csr` writes the map in the form that
//! LiteX's own tools read.

pub mod board;
mod control;
pub mod csr;
mod density;
mod frames;
pub mod identity;
pub mod names;
pub mod port;
mod series;
pub mod uartbone;

pub use board::Board;
pub use control::LaserState;
pub use identity::Identity;
pub use port::PortOptions;
pub use series::{check_frames, dark_note};
