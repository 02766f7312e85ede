//! Yosys, run only when what it would read has changed.

use std::collections::BTreeMap;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

use tofsim_rtl::verify::process::{Limits, Tool, YOSYS};

use crate::common;

/// Longest run of one program; a busy machine takes some minutes for the core's netlist.
pub const LIMITS: Limits = Limits::new(Duration::from_secs(1200));

/// Yosys takes up to 1 GB and both tests would start it.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Files of `rtl_ref`: name and contents.
pub type Sources = BTreeMap<String, String>;

/// All of `rtl_ref` that a tool reads.
pub fn rtl_ref() -> Sources {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../rtl_ref");
    let files = common::files(&folder).into_iter();
    let files = files.filter(|name| name.ends_with(".v") || name.ends_with(".mem"));
    let text = |name: String| (name.clone(), fs::read_to_string(folder.join(name)).unwrap());
    files.map(text).collect()
}

/// The modules among `sources`, by name.
pub fn modules(sources: &Sources) -> impl Iterator<Item = &str> {
    sources.keys().filter_map(|name| name.strip_suffix(".v"))
}

/// Returns the files that the synthesis of `top` may read: its file, those that its code names, and so on.
pub fn needed(sources: &Sources, top: &str) -> Sources {
    let mut needed = Sources::new();
    let mut open = vec![format!("{top}.v")];
    while let Some(name) = open.pop() {
        let Some(text) = sources.get(&name).filter(|_| !needed.contains_key(&name)) else {
            continue;
        };
        if name.ends_with(".v") {
            for code in text.lines().filter_map(|line| line.split("//").next()) {
                let words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
                open.extend(words.map(|word| format!("{word}.v")));
                let memories = code.split('"').filter_map(|word| word.strip_prefix("rtl_ref/"));
                open.extend(memories.map(str::to_owned));
            }
        }
        needed.insert(name, text.clone());
    }
    needed
}

/// `read_verilog`'s arguments for those modules.
pub fn paths<'a>(modules: impl IntoIterator<Item = &'a str>) -> String {
    let paths: Vec<_> = modules.into_iter().map(|name| format!("rtl_ref/{name}.v")).collect();
    paths.join(" ")
}

/// Runs a tool that must succeed, and returns its output.
pub fn output(tool: Tool, folder: &Path, args: &[&str]) -> String {
    let finished = tool.run(folder, args, &LIMITS).unwrap_or_else(|error| panic!("{error}"));
    let lines: Vec<_> = finished.output.lines().collect();
    let last = lines[lines.len().saturating_sub(20)..].join("\n");
    assert!(finished.success(), "{} {args:?}: {last}", tool.program);
    finished.output
}

/// The folder with what a script writes, which finds the sources in `rtl_ref/`: from the cache in
/// the target folder if the same Yosys has run the same script on the same sources before.
pub fn results(sources: &Sources, script: &str) -> PathBuf {
    let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join("netlists");
    fs::create_dir_all(&cache).unwrap();
    let mut hasher = DefaultHasher::new();
    (output(YOSYS, &cache, &["-V"]), script, sources).hash(&mut hasher);
    let folder = cache.join(format!("{:016x}", hasher.finish()));
    if !folder.exists() {
        let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if !folder.exists() {
            make(sources, script, &cache, &folder);
        }
    }
    folder
}

/// Runs the script beside the cache's folders, then gives what it wrote its place.
fn make(sources: &Sources, script: &str, cache: &Path, folder: &Path) {
    let work = tempfile::tempdir_in(cache).unwrap();
    let inputs = work.path().join("rtl_ref");
    fs::create_dir(&inputs).unwrap();
    for (name, text) in sources {
        fs::write(inputs.join(name), text).unwrap();
    }
    fs::write(work.path().join("script.ys"), script).unwrap();
    output(YOSYS, work.path(), &["-q", "-s", "script.ys"]);
    fs::remove_dir_all(&inputs).unwrap();
    // Another process may have been first.
    if let Err(error) = fs::rename(work.path(), folder) {
        assert!(folder.exists(), "{}: {error}", folder.display());
    }
}
