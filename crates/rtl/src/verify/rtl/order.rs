//! Which files are compiled, and in which order.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use tofsim::error::{Input, Result};

use super::scan::Scan;
use super::{Rtl, Source};

/// The files for something that names `roots`; see [`Rtl::needed`].
pub fn needed<'a>(rtl: &'a Rtl, roots: &BTreeSet<String>) -> Result<Vec<&'a Source>> {
    let chosen = choose(rtl, roots);
    let chosen: Vec<_> = rtl.files.iter().filter(|file| chosen.contains(&file.path)).collect();
    duplicates(rtl, &chosen)?;
    packages_first(rtl, &chosen)
}

/// What a file names, with what the files name that it includes.
fn words(rtl: &Rtl, source: &Source) -> Included {
    let mut all = Included::default();
    all.add(rtl, &source.path, &source.scan);
    all
}

#[derive(Default)]
struct Included {
    words: BTreeSet<String>,
    scopes: BTreeSet<String>,
    files: BTreeSet<PathBuf>,
}

impl Included {
    fn add(&mut self, rtl: &Rtl, path: &Path, scan: &Scan) {
        self.words.extend(scan.words.iter().cloned());
        self.scopes.extend(scan.scopes.iter().cloned());
        let own = path.parent().map(Path::to_owned);
        for name in &scan.includes {
            let folders = own.iter().chain(&rtl.options.includes);
            // One that is not there is the simulator's to name.
            let found = folders.map(|folder| folder.join(name)).find(|path| path.is_file());
            let Some(path) = found else { continue };
            if self.files.insert(path.clone())
                && let Ok(bytes) = std::fs::read(&path)
            {
                self.add(rtl, &path, &Scan::verilog(&String::from_utf8_lossy(&bytes)));
            }
        }
    }
}

/// Paths of the files that are compiled.
fn choose(rtl: &Rtl, roots: &BTreeSet<String>) -> BTreeSet<PathBuf> {
    let mut declared = BTreeMap::<&str, Vec<&Source>>::new();
    for file in &rtl.files {
        let names = file.scan.modules.iter().map(|module| module.name.as_str());
        for name in names.chain(file.scan.packages.iter().map(String::as_str)) {
            declared.entry(name).or_default().push(file);
        }
    }
    // A file without a module has macros or types that any other may use.
    let always = |file: &&Source| {
        !file.found || file.scan.modules.is_empty() && file.scan.packages.is_empty()
    };
    let mut open: Vec<&Source> = rtl.files.iter().filter(always).collect();
    let of = |words: &BTreeSet<String>| -> Vec<&Source> {
        words.iter().filter_map(|word| declared.get(word.as_str())).flatten().copied().collect()
    };
    open.extend(of(roots));
    let mut chosen = BTreeSet::new();
    while let Some(file) = open.pop() {
        if chosen.insert(file.path.clone()) {
            open.extend(of(&words(rtl, file).words));
        }
    }
    chosen
}

/// Whether no two files declare the same module; one under a condition is the simulator's to judge.
fn duplicates(rtl: &Rtl, files: &[&Source]) -> Result<()> {
    let mut first = BTreeMap::new();
    for file in files {
        for module in file.scan.modules.iter().filter(|module| !module.conditional) {
            let other = first.entry(&module.name).or_insert(&file.path);
            if **other != file.path {
                let [one, two] = [&**other, &file.path].map(|path| path.display().to_string());
                let expected = format!("expected it in one file, found it in {one} and in {two}");
                let fault = Input::new(&rtl.source, expected).field("module");
                return Err(fault.value(&module.name).into());
            }
        }
    }
    Ok(())
}

/// The files in their order, but each after those with the packages that it names, and after those without
/// any module.
fn packages_first<'a>(rtl: &Rtl, files: &[&'a Source]) -> Result<Vec<&'a Source>> {
    let named: Vec<_> = files.iter().map(|file| words(rtl, file).scopes).collect();
    let mut order = Order {
        rtl,
        files,
        named: &named,
        state: vec![State::Open; files.len()],
        done: Vec::new(),
    };
    let is_common =
        |file: &Source| file.found && file.scan.modules.is_empty() && file.scan.packages.is_empty();
    let (common, others): (Vec<_>, Vec<_>) = (0..files.len()).partition(|k| is_common(files[*k]));
    for k in common.into_iter().chain(others) {
        if order.state[k] == State::Open {
            order.visit(k)?;
        }
    }
    Ok(order.done)
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    Open,
    Begun,
    Done,
}

struct Order<'a, 'b> {
    rtl: &'b Rtl,
    files: &'b [&'a Source],
    named: &'b [BTreeSet<String>],
    state: Vec<State>,
    done: Vec<&'a Source>,
}

impl Order<'_, '_> {
    fn visit(&mut self, k: usize) -> Result<()> {
        self.state[k] = State::Begun;
        let files = self.files;
        for other in (0..files.len()).filter(|other| *other != k) {
            let mut packages = files[other].scan.packages.iter();
            let Some(package) = packages.find(|package| self.named[k].contains(*package)) else {
                continue;
            };
            match self.state[other] {
                State::Done => {}
                State::Open => self.visit(other)?,
                State::Begun => {
                    let [one, two] = [k, other].map(|k| files[k].path.display().to_string());
                    let expected = format!(
                        "expected packages that do not need each other; {one} needs it, and {two}, which \
                         has it, needs what is in {one}"
                    );
                    let fault = Input::new(&self.rtl.source, expected).field("package");
                    return Err(fault.value(package).into());
                }
            }
        }
        self.state[k] = State::Done;
        self.done.push(files[k]);
        Ok(())
    }
}
