//! Checks of the boards that pass, by the record, as long as what their tools read is the same.

use std::sync::LazyLock;

use crate::record::{Inputs, Record};

/// What the record says of a check that passes.
const PASSES: &str = "passes";

static PASSED: LazyLock<Record> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/board/sound.record");
    Record::read(path, "cargo test -p tofsim-rtl --test rtl board")
});

/// Makes a check of those inputs, unless it is known to pass; it panics if it fails.
pub fn passes(check: &str, inputs: &Inputs, make: impl FnOnce()) {
    let answer = PASSED.answer(check, inputs, || {
        make();
        Ok(PASSES.to_owned())
    });
    assert_eq!(answer, PASSES);
}
