//! Imports between files: no cycle among the files of a crate, and in the simulator only downwards.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The modules of the simulator, the lowest layer first; those of one layer do not know each other.
const LAYERS: [&[&str]; 7] = [
    &["error", "kernel"],
    &["files", "note"],
    &["firmware"],
    &["hierarchy", "network", "scenario"],
    &["waves", "optics"],
    &["sensor"],
    &["sim"],
];

/// A file of a crate, and the files that it imports from.
type Imports = BTreeMap<String, BTreeSet<String>>;

#[test]
fn the_files_of_a_crate_do_not_import_each_other_in_a_circle() {
    let circles = crates().iter().flat_map(|folder| circles(&imports(folder))).collect();
    assert_none("circles", &circles);
}

#[test]
fn the_simulator_imports_downwards_only() {
    let layer = |module: &str| {
        let found = LAYERS.iter().position(|layer| layer.contains(&module));
        found.unwrap_or_else(|| panic!("{module} stands in no layer"))
    };
    let module = |file: &str| file["src/".len()..].split(['/', '.']).next().unwrap().to_owned();
    let mut upward = BTreeSet::new();
    for (file, others) in imports(&root().join("src")) {
        for other in others {
            let [from, to] = [module(&file), module(&other)];
            if from != "lib" && from != to && (to == "lib" || layer(&to) >= layer(&from)) {
                upward.insert(format!("{file}->{other}"));
            }
        }
    }
    assert_none("imports to the same layer or a higher one", &upward);
}

fn assert_none(what: &str, found: &BTreeSet<String>) {
    assert!(found.is_empty(), "{what}: {found:#?}");
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

/// The folders with the sources of each crate.
fn crates() -> Vec<PathBuf> {
    let others = fs::read_dir(root().join("crates")).unwrap();
    let others = others.map(|entry| entry.unwrap().path().join("src"));
    [root().join("src")].into_iter().chain(others).collect()
}

/// The files that import each other over some way, one line for each circle.
fn circles(imports: &Imports) -> BTreeSet<String> {
    let circle = |file: &String| {
        let both = reached(imports, file).into_iter();
        let both: Vec<_> = both.filter(|other| reached(imports, other).contains(&file)).collect();
        both.iter().map(|other| other.as_str()).collect::<Vec<_>>().join(" ")
    };
    imports.keys().map(circle).filter(|circle| !circle.is_empty()).collect()
}

/// All that a file imports, and what those import in turn.
fn reached<'a>(imports: &'a Imports, file: &'a String) -> BTreeSet<&'a String> {
    let (mut reached, mut left) = (BTreeSet::new(), vec![file]);
    while let Some(file) = left.pop() {
        left.extend(imports[file].iter().filter(|&other| reached.insert(other)));
    }
    reached
}

/// Returns the modules that each file below `folder` imports from others there, without its tests.
fn imports(folder: &Path) -> Imports {
    let mut files = BTreeMap::new();
    collect(folder, &mut Vec::new(), &mut files);
    let name = |file: &Path| file.strip_prefix(root()).unwrap().display().to_string();
    let macros: BTreeMap<_, _> = files.values().flat_map(|file| exported(file)).collect();
    let of = |(module, file): (&Vec<String>, &PathBuf)| {
        let text = without_tests(&fs::read_to_string(file).unwrap());
        let mut others: BTreeSet<_> = (paths(&text).iter())
            .filter_map(|path| absolute(path, module, &files))
            .map(|path| {
                let part = |length| files.get(&path[..length]);
                let module = (1..=path.len()).rev().find_map(part);
                name(module.or_else(|| macros.get(&path[0])).unwrap_or(&files[&[][..]]))
            })
            .collect();
        others.remove(&name(file));
        (name(file), others)
    };
    files.iter().map(of).collect()
}

/// The macros that a file puts into the root of its crate.
fn exported(file: &Path) -> Vec<(String, PathBuf)> {
    let text = fs::read_to_string(file).unwrap();
    let found = text.split("#[macro_export]\nmacro_rules! ").skip(1);
    found.map(|text| (word(text).to_owned(), file.to_owned())).collect()
}

/// The files below `folder` by their modules.
fn collect(folder: &Path, module: &mut Vec<String>, files: &mut BTreeMap<Vec<String>, PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap();
        let names_its_folder = matches!(stem, "lib" | "main" | "mod");
        if path.is_file() && (stem.ends_with("tests") || path.extension().unwrap() != "rs") {
            continue;
        }
        module.extend((!names_its_folder).then(|| stem.to_owned()));
        match path.is_dir() {
            true => collect(&path, module, files),
            false => drop(files.insert(module.clone(), path.clone())),
        }
        module.truncate(module.len() - usize::from(!names_its_folder));
    }
}

