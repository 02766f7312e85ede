//! Tests of the journal.

use super::*;

fn entry(point: u64) -> Entry {
    let cells = vec![
        Cell::Whole(point),
        Cell::Number(0.1 * point as f64 + 1e-17),
        Cell::None,
        Cell::Text("a,\"b\"".to_owned()),
    ];
    Entry { cells, notes: Vec::new() }
}

fn points(path: &Path, about: &str) -> Result<Vec<u64>> {
    let mut points = Vec::new();
    Journal::open(path, about, |point| points.push(point)).map(|_| points)
}

#[test]
fn points_come_back_in_order_and_to_the_last_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("j");
    let journal = Journal::open(&path, "a", |_| panic!("nothing is there")).unwrap();
    let order = [3, 0, 2, 1];
    order.iter().for_each(|&point| journal.add(&entry(point)).unwrap());
    let mut found = Vec::new();
    journal
        .in_order(|entry| {
            found.push(entry);
            Ok(())
        })
        .unwrap();
    assert_eq!(found, [0, 1, 2, 3].map(entry));
    drop(journal);
    assert_eq!(points(&path, "a").unwrap(), order);
}

#[test]
fn a_line_without_an_end_is_cut_off_wherever_it_was_torn() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("j");
    let journal = Journal::open(&path, "a", |_| ()).unwrap();
    [0, 1].iter().for_each(|&point| journal.add(&entry(point)).unwrap());
    drop(journal);
    let whole = std::fs::read(&path).unwrap();
    let lines: Vec<_> =
        whole.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(k, _)| k + 1).collect();
    for length in 0..=whole.len() {
        std::fs::write(&path, &whole[..length]).unwrap();
        let expected = lines.iter().filter(|end| **end <= length).count().saturating_sub(1);
        assert_eq!(points(&path, "a").unwrap().len(), expected, "{length} bytes");
        let journal = Journal::open(&path, "a", |_| ()).unwrap();
        journal.add(&entry(7)).unwrap();
        drop(journal);
        assert_eq!(points(&path, "a").unwrap().last(), Some(&7));
    }
}

#[test]
fn another_sweeps_journal_and_a_damaged_one_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("j");
    Journal::open(&path, "a", |_| ()).unwrap().add(&entry(0)).unwrap();
    let error = points(&path, "b").unwrap_err().to_string();
    assert!(error.contains("the sweep that was begun there is another"), "{error}");
    let mut text = std::fs::read_to_string(&path).unwrap();
    text += "nonsense\n";
    std::fs::write(&path, text).unwrap();
    let error = points(&path, "a").unwrap_err().to_string();
    assert!(error.contains("j:3:1: damaged: the line does not match"), "{error}");
}

#[test]
fn a_changed_digit_and_a_line_that_is_there_twice_or_not_at_all_are_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("j");
    let journal = Journal::open(&path, "a", |_| ()).unwrap();
    [0, 1, 2].iter().for_each(|&point| journal.add(&entry(point)).unwrap());
    drop(journal);
    let text = std::fs::read_to_string(&path).unwrap();
    let refused = |text: &[u8], line: usize| {
        std::fs::write(&path, text).unwrap();
        let error = points(&path, "a").unwrap_err().to_string();
        assert!(error.contains(&format!("j:{line}:1: damaged")), "{error}");
    };
    let lines: Vec<_> = text.split_inclusive('\n').collect();
    refused([lines[0], lines[1], lines[1], lines[2]].concat().as_bytes(), 3);
    refused([lines[0], lines[2]].concat().as_bytes(), 2);
    refused([lines[0], lines[2], lines[1]].concat().as_bytes(), 2);
    for (place, digit) in text.bytes().enumerate().filter(|(_, byte)| byte.is_ascii_digit()) {
        let mut changed = text.clone().into_bytes();
        changed[place] = b'0' + (digit - b'0' + 1) % 10;
        refused(&changed, text[..place].matches('\n').count() + 1);
    }
    let old = lines.iter().map(|line| &line[SUM..]).collect::<String>();
    std::fs::write(&path, old).unwrap();
    let error = points(&path, "a").unwrap_err().to_string();
    assert!(error.contains("a journal of an earlier version"), "{error}");
}

#[test]
fn a_journal_is_written_by_one_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("j");
    let _held = Journal::open(&path, "a", |_| ()).unwrap();
    let error = points(&path, "a").unwrap_err().to_string();
    assert!(error.contains("another sweep is writing there"), "{error}");
}
