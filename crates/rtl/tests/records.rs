//! Records of what tools have answered: what asks them again, and what is written.

use std::cell::Cell;
use std::fs;
use std::path::Path;

use crate::common::empty;
use crate::record::{Inputs, Record};

/// Asks a record in a folder about some Verilog; whether the tool had to answer.
fn asks(folder: &Path, inputs: Inputs) -> bool {
    let asked = Cell::new(false);
    let record = Record::read(folder.join("a.record"), "cargo test");
    let answer = record.answer("check", &inputs, || {
        asked.set(true);
        Ok("proven".to_owned())
    });
    assert_eq!(answer, "proven");
    asked.get()
}

/// The digest of some Verilog.
fn of(text: &str) -> Inputs {
    Inputs::default().verilog("a.v", text)
}

#[test]
fn a_comment_or_layout_leaves_the_digest_and_code_changes_it() {
    let code = of("wire a = b / c;\nwire d;\n");
    for same in [
        "// one\n  wire a = b / c; // two\n\n\twire d;",
        "/* three\n lines \n long */ wire a = b / c;\nwire d; // not /* open\n",
    ] {
        assert_eq!(of(same), code, "{same}");
    }
    for other in [
        "wire a = b / d;\nwire d;\n",
        "wire a = b; // / c;\nwire d;\n",
        "wire a = b / c;\nwire d;\n// verilator lint_off UNUSED\n",
        "wire a = b / c;\n/* wire d; */\n",
    ] {
        assert_ne!(of(other), code, "{other}");
    }
}

#[test]
fn what_stands_in_a_string_is_no_comment() {
    assert_ne!(of(r#"a = "x//y";"#), of(r#"a = "x//z";"#));
    assert_ne!(of(r#"a = "\"/*y*/";"#), of(r#"a = "\"/*z*/";"#));
    assert_eq!(of(r#"a = "x"; // y"#), of(r#"a = "x"; // z"#));
}

#[test]
fn texts_are_not_taken_for_each_other() {
    let both = |one: &str, two: &str| Inputs::default().text("a", one).text("b", two);
    assert_ne!(both("one", "two"), both("two", "one"));
    assert_ne!(both("one two", ""), both("", "one two"));
    assert_ne!(both("", ""), Inputs::default());
}

#[test]
fn only_what_is_recorded_with_its_digest_needs_no_tool() {
    let folder = empty();
    assert!(asks(folder.path(), of("wire a;")));
    let line = format!("# cargo test\ncheck\t{}\tproven\n", of("wire a;"));
    fs::write(folder.path().join("a.record"), line).unwrap();
    assert!(!asks(folder.path(), of("wire a;")));
    assert!(!asks(folder.path(), of("wire a; // no digit of it")));
    assert!(asks(folder.path(), of("wire b;")));
}

#[test]
fn what_is_written_is_sorted_and_has_what_was_used_however_many_write_at_once() {
    let folder = empty();
    let path = folder.path().join("a.record");
    let head = "# UPDATE_RECORDS=1 cargo test\n";
    fs::write(&path, format!("{head}gone\t0\tproven\nc0\t{}\tknown\n", of("c0"))).unwrap();
    let mut record = Record::read(&path, "cargo test");
    record.updates = true;
    let checks: Vec<_> = (0..9).map(|n| format!("c{n}")).collect();
    let ask = |check: &str| match check {
        "c8" => Err("late".to_owned()),
        _ => Ok("asked".to_owned()),
    };
    std::thread::scope(|scope| {
        for check in &checks {
            scope.spawn(|| record.answer(check, &of(check), || ask(check)));
        }
    });
    let line = |(n, check): (usize, &String)| {
        format!("{check}\t{}\t{}\n", of(check), if n == 0 { "known" } else { "asked" })
    };
    let lines: String = checks[..8].iter().enumerate().map(line).collect();
    assert_eq!(fs::read_to_string(&path).unwrap(), head.to_owned() + &lines);
}