/// The text without comments and without what is compiled for tests alone.
fn without_tests(text: &str) -> String {
    let (mut kept, mut skipped) = (String::new(), None);
    for line in text.lines() {
        let code = line.split("//").next().unwrap().trim_end();
        let indent = line.len() - line.trim_start().len();
        if code.trim_start() == "#[cfg(test)]" {
            skipped = Some(indent);
        } else if skipped.is_none() {
            kept = kept + code + "\n";
        } else if skipped == Some(indent) && code.ends_with(['}', ';']) {
            skipped = None;
        }
    }
    kept
}

/// All paths of at least two names in the text, the trees of `use` taken apart.
fn paths(text: &str) -> Vec<Vec<&str>> {
    let (mut paths, mut rest) = (Vec::new(), text);
    while let Some(start) = rest.find(is_in_word) {
        let is_inner = ["::", "pub(in "].iter().any(|before| rest[..start].ends_with(before));
        let end = start + word(&rest[start..]).len();
        rest = match !is_inner && rest[end..].starts_with("::") {
            true => tree(&rest[start..], Vec::new(), &mut paths),
            false => &rest[end..],
        };
    }
    paths
}

/// Adds the paths that begin at `text`; returns what stands behind them.
fn tree<'a>(text: &'a str, mut path: Vec<&'a str>, paths: &mut Vec<Vec<&'a str>>) -> &'a str {
    let mut rest = text.trim_start();
    if let Some(mut inside) = rest.strip_prefix('{') {
        loop {
            inside = tree(inside, path.clone(), paths).trim_start();
            match inside.strip_prefix(',') {
                Some(next) => inside = next,
                None => return inside.strip_prefix('}').unwrap_or(inside),
            }
        }
    }
    let name = word(rest);
    rest = rest[name.len()..]
        .strip_prefix(" as ")
        .map_or(&rest[name.len()..], |alias| &alias[word(alias).len()..]);
    if !name.is_empty() {
        path.push(name);
        match rest.strip_prefix("::") {
            Some(next) => return tree(next, path, paths),
            None => paths.push(path),
        }
    } else if let Some(next) = rest.strip_prefix(['*', '<']) {
        paths.push(path);
        rest = next;
    }
    rest
}

fn is_in_word(character: char) -> bool {
    character.is_alphanumeric() || character == '_'
}

fn word(text: &str) -> &str {
    &text[..text.find(|character| !is_in_word(character)).unwrap_or(text.len())]
}

/// The path from the crate's root, of one that does not lead out of the crate.
fn absolute(
    path: &[&str],
    module: &[String],
    files: &BTreeMap<Vec<String>, PathBuf>,
) -> Option<Vec<String>> {
    let ups = path.iter().take_while(|&&name| name == "super").count();
    let base = match path[0] {
        "crate" => &[],
        "self" => module,
        "super" => &module[..module.len().checked_sub(ups)?],
        child if files.contains_key(&[module, &[child.to_owned()]].concat()) => module,
        _ => return None,
    };
    let own = path.iter().filter(|name| !matches!(**name, "crate" | "self" | "super"));
    Some(base.iter().cloned().chain(own.map(|&name| name.to_owned())).collect())
}
