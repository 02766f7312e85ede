//! File lists (`-f`), as Verilator, Icarus, Questa, VCS and xsim take them.

use std::path::{Path, PathBuf};

use tofsim::error::{Error, Input, Result, read_text};

/// Files and options that file lists name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Listed {
    /// Sources, in order.
    pub files: Vec<PathBuf>,
    /// Folders in which an `` `include `` is looked for.
    pub includes: Vec<PathBuf>,
    /// `NAME` or `NAME=VALUE`.
    pub defines: Vec<String>,
    /// Folders in which an unknown module is looked for (`-y`).
    pub libraries: Vec<PathBuf>,
    /// Files that are taken where they have an unknown module (`-v`).
    pub library_files: Vec<PathBuf>,
    /// Suffixes of files in those folders, with their dot.
    pub suffixes: Vec<String>,
    /// True if all files are SystemVerilog, whatever their suffix.
    pub system_verilog: bool,
    /// Options that are passed over, with their place.
    pub unknown: Vec<String>,
}

/// Lists that name each other deeper than this go round in a circle.
const DEEPEST: usize = 32;

/// A word of a list, and its line.
type Word = (usize, String);

impl Listed {
    /// Adds what a list names. Its paths are relative to the current folder, or to the list's own
    /// (`is_base`, as after `-F`).
    ///
    /// # Errors
    /// When it cannot be read, names a file or a variable that is not there, or itself.
    pub fn read(&mut self, list: &Path, is_base: bool) -> Result<()> {
        let own = list.parent().unwrap_or(Path::new(""));
        self.read_below(list, if is_base { own } else { Path::new("") }, 0)
    }

    fn read_below(&mut self, list: &Path, base: &Path, depth: usize) -> Result<()> {
        let text = read_text(list)?;
        let place = |line: usize| format!("{}:{line}", list.display());
        let mut words = words(&text).into_iter();
        while let Some((line, word)) = words.next() {
            let fault = |what: &str| Error::from(Input::new(place(line), what).value(&word));
            let word = variables(&word).map_err(|name| {
                fault(&format!("expected a value of ${name} in the environment"))
            })?;
            let path = |name: &str| base.join(name);
            let folder = |name: &str| match path(name) {
                path if path.is_dir() => Ok(path),
                path => Err(fault(&format!("no folder {}", path.display()))),
            };
            let file = |name: &str| match path(name) {
                path if path.is_file() => Ok(path),
                path => {
                    let beside = list.parent().is_some_and(|own| own.join(name).is_file());
                    let hint = if beside { "; it is there relative to the list (-F)" } else { "" };
                    Err(fault(&format!("no file {}{hint}", path.display())))
                }
            };
            let mut value = || {
                let (_, next) = words.next().ok_or_else(|| fault("expected a word after it"))?;
                let unset =
                    |name| fault(&format!("expected a value of ${name} in the environment"));
                variables(&next).map_err(unset)
            };
            match word.as_str() {
                "-f" | "-F" | "-file" => {
                    if depth == DEEPEST {
                        return Err(fault(
                            "expected lists that do not name each other in a circle",
                        ));
                    }
                    let inner = file(&value()?)?;
                    let own = inner.parent().map(Path::to_owned).unwrap_or_default();
                    let base = if word == "-F" { own.as_path() } else { base };
                    self.read_below(&inner, base, depth + 1)?;
                }
                "-I" | "-i" | "--include" | "-incdir" => self.includes.push(folder(&value()?)?),
                "-D" | "-d" | "--define" => self.defines.push(value()?),
                "-y" => self.libraries.push(folder(&value()?)?),
                "-v" => self.library_files.push(file(&value()?)?),
                "-sv" | "-sverilog" | "--sv" | "-g2012" => self.system_verilog = true,
                // Their values are no sources.
                "-top" | "--top" | "--top-module" | "-s" | "-work" | "--work" | "-L"
                | "-timescale" | "-l" | "-o" | "-t" => {
                    let unknown = format!("{}: {word} {}", place(line), value()?);
                    self.unknown.push(unknown);
                }
                word if word.starts_with(['-', '+']) => {
                    if !self.joined(word, folder)? {
                        self.unknown.push(format!("{}: {word}", place(line)));
                    }
                }
                word => self.files.push(file(word)?),
            }
        }
        Ok(())
    }

    /// Takes an option that has its values in the same word; returns whether it is one.
    fn joined(&mut self, word: &str, folder: impl Fn(&str) -> Result<PathBuf>) -> Result<bool> {
        let values = |list: &str| -> Vec<String> {
            list.split('+').filter(|value| !value.is_empty()).map(str::to_owned).collect()
        };
        if let Some(folders) = word.strip_prefix("+incdir+") {
            for name in values(folders) {
                self.includes.push(folder(&name)?);
            }
        } else if let Some(defines) = word.strip_prefix("+define+") {
            self.defines.extend(values(defines));
        } else if let Some(ends) = word.strip_prefix("+libext+") {
            self.suffixes.extend(values(ends));
        } else if let Some(name) = word.strip_prefix("-I") {
            self.includes.push(folder(name)?);
        } else if let Some(define) = word.strip_prefix("-D") {
            self.defines.push(define.to_owned());
        } else {
            return Ok(false);
        }
        Ok(true)
    }
}

