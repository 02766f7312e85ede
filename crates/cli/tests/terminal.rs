//! What a user sees at a terminal, and what an interrupted or killed program leaves.

mod interrupted;
mod long_values;
mod quiet;
mod shown;
