//! Files of histograms: what is read, and what is said about a faulty one.

use std::path::Path;

use tofsim::error::Result;
use tofsim::network::Histogram;
use tofsim::network::histogram_file;

use crate::common::{csv, npy};

/// The histogram of a file that has one.
fn single(path: &Path) -> Result<Histogram> {
    let mut histograms = histogram_file::open(path, Default::default())?;
    let first = histograms.next().expect("a histogram");
    assert!(histograms.next().is_none());
    first
}

#[test]
fn every_type_of_whole_number_reads_the_same_in_either_byte_order() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("h.npy");
    let histogram: Histogram = (0..256).map(|bin| bin % 100).collect();
    let check = |descr: &str, bytes: fn(u16) -> Vec<u8>| {
        let data: Vec<u8> = histogram.iter().flat_map(|&count| bytes(count as u16)).collect();
        std::fs::write(&path, npy(descr, "(256,)", &data)).unwrap();
        assert!(single(&path).unwrap() == histogram, "{descr}");
    };
    check("|u1", |n| vec![n as u8]);
    check("|i1", |n| vec![n as u8]);
    check("<u2", |n| n.to_le_bytes().into());
    check(">i2", |n| n.to_be_bytes().into());
    check("<u4", |n| u32::from(n).to_le_bytes().into());
    check(">i4", |n| i32::from(n).to_be_bytes().into());
    check(">u8", |n| u64::from(n).to_be_bytes().into());
    check("<i8", |n| i64::from(n).to_le_bytes().into());
    check("<f8", |n| f64::from(n).to_le_bytes().into());
    check(">f8", |n| f64::from(n).to_be_bytes().into());
}

/// The message about a file of those bytes.
fn fault(bytes: &[u8]) -> String {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("h");
    std::fs::write(&path, bytes).unwrap();
    let error = histogram_file::open(&path, Default::default())
        .and_then(|mut list| list.find(Result::is_err).expect("a histogram in error").map(drop));
    let message = error.unwrap_err().to_string();
    let prefix = path.display().to_string();
    message.strip_prefix(&prefix).expect("the file's name first").to_owned()
}

#[test]
fn a_faulty_csv_is_refused_with_line_column_and_value() {
    let good = csv(&vec![7; 256]);
    let swap = |from: &str, to: &str| fault(good.replacen(from, to, 1).as_bytes());
    let contains = |message: String, parts: [&str; 2]| {
        assert!(parts.iter().all(|part| message.contains(part)), "{message}: {parts:?}");
    };
    let count = "expected a whole number from 0 to 65535";
    contains(
        swap("bin,count", "bin,hits"),
        [":2:1: bin,hits", "expected one of the headers `bin,count`, `count`"],
    );
    contains(swap("bin,count", "bin;count"), [":3:1:", "1 fields, expected 2"]);
    contains(fault(b""), ["", "expected one of the headers `bin,count`, `count`"]);
    contains(swap("\n9,7", "\n9,-1"), [":12:3: count = -1", count]);
    contains(swap("\n9,7", "\n9,1.5"), [":12:3: count = 1.5", count]);
    contains(swap("\n9,7", "\n9,many"), [":12:3: count = many", count]);
    contains(swap("\n9,7", "\n9,65536"), [":12:3: count = 65536", count]);
    contains(swap("\n9,7", "\n9,"), [":12:3: count", count]);
    contains(swap("\n9,7", "\n9,7,7"), [":12:1:", "3 fields, expected 2"]);
    contains(swap("\n9,7", "\n9 7"), [":12:1:", "1 fields, expected 2"]);
    let order = "expected 9: the numbers of all bins from 0 on, in order";
    contains(swap("\n9,7", ""), [":12:1: bin = 10", order]);
    contains(swap("\n9,7", "\n8,7"), [":12:1: bin = 8", order]);
    contains(swap("\n9,7", "\n-9,7"), [":12:1: bin = -9", order]);
    contains(swap("\n255,7", ""), ["", "255 rows, expected 256"]);
    contains(fault(format!("{good}256,7\n").as_bytes()), [":259:1:", "expected 256 rows"]);
    let allowed = "the estimator's bit widths allow 65535 hits in all";
    contains(swap("\n9,7", "\n9,63751"), ["total = 65536", allowed]);
    contains(fault(b"bin,count\n0,\xff\n"), [":2:3:", "expected CSV in UTF-8"]);
    contains(fault(&vec![b'1'; 2 << 20]), ["", "more than 1 MiB, expected CSV"]);
}

#[test]
fn a_csv_may_have_comments_blank_lines_spaces_and_windows_line_ends() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("h.csv");
    let histogram: Histogram = (0..256).map(|bin| (bin * 31) % 200).collect();
    let text =
        csv(&histogram).replace(',', ", ").replace('\n', "\r\n").replace("\n77,", "\n\n#\n77,");
    std::fs::write(&path, format!("\u{feff}{text}")).unwrap();
    assert!(single(&path).unwrap() == histogram);
}

#[test]
fn a_faulty_npy_is_refused_with_shape_type_or_place() {
    let zeros = [0; 4096];
    assert!(fault(&npy("<u2", "(255,)", &zeros)).contains("shape = (255): expected (256) or (n,"));
    assert!(fault(&npy("<u2", "(256, 2)", &zeros)).contains("shape = (256, 2): expected"));
    assert!(fault(&npy("<u2", "(2, 2, 256)", &zeros)).contains("shape = (2, 2, 256): expected"));
    assert!(fault(&npy("<u2", "(0, 256)", &[])).contains("shape = (0, 256): expected"));
    assert!(fault(&npy("<f2", "(256,)", &zeros)).contains("dtype = '<f2': expected integers"));
    assert!(fault(&npy("|b1", "(256,)", &zeros)).contains("dtype = '|b1': expected integers"));
    let short = fault(&npy("<u2", "(2, 256)", &zeros[..1022]));
    assert_eq!(short, ": histogram 1, bin 255: the file ends here, expected 2 histograms");
    let word = |descr, bin: usize, bytes: &[u8]| {
        let mut data = zeros;
        data[bin * bytes.len()..][..bytes.len()].copy_from_slice(bytes);
        fault(&npy(descr, "(256,)", &data))
    };
    let count = "expected a whole number from 0 to 65535";
    let at_3 = |value| format!(": histogram 0, bin 3 = {value}: {count}");
    assert_eq!(word("<i2", 3, &(-5i16).to_le_bytes()), at_3("-5"));
    assert_eq!(word("<i4", 3, &65_536i32.to_le_bytes()), at_3("65536"));
    assert_eq!(word("<f8", 3, &2.5f64.to_le_bytes()), at_3("2.5"));
    assert_eq!(word("<f8", 3, &f64::NAN.to_le_bytes()), at_3("NaN"));
    let total = fault(&npy("<u2", "(256,)", &[1; 512]));
    assert_eq!(
        total,
        ": total of histogram 0 = 65792: the estimator's bit widths allow 65535 hits in all"
    );
    assert!(fault(&npy("<u2", "(256,)", &zeros)[..40]).contains("unreadable .npy"));
    for shape in ["(99999999999999999, 256)", &"[".repeat(900), "(256", "(-1, 256)"] {
        assert!(fault(&npy("<u2", shape, &zeros)).contains("unreadable .npy"), "{shape}");
    }
}

#[test]
fn a_histogram_file_that_is_not_there_or_no_file_is_an_error() {
    for path in ["/nonexistent/h.csv", "/"] {
        let error = single(Path::new(path)).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{path}: cannot read")), "{error}");
    }
}
