//! The walk-through in `docs/instruments.md` works as it stands there.

use std::fs;
use std::path::PathBuf;

use crate::common::{empty, output};

const PAGE: &str = include_str!("../../../../docs/instruments.md");

#[test]
fn the_walk_through_leads_from_a_file_to_a_report() {
    let folder = empty();
    let toml = PAGE.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    fs::write(folder.path().join("mine.toml"), toml).unwrap();
    let mut place = PathBuf::from(folder.path());
    let blocks = PAGE.split("```console\n").skip(1).map(|block| block.split("```").next().unwrap());
    let mut commands = 0;
    for line in blocks.flat_map(str::lines) {
        let words: Vec<_> = line.strip_prefix("$ ").unwrap().split(' ').collect();
        match words[..] {
            ["cd", to] => place.push(to),
            ["tofsim", ref args @ ..] => {
                let done = output(&place, args);
                let said = String::from_utf8_lossy(&done.stderr);
                assert!(done.status.success(), "{line}: {said}");
                commands += 1;
            }
            _ => panic!("{line}"),
        }
    }
    assert_eq!(commands, 4);
    assert!(folder.path().join("mine/report.html").exists());
}

#[test]
fn the_value_that_the_page_says_is_refused_is() {
    let error = crate::common::refused(empty().path(), &["run", "-s", "tdc.bins=60"]);
    assert!(error.contains("tdc.bins = 60: expected a power of two, such as 32 or 64"), "{error}");
    assert!(PAGE.replace('\n', " ").contains("expected a power of two, such as 32 or 64"));
}