/// The words of a list with their lines; `//`, `#` and `/* */` begin a comment where a word could begin.
fn words(text: &str) -> Vec<Word> {
    let mut words = Vec::new();
    let mut in_comment = false;
    for (line, text) in text.lines().enumerate() {
        let mut rest = text.trim_start();
        while !rest.is_empty() {
            if in_comment {
                let end = rest.split_once("*/");
                in_comment = end.is_none();
                rest = end.map_or("", |(_, rest)| rest).trim_start();
                continue;
            }
            if rest.starts_with("//") || rest.starts_with('#') {
                break;
            }
            if let Some(comment) = rest.strip_prefix("/*") {
                in_comment = true;
                rest = comment;
                continue;
            }
            let (word, next) = word(rest);
            if word != "\\" {
                words.push((line + 1, word));
            }
            rest = next.trim_start();
        }
    }
    words
}

/// The first word, without its quotes, and the rest.
fn word(text: &str) -> (String, &str) {
    let (mut word, mut quoted) = (String::new(), false);
    for (at, c) in text.char_indices() {
        match c {
            '"' => quoted = !quoted,
            c if c.is_whitespace() && !quoted => return (word, &text[at..]),
            c => word.push(c),
        }
    }
    (word, "")
}

/// With the values of `$NAME`, `${NAME}` and `$(NAME)`; the name of the first that has none.
fn variables(word: &str) -> std::result::Result<String, String> {
    let mut text = String::new();
    let mut rest = word;
    while let Some((before, after)) = rest.split_once('$') {
        text += before;
        let closed = |open, close| after.strip_prefix(open)?.split_once(close);
        let (name, next) = closed('{', '}').or_else(|| closed('(', ')')).unwrap_or_else(|| {
            let end = after.find(|c: char| !c.is_alphanumeric() && c != '_');
            after.split_at(end.unwrap_or(after.len()))
        });
        text += &std::env::var(name).map_err(|_| name.to_owned())?;
        rest = next;
    }
    Ok(text + rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn read(list: &str) -> Result<Listed> {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir_all(at("sub/inc")).unwrap();
        for name in ["a.v", "b.v", "sub/c.sv", "sub/lib.v"] {
            fs::write(at(name), "").unwrap();
        }
        fs::write(at("sub/inner.f"), "c.sv +incdir+inc\n").unwrap();
        let list = list.replace("HERE", folder.path().to_str().unwrap());
        fs::write(at("list.f"), list).unwrap();
        let mut listed = Listed::default();
        listed.read(&at("list.f"), false)?;
        let strip = |paths: &mut Vec<PathBuf>| {
            for path in paths {
                *path = path.strip_prefix(folder.path()).unwrap().to_owned();
            }
        };
        strip(&mut listed.files);
        strip(&mut listed.includes);
        strip(&mut listed.libraries);
        strip(&mut listed.library_files);
        Ok(listed)
    }

    #[test]
    fn what_real_lists_hold_is_understood() {
        let listed = read(
            "// a comment\n# another\n/* and\n one HERE/none.v */ HERE/a.v // 32'h0\n\
             +incdir+HERE/sub+HERE/sub/inc\n+define+A=1+B\n-D C=2 -DD\n-y HERE/sub\n\
             +libext+.v+.sv\n-v \"HERE/sub/lib.v\" -sv -timescale=1ns/1ps\n--top-module tb\n\
             -F HERE/sub/inner.f\nHERE/b.v \\\n",
        );
        let listed = listed.unwrap();
        let paths = |paths: &[&str]| paths.iter().map(PathBuf::from).collect::<Vec<_>>();
        assert_eq!(listed.files, paths(&["a.v", "sub/c.sv", "b.v"]));
        assert_eq!(listed.includes, paths(&["sub", "sub/inc", "sub/inc"]));
        assert_eq!(listed.defines, ["A=1", "B", "C=2", "D"]);
        assert_eq!(
            (listed.libraries, listed.library_files),
            (paths(&["sub"]), paths(&["sub/lib.v"]))
        );
        assert_eq!(listed.suffixes, [".v", ".sv"]);
        assert!(listed.system_verilog);
        let unknown: Vec<_> =
            listed.unknown.iter().map(|text| text.rsplit_once("list.f:").unwrap().1).collect();
        assert_eq!(unknown, ["10: -timescale=1ns/1ps", "11: --top-module tb"]);
    }

    #[test]
    fn what_is_not_there_is_refused_with_list_and_line() {
        let fault = |text: &str| read(text).unwrap_err().to_string();
        let error = fault("\nHERE/none.v\n");
        assert!(error.contains("list.f:2: ") && error.contains("no file"), "{error}");
        let error = fault("${TOFSIM_NO_SUCH_VARIABLE}/a.v");
        assert!(error.contains("expected a value of $TOFSIM_NO_SUCH_VARIABLE"), "{error}");
        assert!(fault("+incdir+HERE/none").contains("no folder"));
        assert!(fault("-f").contains("expected a word after it"));
        assert!(fault("-f HERE/list.f").contains("in a circle"));
    }
}
