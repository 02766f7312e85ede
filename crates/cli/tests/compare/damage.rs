//! Damaged captures: each fault is found, and named for what it is.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common;

use super::{different, differing, findings, refused};

/// A capture and its parts, as lists of cells.
struct Table {
    heads: Vec<String>,
    radices: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn captured(folder: &Path) -> Table {
        let args = ["ila", "capture", "--probes", "fig_6_12", "-o", ".", "--format", "csv"];
        common::stdout(folder, &args);
        let text = fs::read_to_string(folder.join("fig_6_12.csv")).unwrap();
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect());
        Table {
            heads: lines.next().unwrap(),
            radices: lines.next().unwrap(),
            rows: lines.collect(),
        }
    }

    /// Writes it with its samples numbered.
    fn write(&mut self, folder: &Path) {
        for (k, row) in self.rows.iter_mut().enumerate() {
            (row[0], row[1]) = (k.to_string(), k.to_string());
        }
        self.write_as_it_is(folder);
    }

    fn write_as_it_is(&self, folder: &Path) {
        let lines = [&self.heads, &self.radices].into_iter().chain(&self.rows);
        let text: String = lines.map(|cells| cells.join(",") + "\n").collect();
        fs::write(folder.join("damaged.csv"), text).unwrap();
    }

    fn column(&self, name: &str) -> usize {
        self.heads.iter().position(|head| head.starts_with(name)).unwrap()
    }
}

/// Returns the result after some damage.
fn damaged(damage: impl FnOnce(&mut Table)) -> Value {
    let folder = common::empty();
    let mut table = Table::captured(folder.path());
    damage(&mut table);
    table.write(folder.path());
    different(folder.path(), &["fig_6_12.csv", "damaged.csv"])
}

#[test]
fn a_flipped_bit_is_found_with_its_sample_and_bit() {
    let json = damaged(|table| {
        let code = table.column("TDC_CODE");
        let value: u32 = table.rows[500][code].parse().unwrap();
        table.rows[500][code] = (value ^ 4).to_string();
    });
    assert_eq!(findings(&json), ["flipped bit"]);
    assert_eq!(differing(&json), ["TDC_CODE"]);
    let first = &json["first"];
    assert_eq!((&first["differing"], &first["first"]["at"][1]), (&1.into(), &500.0.into()));
    assert_eq!(first["first"]["bits"].to_string(), "[2]");
}

#[test]
fn a_missing_sample_is_found_where_it_is_missing() {
    let json = damaged(|table| {
        table.rows.remove(300);
    });
    assert_eq!(findings(&json), ["missing samples"]);
    let text = json["findings"][0]["text"].as_str().unwrap();
    assert!(text.contains("1 sample missing on the second side at or before sample 300"), "{text}");
    assert!(json["differences"].to_string().contains("1024 samples in the first, 1023"));
}

#[test]
fn an_added_sample_is_found_where_it_was_added() {
    let json = damaged(|table| {
        let row = table.rows[290].clone();
        table.rows.insert(300, row);
        table.rows.pop();
    });
    assert_eq!(findings(&json), ["extra samples"]);
    let text = json["findings"][0]["text"].as_str().unwrap();
    assert!(text.contains("1 sample too many on the second side at or before sample 30"), "{text}");
}

#[test]
fn a_shifted_window_is_found_with_how_far() {
    for shift in [1, 7, 200] {
        let json = damaged(|table| {
            let marks: Vec<_> = table.rows.iter().map(|row| row[2].clone()).collect();
            table.rows.rotate_left(shift);
            table.rows.truncate(1024 - shift);
            table.rows.iter_mut().zip(marks).for_each(|(row, mark)| row[2] = mark);
        });
        assert_eq!(findings(&json), ["shifted window"]);
        let text = json["findings"][0]["text"].as_str().unwrap();
        assert!(text.contains(&format!("{shift} sample")) && text.ends_with("earlier"), "{text}");
    }
}

#[test]
fn a_shifted_window_among_others_is_named() {
    let folder = common::empty();
    let folder = folder.path();
    let args = ["ila", "capture", "--probes", "fig_6_12", "--windows", "4", "-o", "."];
    common::stdout(folder, &args);
    let text = fs::read_to_string(folder.join("fig_6_12.csv")).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let values = |line: &String| line.splitn(4, ',').nth(3).unwrap().to_owned();
    let window: Vec<String> = lines[2 + 512..2 + 768].iter().map(values).collect();
    for (k, line) in lines[2 + 512..2 + 768].iter_mut().enumerate() {
        let marks: Vec<&str> = line.splitn(4, ',').take(3).collect();
        *line = format!("{},{}", marks.join(","), window[(k + 5).min(255)]);
    }
    fs::write(folder.join("damaged.csv"), lines.join("\n") + "\n").unwrap();
    let json = different(folder, &["fig_6_12.csv", "damaged.csv"]);
    let text = json["findings"][0]["text"].as_str().unwrap();
    assert!(text.starts_with("window 2:") && text.contains("5 samples"), "{json:#}");
}

