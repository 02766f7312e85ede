//! The commands in `docs/comparing-with-hardware.md` print what stands there.
//!
//! `UPDATE_DOCS=1 cargo test -p tofsim-cli --test cli commands` writes what they print anew.

use std::fs;
use std::path::Path;

use tofsim_captures::compare::SignalMap;
use tofsim_captures::ila::{AnalyserPlan, AnalyserSetup};

use crate::common;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/comparing-with-hardware.md");

/// A command's words, taken apart as a shell does.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for letter in line.chars() {
        match letter {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            _ => words.last_mut().unwrap().push(letter),
        }
    }
    words
}

/// Returns the output of a command, including errors, and its status if that is not 0.
fn printed(folder: &Path, line: &str) -> String {
    let (line, target) = line.split_once(" > ").map_or((line, None), |(a, b)| (a, Some(b)));
    let words = words(line);
    let args: Vec<&str> = words[1..].iter().map(String::as_str).collect();
    let output = match words[0].as_str() {
        "tofsim" => common::output(folder, &args),
        program => {
            let mut command = std::process::Command::new(program);
            command.current_dir(folder).args(args).output().unwrap()
        }
    };
    let mut text = String::from_utf8(output.stdout).unwrap();
    if let Some(target) = target {
        fs::write(folder.join(target), std::mem::take(&mut text)).unwrap();
        return text;
    }
    text += &String::from_utf8(output.stderr).unwrap();
    match output.status.code().unwrap() {
        0 => text,
        status => text + &format!("(exit status {status})\n"),
    }
}

/// The page with what its commands print now.
fn page(old: &str) -> String {
    let folder = common::empty();
    let mut new = String::new();
    let mut console = false;
    for line in old.lines() {
        match line {
            "```console" => console = true,
            "```" => console = false,
            _ if console && !line.starts_with("$ ") => continue,
            _ => {}
        }
        new += &format!("{line}\n");
        if let Some(command) = line.strip_prefix("$ ").filter(|_| console) {
            let text = printed(folder.path(), command);
            text.lines().for_each(|line| new += &format!("{}\n", line.trim_end()));
        }
    }
    new
}

#[test]
fn the_commands_print_what_the_page_says() {
    let old = fs::read_to_string(PAGE).unwrap();
    let new = page(&old);
    assert!(new.matches("\n$ tofsim ").count() >= 10);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(PAGE, &new).unwrap();
    }
    for (line, (old, new)) in old.lines().zip(new.lines()).enumerate() {
        assert_eq!(old, new, "line {}; UPDATE_DOCS=1 writes it anew", line + 1);
    }
    assert_eq!(old.lines().count(), new.lines().count());
}

#[test]
fn the_set_up_and_the_maps_on_the_page_are_read() {
    let page = fs::read_to_string(PAGE).unwrap();
    let blocks: Vec<_> = (page.split("```toml\n").skip(1))
        .map(|block| block.split("```").next().unwrap().to_owned())
        .collect();
    let [set_up, map, words] = &blocks[..] else { panic!("{} blocks", blocks.len()) };
    let set_up = AnalyserSetup::parse("example", "example.toml", set_up).unwrap();
    let plan = AnalyserPlan::new(&set_up, &common::setup(&set_up.file.scenario, &[])).unwrap();
    assert_eq!((plan.probes.len(), plan.shape.depth, plan.shape.windows), (2, 512, 2));
    let map = SignalMap::parse("map.toml", map).unwrap();
    assert_eq!((map.rename.len(), map.signal.len()), (1, 2));
    let words = SignalMap::parse("map.toml", words).unwrap();
    assert_eq!(words.signal[0].states["No Streams"], 3);
}
