//! `tofsim rerun`: regenerates an output from its embedded record.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::OnceLock;

use regex::{Captures, Regex};
use serde_json::json;

use tofsim::error::open::open_file;
use tofsim::error::{Error, Input, Result};
use tofsim_captures::source::fst_comments;

use crate::record::Record;

use super::terminal::{Console, print, print_json};

/// Verbs whose outputs are made again. They write into the folder of `--output` and nowhere else, so
/// that no record of another's can make them write over anything.
const VERBS: [&str; 19] = [
    "budget",
    "estimate",
    "quantize --explore",
    "run",
    "image",
    "evaluate",
    "dataset",
    "train",
    "vectors",
    "ila capture",
    "calibrate pulse",
    "calibrate glass",
    "tdc",
    TDC_CALIBRATE,
    "spad",
    "sweep",
    "reproduce",
    "report",
    BUDGET_ERRORS,
];
/// Writes a file where the others write into a folder.
const TDC_CALIBRATE: &str = "tdc calibrate";
/// Writes into a folder, as the rest of `budget` does not.
const BUDGET_ERRORS: &str = "budget --errors";
/// Verbs that print and write nothing.
const PRINTING: &[&str] = VERBS.split_at(3).0;

/// The program that makes an output again, where it is not that of this process.
pub static PROGRAM: OnceLock<PathBuf> = OnceLock::new();

/// Regenerate an output from its embedded record, and compare the two byte by byte
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Waveforms, JSON, CSV, Parquet and SVG files record the command that wrote them. Paths in \
    that command are relative to the current folder. Exit status 1 means that the bytes differ.\n\n\
    Examples:\n  \
    tofsim run -s target.distance_m=0.3 -o out\n  \
    tofsim rerun out/histogram.svg           does this version write the same?\n  \
    tofsim rerun out/summary.json -o again   keep the new files"
)]
pub struct Args {
    /// Output file of a command
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Keep the new files in this folder, which must not be that of FILE
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object instead of a line
    #[arg(long)]
    json: bool,
}

