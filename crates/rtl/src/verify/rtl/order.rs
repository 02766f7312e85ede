//! Selects the files to compile, and their order.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use tofsim::error::{Input, Result, read_bytes};

use super::scan::Scan;
use super::source::Source;

/// The Verilog of a design.
#[derive(Clone, Copy, Debug)]
pub struct Tree<'a> {
    /// Its origin, for people.
    pub name: &'a str,
    /// Its files.
    pub files: &'a [Source],
    /// Folders of includes.
    pub includes: &'a [PathBuf],
}

impl<'a> Tree<'a> {
    /// The files for something that names `roots`, in the order in which they are compiled.
    ///
    /// # Errors
    /// When two of them declare the same module, or packages need each other.
    pub fn needed(self, roots: &BTreeSet<String>) -> Result<Vec<&'a Source>> {
        let chosen = choose(&self, roots);
        let chosen: Vec<_> = self.files.iter().filter(|file| chosen.contains(&file.path)).collect();
        duplicates(&self, &chosen)?;
        packages_first(&self, &chosen)
    }

    /// Files that those include, and that these include.
    pub fn included(self, files: &[&Source]) -> BTreeSet<PathBuf> {
        files.iter().flat_map(|file| words(&self, file).files).collect()
    }
}

/// Collects the names in a file and in the files that it includes.
fn words(tree: &Tree, source: &Source) -> Included {
    let mut all = Included::default();
    all.add(tree, &source.path, &source.scan);
    all
}

#[derive(Default)]
struct Included {
    words: BTreeSet<String>,
    scopes: BTreeSet<String>,
    files: BTreeSet<PathBuf>,
}

impl Included {
    fn add(&mut self, tree: &Tree, path: &Path, scan: &Scan) {
        self.words.extend(scan.words.iter().cloned());
        self.scopes.extend(scan.scopes.iter().cloned());
        let own = path.parent().map(Path::to_owned);
        for name in &scan.includes {
            let folders = own.iter().chain(tree.includes);
            // One that is not there is the simulator's to name.
            let found = folders.map(|folder| folder.join(name)).find(|path| path.is_file());
            let Some(path) = found.and_then(|path| path.canonicalize().ok()) else { continue };
            if self.files.insert(path.clone())
                && let Ok(bytes) = read_bytes(&path)
            {
                self.add(tree, &path, &Scan::verilog(&String::from_utf8_lossy(&bytes)));
            }
        }
    }
}

/// Paths of the files that are compiled.
fn choose(tree: &Tree, roots: &BTreeSet<String>) -> BTreeSet<PathBuf> {
    let mut declared = BTreeMap::<&str, Vec<&Source>>::new();
    for file in tree.files {
        let names = file.scan.modules.iter().map(|module| module.name.as_str());
        for name in names.chain(file.scan.packages.iter().map(String::as_str)) {
            declared.entry(name).or_default().push(file);
        }
    }
    // A file without a module has macros or types that any other may use.
    let always = |file: &&Source| {
        !file.found || file.scan.modules.is_empty() && file.scan.packages.is_empty()
    };
    let mut open: Vec<&Source> = tree.files.iter().filter(always).collect();
    let of = |words: &BTreeSet<String>| -> Vec<&Source> {
        words.iter().filter_map(|word| declared.get(word.as_str())).flatten().copied().collect()
    };
    open.extend(of(roots));
    let mut chosen = BTreeSet::new();
    while let Some(file) = open.pop() {
        if chosen.insert(file.path.clone()) {
            open.extend(of(&words(tree, file).words));
        }
    }
    chosen
}

/// Checks that no two files declare the same module; one under a condition is the simulator's to judge.
fn duplicates(tree: &Tree, files: &[&Source]) -> Result<()> {
    let mut first = BTreeMap::new();
    for file in files {
        for module in file.scan.modules.iter().filter(|module| !module.conditional) {
            let other = first.entry(&module.name).or_insert(&file.path);
            if **other != file.path {
                let [one, two] = [&**other, &file.path].map(|path| path.display().to_string());
                let expected = format!("expected it in one file, found it in {one} and in {two}");
                let fault = Input::new(tree.name, expected).field("module");
                return Err(fault.value(&module.name).into());
            }
        }
    }
    Ok(())
}

/// The files in their order, but each after those with the packages that it names, and after those without
/// any module.
fn packages_first<'a>(tree: &Tree, files: &[&'a Source]) -> Result<Vec<&'a Source>> {
    let named: Vec<_> = files.iter().map(|file| words(tree, file).scopes).collect();
    let mut order = Order {
        tree,
        files,
        named: &named,
        state: vec![Visit::Open; files.len()],
        done: Vec::new(),
    };
    let is_common =
        |file: &Source| file.found && file.scan.modules.is_empty() && file.scan.packages.is_empty();
    let (common, others): (Vec<_>, Vec<_>) = (0..files.len()).partition(|k| is_common(files[*k]));
    for k in common.into_iter().chain(others) {
        if order.state[k] == Visit::Open {
            order.visit(k)?;
        }
    }
    Ok(order.done)
}

#[derive(Clone, Copy, PartialEq)]
enum Visit {
    Open,
    Begun,
    Done,
}

struct Order<'a, 'b> {
    tree: &'b Tree<'b>,
    files: &'b [&'a Source],
    named: &'b [BTreeSet<String>],
    state: Vec<Visit>,
    done: Vec<&'a Source>,
}

impl Order<'_, '_> {
    fn visit(&mut self, k: usize) -> Result<()> {
        self.state[k] = Visit::Begun;
        let files = self.files;
        for other in (0..files.len()).filter(|other| *other != k) {
            let mut packages = files[other].scan.packages.iter();
            let Some(package) = packages.find(|package| self.named[k].contains(*package)) else {
                continue;
            };
            match self.state[other] {
                Visit::Done => {}
                Visit::Open => self.visit(other)?,
                Visit::Begun => {
                    let [one, two] = [k, other].map(|k| files[k].path.display().to_string());
                    let expected = format!(
                        "expected packages that do not need each other; {one} needs it, and {two}, which \
                         has it, needs what is in {one}"
                    );
                    let fault = Input::new(self.tree.name, expected).field("package");
                    return Err(fault.value(package).into());
                }
            }
        }
        self.state[k] = Visit::Done;
        self.done.push(files[k]);
        Ok(())
    }
}
