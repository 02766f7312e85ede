//! Faults of the boards' tops by the record, as long as they are of the same Verilog.

use std::fs;
use std::sync::LazyLock;

use crate::record::{Inputs, Record};

use super::{Bench, Board, Fault, common, sources};

/// What the record says of a fault that changes nothing.
pub const NONE: &str = "no difference";

static FOUND: LazyLock<Record> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/board/faults.record");
    Record::read(path, "cargo test -p tofsim-rtl --test rtl a_fault_of_a_board -- --ignored")
});

/// The first difference of a board's trace from the wanted one, with a fault in its design.
pub fn difference(board: Board, fault: &Fault, wanted: &str) -> String {
    let bench = Bench { top: "bench", board: Some(board) };
    let (_, file, old, new) = fault;
    let words = format!("{}: {file}: {old} -> {new}", board.options()[0].trim_start_matches("-D"));
    let check: Vec<_> = words.split_whitespace().collect();
    FOUND.answer(&check.join(" "), &inputs(&bench, Some(fault)).text("wanted", wanted), || {
        super::difference(&bench.run(Some(fault)), wanted).ok_or(NONE.to_owned())
    })
}

/// All that Icarus reads; the design may have a fault.
pub fn inputs(bench: &Bench, fault: Option<&Fault>) -> Inputs {
    let (folder, verilog) = sources(fault);
    let mut inputs =
        Inputs::default().version("iverilog", "-V").text("options", bench.options().join(" "));
    for path in bench.files().iter().chain(&verilog) {
        let name = path.file_name().unwrap().to_string_lossy();
        inputs = inputs.verilog(&name, &fs::read_to_string(path).unwrap());
    }
    for folder in [folder.path(), &folder.path().join("rtl_ref")] {
        for name in common::files(folder).iter().filter(|name| name.ends_with(".mem")) {
            inputs = inputs.text(name, fs::read(folder.join(name)).unwrap());
        }
    }
    inputs
}
