//! The record of what Yosys made of the Verilog, so that it is made again only of other Verilog.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::{env, fs};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use tofsim::files::digest::digest;
use tofsim_rtl::timing::versions::version;
use tofsim_rtl::verify::process::YOSYS;

use crate::common;

use super::yosys::Sources;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/synthesis/netlists.json");

/// The version that the record is of: each makes other netlists.
pub const MAKER: &str = "Yosys 0.23";

/// A result, and the digest of the script and the sources.
#[derive(Serialize, Deserialize)]
struct Entry {
    of: String,
    result: Value,
}

/// One test writes at a time.
static WRITING: Mutex<()> = Mutex::new(());

/// The result of that name: the recorded one if its script and sources are those of the record, otherwise what `make`
/// makes of them. The record of other sources is a failure, as its results are unknown until it is written anew.
pub fn recorded<T: Serialize + DeserializeOwned>(
    name: &str,
    script: &str,
    sources: &Sources,
    make: impl FnOnce() -> T,
) -> T {
    if version(YOSYS, "-V", common::empty().path()).unwrap() != MAKER {
        return make();
    }
    let of = digest_of(script, sources);
    let found = read().remove(name).filter(|entry| entry.of == of);
    match found {
        Some(entry) => serde_json::from_value(entry.result).unwrap(),
        None if env::var_os("UPDATE_DOCS").is_some() => {
            let made = make();
            write(name, Entry { of, result: serde_json::to_value(&made).unwrap() });
            made
        }
        None => panic!(
            "{name} in {FILE} is of other Verilog: UPDATE_DOCS=1 cargo test -p tofsim-cli --test cli synthesis -- \
             --include-ignored"
        ),
    }
}

fn read() -> BTreeMap<String, Entry> {
    serde_json::from_str(&fs::read_to_string(FILE).unwrap()).unwrap()
}

fn write(name: &str, entry: Entry) {
    let _alone = WRITING.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let mut all = read();
    all.insert(name.to_owned(), entry);
    fs::write(FILE, serde_json::to_string_pretty(&all).unwrap() + "\n").unwrap();
}

/// Comments and layout of the Verilog make no difference.
fn digest_of(script: &str, sources: &Sources) -> String {
    let mut found = digest(0, script.as_bytes());
    for (name, text) in sources {
        found = digest(found, name.as_bytes());
        let code = text.lines().filter_map(|line| line.split("//").next()).map(str::trim);
        for line in code.filter(|line| !line.is_empty()) {
            found = digest(found, line.as_bytes());
        }
    }
    format!("{found:016x}")
}

#[test]
fn a_comment_leaves_the_digest_and_code_changes_it() {
    let of = |text: &str| digest_of("synth", &Sources::from([("a.v".to_owned(), text.to_owned())]));
    assert_eq!(of("  wire a;  // one\n"), of("wire a;\n// another\n"));
    assert_ne!(of("wire a;"), of("wire b;"));
}