/// Runs the verb; the status says whether the bytes are the same.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    let given = read(&args.file)?;
    let record = record(&args.file, &given)?;
    let scratch =
        tempfile::tempdir().map_err(Error::io(Path::new("temporary folder"), "create"))?;
    let folder = match &args.output {
        Some(folder) if is_home(folder, &args.file) => {
            let expected = "expected another folder than the file's";
            return Err(Input::new("--output", expected).value(folder.display()).into());
        }
        Some(folder) => folder.as_path(),
        None => scratch.path(),
    };
    console.detail(format_args!("tofsim {}", record.command.join(" ")));
    let again = again(&args.file, &given, &record, folder)?;
    let differences = differences(&without_folder(given), &without_folder(again), &record);
    let same = differences.is_empty();
    if args.json {
        print_json(&json!({
            "schema": "tofsim.rerun/1",
            "file": args.file.display().to_string(),
            "same": same,
            "differences": differences,
            "record": record,
        }))?;
    } else if same {
        print(&format!("{}: the same\n", args.file.display()))?;
    } else {
        print(&format!("{}: differs\n  {}\n", args.file.display(), differences.join("\n  ")))?;
    }
    Ok(if same { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn read(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = open_file(path)?.read_to_end(&mut bytes);
    read.map(|_| bytes).map_err(Error::io(path, "read"))
}

/// Whether a file stands in a folder.
fn is_home(folder: &Path, file: &Path) -> bool {
    let home = file.parent().filter(|home| !home.as_os_str().is_empty()).unwrap_or(Path::new("."));
    folder.canonicalize().is_ok_and(|folder| home.canonicalize().is_ok_and(|home| home == folder))
}

/// The record in a file.
fn inside(bytes: &[u8]) -> Option<Record> {
    // An FST file has it in compressed comments, of which a long one is in parts.
    let of_comments = || {
        let comments = fst_comments(bytes);
        let whole = comments.iter().find_map(|comment| Record::find(comment.as_bytes()));
        whole.or_else(|| Record::find(comments.concat().as_bytes()))
    };
    Record::find(bytes).or_else(of_comments)
}

/// The record of a file, or of another output in its folder that was made with it.
fn record(path: &Path, bytes: &[u8]) -> Result<Record> {
    if let Some(record) = inside(bytes) {
        return Ok(record);
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    // A logic analyser's formats have no room for it: the map beside has.
    let map = format!("{}.map.toml", path.file_stem().unwrap_or_default().to_string_lossy());
    let names = [
        "summary.json",
        "image.json",
        "evaluation.json",
        "dataset.json",
        "ports.json",
        "report.json",
    ];
    let mut beside = names.into_iter().chain([map.as_str()]);
    let found = beside.find_map(|name| Record::find(&read(&folder.join(name)).ok()?));
    found.ok_or_else(|| {
        let expected = "has no record of its command, and there is no summary in its folder";
        Input::new(path.display(), expected).into()
    })
}

/// Runs the command of a record, with what it writes in `folder`; the bytes that are to be those of
/// `file`.
fn again(file: &Path, given: &[u8], record: &Record, folder: &Path) -> Result<Vec<u8>> {
    let words: Vec<_> = record.command.iter().map(String::as_str).collect();
    let verb = match words[..] {
        [verb @ ("ila" | "calibrate"), command, ..] => format!("{verb} {command}"),
        ["tdc", "calibrate", ..] => TDC_CALIBRATE.to_owned(),
        ["budget", ..] if words.contains(&"--errors") => BUDGET_ERRORS.to_owned(),
        ["quantize", ..] if words.iter().any(|word| word.starts_with("--explore=")) => {
            "quantize --explore".to_owned()
        }
        [verb, ..] => verb.to_owned(),
        [] => String::new(),
    };
    if !VERBS.contains(&&verb[..]) {
        let expected = format!("expected a record of one of {}", VERBS.join(", "));
        return Err(Input::new(file.display(), expected).field("command").value(verb).into());
    }
    let name = file.file_name().unwrap_or_default();
    let program = match PROGRAM.get() {
        Some(program) => program.clone(),
        None => std::env::current_exe().map_err(Error::io(Path::new("tofsim"), "find"))?,
    };
    let mut command = Command::new(program);
    command.args(record.command.iter().map(|word| with_file_in(folder, word))).arg("--quiet");
    let is_printed = given.starts_with(b"{");
    match &verb[..] {
        verb if PRINTING.contains(&verb) => {}
        TDC_CALIBRATE if is_printed => {}
        TDC_CALIBRATE => drop(command.arg("--output").arg(folder.join(name))),
        _ => drop(command.arg("--output").arg(folder)),
    }
    if verb != "vectors" {
        command.arg("--json");
    }
    if verb == "sweep" {
        command.args(shard(&name.to_string_lossy(), given).map(|shard| format!("--shard={shard}")));
    }
    command.stdin(Stdio::null()).stderr(Stdio::piped());
    let done = command.output().map_err(Error::io(Path::new("tofsim"), "run"))?;
    if !matches!(done.status.code(), Some(0 | 1)) {
        let said = String::from_utf8_lossy(&done.stderr);
        let said = said.trim().trim_start_matches("tofsim: ");
        let expected = format!("cannot be made again: {said}");
        return Err(Input::new(file.display(), expected).into());
    }
    // A block's vectors have a folder of their own.
    let own = words.last().map(|block| folder.join(block).join(name));
    let path = own.filter(|_| verb == "vectors").unwrap_or_else(|| folder.join(name));
    match read(&path) {
        Ok(bytes) => Ok(bytes),
        Err(_) if done.stdout.starts_with(b"{") && is_printed => Ok(done.stdout),
        Err(_) => {
            let expected =
                format!("`tofsim {}` writes no file of that name", record.command.join(" "));
            Err(Input::new(file.display(), expected).into())
        }
    }
}

/// Returns which shard of a sweep an output is, by the name of its table or by its object; the record, which all shards
/// have, does not say.
fn shard(name: &str, given: &[u8]) -> Option<String> {
    let stem = name.strip_prefix("shard-").and_then(|name| name.strip_suffix(".parquet"));
    if let Some((index, count)) = stem.and_then(|stem| stem.split_once("-of-")) {
        return Some(format!("{index}/{count}"));
    }
    let object: serde_json::Value = serde_json::from_slice(given).ok()?;
    object["shard"].as_str().map(str::to_owned)
}

/// Removes the folder of the files from printed JSON or a summary, because the user chooses it.
fn without_folder(bytes: Vec<u8>) -> Vec<u8> {
    let text = match String::from_utf8(bytes) {
        Ok(text) if text.starts_with('{') => text,
        Ok(text) => return text.into_bytes(),
        Err(fault) => return fault.into_bytes(),
    };
    // In keys that name files, the part of each text up to its last stroke.
    let text_of_any = r#""(?:[^"\\]|\\.)*""#;
    let list = format!(r"\[(?:{text_of_any}|[,\s])*\]");
    let keys = Regex::new(&format!(r#""(?:waves|network|files)":\s*(?:{text_of_any}|{list})"#));
    let folders = Regex::new(r#""(?:[^"\\]|\\.)*/"#);
    let (Ok(keys), Ok(folders)) = (keys, folders) else { return text.into_bytes() };
    let name = |found: &Captures| folders.replace_all(&found[0], "\"").into_owned();
    keys.replace_all(&text, name).into_owned().into_bytes()
}

/// Returns a word of a command, with the file of `--events` or `--transactions` in a folder.
fn with_file_in(folder: &Path, word: &str) -> String {
    let Some((option, path)) = word.split_once('=') else { return word.to_owned() };
    match Path::new(path).file_name() {
        Some(name) if ["--events", "--transactions"].contains(&option) => {
            format!("{option}={}", folder.join(name).display())
        }
        _ => word.to_owned(),
    }
}

/// Describes the differences: the record first, then the first byte.
fn differences(given: &[u8], again: &[u8], record: &Record) -> Vec<String> {
    if given == again {
        return Vec::new();
    }
    let mut found = Vec::new();
    let now = inside(again).unwrap_or_else(|| record.clone());
    for (what, then, now) in [
        ("version", &record.version, &now.version),
        ("hash of the scenario and its files", &record.hash, &now.hash),
    ] {
        if then != now {
            found.push(format!("{what}: {then} then, {now} now"));
        }
    }
    if given.len() != again.len() {
        found.push(format!("length: {} bytes then, {} now", given.len(), again.len()));
    }
    if let Some(place) = given.iter().zip(again).position(|(a, b)| a != b) {
        let line = given[..place].iter().filter(|&&byte| byte == b'\n').count() + 1;
        found.push(format!("first other byte: {place}, in line {line}"));
    }
    found
}
