//! Archives as Vivado writes them, and what is wrong with others.

use tofsim_captures::ila::read::{CaptureForm, Column, Opened};

use crate::ila::fixtures::{archive_but, bytes};
use crate::ila::{archive, read_bytes};

/// What is said about an archive with other entries.
fn archive_fault(but: &[(&str, &[u8])]) -> String {
    read_bytes(&archive_but(but), None).err().unwrap_or("fine".into())
}

#[test]
fn an_archive_is_read_from_its_dump() {
    let (csv, rows) = read_bytes(&bytes("archive/waveform.csv"), None).unwrap();
    let (opened, from_dump) = read_bytes(&archive_but(&[]), None).unwrap();
    assert_eq!((opened.form, opened.radix_told), (CaptureForm::Archive, true));
    assert_eq!(opened.columns, csv.columns);
    assert_eq!(from_dump, rows);
}

#[test]
fn an_archive_without_a_csv_has_its_names_from_the_list_of_probes() {
    let (csv, rows) = read_bytes(&bytes("archive/waveform.csv"), None).unwrap();
    let (opened, from_dump) = read_bytes(&archive_but(&[("waveform.csv", b"")]), None).unwrap();
    assert!(!opened.radix_told && opened.columns.iter().all(|column| column.radix.is_none()));
    let heads = |opened: &Opened| opened.columns.iter().map(Column::head).collect::<Vec<_>>();
    assert_eq!((heads(&opened), from_dump), (heads(&csv), rows));
}

#[test]
fn an_archive_without_a_dump_is_read_from_its_csv() {
    let (csv, rows) = read_bytes(&bytes("archive/waveform.csv"), None).unwrap();
    let (opened, from_csv) = read_bytes(&archive_but(&[("waveform.dmp", b"")]), None).unwrap();
    assert_eq!((opened.form, from_csv), (CaptureForm::Archive, rows));
    assert_eq!(opened.columns, csv.columns);
}

#[test]
fn archives_that_are_cut_damaged_or_incomplete_are_refused() {
    let whole = archive_but(&[]);
    let cut = read_bytes(&whole[..whole.len() / 2], None).err().unwrap();
    assert!(cut.starts_with("capture: expected a whole ZIP archive: "), "{cut}");
    let stored = read_bytes(&archive(&[("waveform.dmp", b"")]), None).err().unwrap();
    assert!(stored.contains("capture/waveform.dmp: expected data_width"), "{stored}");
    let none = archive_fault(&[("waveform.dmp", b""), ("waveform.csv", b"")]);
    assert_eq!(none, "capture: expected an entry waveform.dmp or waveform.csv in the archive");
    let names = archive_fault(&[("waveform.csv", b""), ("probes.ltx", b"")]);
    assert!(names.starts_with("capture: expected an entry waveform.csv or probes.ltx"), "{names}");
}

#[test]
fn counts_in_an_archive_that_do_not_agree_are_refused() {
    let dump = String::from_utf8(bytes("archive/waveform.dmp")).unwrap();
    let fault = |from: &str, to: &str| {
        archive_fault(&[("waveform.dmp", dump.replace(from, to).as_bytes())])
    };
    let width = fault("ch[6]: 00110\n", "");
    assert_eq!(width, "capture/waveform.dmp: ends after 6 channels, expected 7 (data_width)");
    let samples = fault("sample_count:5", "sample_count:6");
    let place = "capture/waveform.dmp:11:13: ch[0]: 5 samples, expected 6";
    assert!(samples.starts_with(place), "{samples}");
    let bits = fault("data_width:7", "data_width:6").replace("ch[6]", "");
    assert!(bits.contains("expected no more than 6 channels"), "{bits}");
    let csv = b"Sample in Buffer,Sample in Window,TRIGGER,a[1:0]\n";
    let columns = archive_fault(&[("waveform.csv", csv)]);
    let expected = "capture/waveform.csv: the columns have 2 bits, the dump has 7 (data_width)";
    assert_eq!(columns, expected);
    let huge = fault("sample_count:5", "sample_count:99999999");
    assert!(huge.contains("more than any FPGA's block RAM holds"), "{huge}");
}

#[test]
fn a_flipped_bit_in_an_archive_is_found_by_its_check_sum() {
    let stored = archive_but(&[]);
    let start = stored.windows(12).position(|window| window == b"waveform.dmp").unwrap();
    let mut refused = 0;
    for place in start + 12..start + 132 {
        let mut flipped = stored.clone();
        flipped[place] ^= 1;
        let error = read_bytes(&flipped, None).err();
        refused += error.is_some_and(|error| error.contains("waveform.dmp")) as usize;
    }
    assert_eq!(refused, 120);
}

#[test]
fn a_list_of_probes_that_unpacks_to_too_much_is_refused() {
    let bomb = archive_but(&[("waveform.csv", b""), ("probes.ltx", &[b' '; (1 << 23) + 1])]);
    assert!(bomb.len() < 1 << 16);
    let error = read_bytes(&bomb, None).err().unwrap();
    assert_eq!(error, "capture/probes.ltx: unpacks to more than 8388608 bytes");
}

#[test]
fn a_list_of_probes_that_is_nested_without_end_is_refused() {
    let nested = "<a>".repeat(1 << 20);
    let error = archive_fault(&[("waveform.csv", b""), ("probes.ltx", nested.as_bytes())]);
    assert!(error.starts_with("capture/probes.ltx:1:"), "{error}");
}
