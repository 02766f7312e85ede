//! Tests of a sweep's folder: what it accepts and refuses there.

use std::fs;
use std::process::Command;

use tofsim::files::digest::digest;
use tofsim::files::folder::FolderLock;

use crate::common::{device, json, output, refused, stdout};

use super::{same, sweep, with_plan};

#[test]
fn shards_that_are_missing_damaged_or_of_another_sweep_are_not_merged() {
    let home = with_plan();
    let folder = home.path();
    for index in ["1/3", "2/3", "3/3"] {
        sweep(folder, &["-o", "s", "--shard", index]);
    }
    sweep(folder, &["-o", "other", "--shard", "2/3", "--seed", "9"]);
    sweep(folder, &["-o", "halves", "--shard", "2/2"]);
    let merge = |shards: &[&str]| {
        let args: Vec<_> =
            ["sweep", "merge"].iter().chain(shards).chain(&["-o", "m"]).copied().collect();
        refused(folder, &args)
    };
    let [one, two, three] = ["1", "2", "3"].map(|k| format!("s/shard-{k}-of-3.parquet"));
    assert!(merge(&[&one, &three]).contains("shard 2/3 missing, expected all 3"));
    assert!(merge(&[&one]).contains("shard 2/3 and 1 more missing"));
    let other = merge(&[&one, "other/shard-2-of-3.parquet", &three]);
    assert!(
        other.contains("it is a shard of another sweep than other/shard-2-of-3.parquet"),
        "{other}"
    );
    let other = merge(&["halves/shard-2-of-2.parquet", &one, &two, &three]);
    assert!(
        other.contains("1/3: expected a shard of 2, as halves/shard-2-of-2.parquet is"),
        "{other}"
    );
    fs::copy(folder.join(&two), folder.join("copy.parquet")).unwrap();
    assert!(
        merge(&["copy.parquet", &one, &two, &three])
            .contains("the same shard is in copy.parquet too")
    );
    assert!(merge(&["other/../plan.toml"]).contains("unreadable Parquet"));
    let whole = fs::read(folder.join(&two)).unwrap();
    for length in [0, 3, whole.len() / 2, whole.len() - 1] {
        fs::write(folder.join(&two), &whole[..length]).unwrap();
        let error = merge(&["s"]);
        assert!(error.contains("shard-2-of-3.parquet: unreadable Parquet"), "{length}: {error}");
    }
    assert!(!folder.join("m/sweep.parquet").exists(), "no table is left half done");
    fs::write(folder.join(&two), whole).unwrap();
    stdout(folder, &["sweep", "merge", "s", "-o", "m", "-q"]);
}

#[test]
fn what_is_there_is_not_done_again_and_another_plans_journal_is_not_gone_on_with() {
    let home = with_plan();
    let folder = home.path();
    sweep(folder, &["-o", "out"]);
    let table = folder.join("out/sweep.parquet");
    let before = fs::metadata(&table).unwrap().modified().unwrap();
    sweep(folder, &["-o", "out"]);
    assert_eq!(fs::metadata(&table).unwrap().modified().unwrap(), before);
    sweep(folder, &["-o", "out", "--restart"]);
    assert_ne!(fs::metadata(&table).unwrap().modified().unwrap(), before);
    let head = "{\"schema\":\"tofsim.sweep-journal/2\",\"about\":\"x\"}";
    let journal = format!("{:016x} {head}\n", digest(0, head.as_bytes()));
    fs::write(folder.join("out/sweep.journal"), journal).unwrap();
    let error = refused(folder, &["sweep", "plan.toml", "-o", "out", "--seed", "2"]);
    assert!(
        error.contains("out/sweep.journal: the sweep that was begun there is another"),
        "{error}"
    );
    for (args, expected) in [
        (
            &["sweep", "plan.toml", "--shard", "8/7", "-o", "out"][..],
            "expected I/N with I from 1 to N",
        ),
        (&["sweep", "plan.toml", "--shard", "1/7"], "--output <DIR>"),
        (&["sweep", "fig-4-22"], "plan: fig-4-22: no such file or built-in plan (`fig-4-2`?)"),
        (&["sweep", "show", "fig-44a"], "no built-in plan (`fig-4-4a`?)"),
        (&["sweep"], "<PLAN>"),
    ] {
        let error = refused(folder, args);
        assert!(error.contains(expected), "{args:?}: {error}");
    }
}

