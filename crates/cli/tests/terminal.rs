//! Tests of the output on a terminal, and of the files left by an interrupted or killed program.

mod help;
mod interrupted;
mod long_values;
mod quiet;
mod shown;
