//! Ways to advance a run that are not the plain step, [`Device::step`](super::device::Device::step), and give the
//! same.
//!
//! Each says when it is exact and is compared with the plain step in `tests/`. They work on registers that
//! everybody can read; no block of the firmware knows of them, and of a run only
//! [`stepping`](super::stepping), which chooses among them.

mod acquisition;
mod binomial;
mod draws;
mod frame_end;
mod halves;
pub mod histogram;
mod hits;
mod idle;
mod many;
mod multinomial;
mod outcomes;
mod pulse;
mod shots;
mod steady;

pub use acquisition::acquire;
pub use frame_end::leap_frame_end;
pub use idle::skip_idle;
pub use outcomes::{NO_CODE, NO_HIT, ShotOutcome, ShotOutcomes};
pub use shots::{Tables, leap_shots};