#[cfg(unix)]
#[test]
fn a_disk_that_fills_up_is_named_and_what_was_finished_is_kept() {
    let home = with_plan();
    let folder = home.path();
    sweep(folder, &["-o", "one"]);
    // A file may have so many blocks; writing more fails as on a full disk.
    let limited = format!(
        "trap '' XFSZ; ulimit -f 16; exec '{}' sweep plan.toml -o out --threads 1",
        env!("CARGO_BIN_EXE_tofsim")
    );
    let output = Command::new("sh").current_dir(folder).args(["-c", &limited]).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("out/sweep.journal: cannot write: File too large"), "{error}");
    assert!(!folder.join("out/sweep.parquet").exists());
    let again = json(folder, &["sweep", "plan.toml", "-o", "out", "--json"]);
    assert_eq!(again["points"], 48);
    same(folder, "one", "out");

    let full = device(folder, "full");
    fs::create_dir(folder.join("device")).unwrap();
    std::os::unix::fs::symlink(full, folder.join("device/sweep.journal")).unwrap();
    let error = refused(folder, &["sweep", "plan.toml", "-o", "device"]);
    assert!(error.contains("device/sweep.journal: expected a regular file"), "{error}");
}

#[test]
fn a_sweep_is_the_same_whatever_the_path_of_its_plan() {
    let home = with_plan();
    let folder = home.path();
    sweep(folder, &["-o", "one"]);
    stdout(folder, &["sweep", "plan.toml", "-o", "s", "--shard", "1/2", "-q"]);
    stdout(folder, &["sweep", "./plan.toml", "-o", "s", "--shard", "2/2", "-q"]);
    stdout(folder, &["sweep", "merge", "s", "-o", "merged", "-q"]);
    same(folder, "one", "merged");
    let before = fs::metadata(folder.join("one/sweep.parquet")).unwrap().modified().unwrap();
    stdout(folder, &["sweep", "./plan.toml", "-o", "one", "-q"]);
    let after = fs::metadata(folder.join("one/sweep.parquet")).unwrap().modified().unwrap();
    assert_eq!(before, after, "it is there and whole");
}

#[test]
fn a_sweep_that_lost_its_csv_makes_it_again() {
    let home = with_plan();
    let folder = home.path();
    for out in ["one", "two"] {
        sweep(folder, &["-o", out]);
    }
    fs::remove_file(folder.join("two/sweep.csv")).unwrap();
    sweep(folder, &["-o", "two"]);
    same(folder, "one", "two");
}

#[test]
fn a_changed_digit_of_a_journal_and_a_flipped_bit_of_a_shard_are_refused() {
    let home = with_plan();
    let folder = home.path();
    // The table cannot be written, so that the journal stays.
    fs::create_dir_all(folder.join("out/sweep.parquet")).unwrap();
    assert_eq!(output(folder, &["sweep", "plan.toml", "-o", "out"]).status.code(), Some(2));
    let path = folder.join("out/sweep.journal");
    let journal = fs::read(&path).unwrap();
    fs::remove_dir(folder.join("out/sweep.parquet")).unwrap();
    let digits = journal.iter().enumerate().filter(|(_, byte)| byte.is_ascii_digit());
    for (place, digit) in digits.step_by(999) {
        let mut changed = journal.clone();
        changed[place] = b'0' + (digit - b'0' + 1) % 10;
        fs::write(&path, changed).unwrap();
        let error = refused(folder, &["sweep", "plan.toml", "-o", "out"]);
        assert!(error.contains("sweep.journal:") && error.contains("checksum"), "{error}");
    }
    fs::write(&path, &journal).unwrap();
    sweep(folder, &["-o", "out"]);
    for index in ["1/2", "2/2"] {
        sweep(folder, &["-o", "s", "--shard", index]);
    }
    let path = folder.join("s/shard-2-of-2.parquet");
    let shard = fs::read(&path).unwrap();
    for k in 0..40 {
        let place = (shard.len() - 1) * k / 39;
        let mut changed = shard.clone();
        changed[place] ^= 1 << (k % 8);
        fs::write(&path, changed).unwrap();
        // A flipped bit in the name of the checksum leaves all else as it is.
        let merged = output(folder, &["sweep", "merge", "s", "-o", "m", "-q"]);
        assert!(!merged.status.success() || shard[place..].starts_with(b"tofsim.crc32"), "{place}");
    }
    fs::write(&path, &shard).unwrap();
    stdout(folder, &["sweep", "merge", "s", "-o", "m", "-q"]);
    same(folder, "out", "m");
    let again = ["sweep", "plan.toml", "--shard", "2/2", "-o", "s", "--restart", "--json"];
    fs::write(folder.join("s/shard.json"), stdout(folder, &again)).unwrap();
    for name in ["s/shard-2-of-2.parquet", "s/shard.json"] {
        assert!(stdout(folder, &["rerun", name]).contains("the same"), "{name}");
    }
}

#[test]
fn no_other_verb_writes_into_the_folder_of_a_sweep_and_shards_share_one() {
    let home = with_plan();
    let folder = home.path();
    let _sweep = FolderLock::share(&folder.join("out")).unwrap();
    let run = ["run", "--waves", "none", "-s", "firmware.shots_per_frame=40", "-o", "out"];
    for args in [&run[..], &["evaluate", "--rows", "51", "-o", "out"]] {
        let error = refused(folder, args);
        assert!(error.contains("--output: out: another run is writing there"), "{error}");
    }
    sweep(folder, &["-o", "out", "--shard", "1/2"]);
}