#[test]
fn a_renamed_probe_is_found_by_its_values() {
    let json = damaged(|table| {
        let valid = table.column("TDC_VALID");
        table.heads[valid] = "TDC_OK".to_owned();
    });
    assert_eq!(findings(&json), ["renamed"]);
    assert_eq!(json["findings"][0]["signals"].to_string(), r#"["TDC_VALID","TDC_OK"]"#);
    assert!(json["differences"].to_string().contains("TDC_VALID is not compared"));
}

#[test]
fn a_swapped_pair_of_probes_is_found() {
    let json = damaged(|table| {
        let (laser, valid) = (table.column("VCSEL_ON"), table.column("TDC_VALID"));
        table.heads.swap(laser, valid);
    });
    assert_eq!(findings(&json), ["swapped"]);
    assert_eq!(differing(&json).len(), 2);
}

#[test]
fn a_wrong_radix_is_found_where_the_values_could_be_of_another() {
    let json = damaged(|table| {
        let shots = table.column("frame_ctrl/shots");
        table.radices[shots] = "HEX".to_owned();
    });
    assert_eq!(findings(&json), ["wrong radix"]);
    let text = json["findings"][0]["text"].as_str().unwrap();
    assert!(text.contains("read as UNSIGNED and not as HEX"), "{text}");
}

#[test]
fn a_wrong_radix_that_the_digits_contradict_is_refused_with_its_place() {
    let folder = common::empty();
    let folder = folder.path();
    let mut table = Table::captured(folder);
    let code = table.column("TDC_CODE");
    table.radices[code] = "BINARY".to_owned();
    table.write(folder);
    let error = refused(folder, &["fig_6_12.csv", "damaged.csv"]);
    assert!(
        error.contains("TDC_CODE[7:0]") && error.contains("expected BINARY digits only, unless"),
        "{error}"
    );
}

#[test]
fn a_row_that_is_missing_is_refused_with_its_place() {
    let folder = common::empty();
    let folder = folder.path();
    let mut table = Table::captured(folder);
    table.rows.remove(300);
    table.write_as_it_is(folder);
    let error = refused(folder, &["fig_6_12.csv", "damaged.csv"]);
    assert!(error.contains("damaged.csv:303:1") && error.contains("expected 300"), "{error}");
}

#[test]
fn what_is_wrong_against_the_simulation_is_named_too() {
    let folder = common::empty();
    let folder = folder.path();
    let mut table = Table::captured(folder);
    let code = table.column("TDC_CODE");
    table.rows[700][code] = "1".to_owned();
    table.write(folder);
    let args = ["--scenario", "histogram_validation", "damaged.csv", "--map", "fig_6_12"];
    let json = different(folder, &args);
    assert_eq!(differing(&json), ["tof_top.code_preload.tdc_code"]);
    assert_eq!(json["first"]["first"]["at"][1], 700.0);
    assert_eq!(json["first"]["first"]["got"], "1");
}

#[test]
fn what_only_looks_like_it_is_not_named() {
    let twice = damaged(|table| {
        let code = table.column("TDC_CODE");
        for row in [500, 600] {
            let value: u32 = table.rows[row][code].parse().unwrap();
            table.rows[row][code] = (value ^ 4).to_string();
        }
    });
    assert_eq!((differing(&twice).len(), findings(&twice)), (1, vec![]));
}

#[test]
fn a_column_with_the_values_of_one_that_follows_it_is_a_late_one() {
    let copied = damaged(|table| {
        let (laser, valid) = (table.column("VCSEL_ON"), table.column("TDC_VALID"));
        table.rows.iter_mut().for_each(|row| row[laser] = row[valid].clone());
    });
    assert_eq!(
        (differing(&copied).len(), findings(&copied)),
        (1, vec!["shifted signal".to_owned()])
    );
    let text = copied["findings"][0]["text"].as_str().unwrap();
    assert!(text.contains("VCSEL_ON is 2 samples later"), "{text}");
}
