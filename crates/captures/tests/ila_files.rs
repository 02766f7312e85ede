//! Tests of captures as written by real tools, and of faulty ones.

use tofsim_captures::ila::Radix;
use tofsim_captures::ila::read::{CaptureForm, CaptureRow, Column, Opened};

use crate::ila::fixtures::{bytes, fixture};
use crate::ila::{read, read_bytes};

/// Returns the values of a column.
fn values(opened: &Opened, rows: &[CaptureRow], name: &str) -> Vec<u64> {
    let column = opened.columns.iter().find(|column| column.name == name).unwrap();
    rows.iter().map(|row| row.value[column.word]).collect()
}

fn open(name: &str) -> (Opened, Vec<CaptureRow>) {
    read(&fixture(name), None).unwrap()
}

fn radices(opened: &Opened) -> Vec<Option<Radix>> {
    opened.columns.iter().map(|column| column.radix).collect()
}

/// Returns the error for a CSV of one or two probes.
fn fault(probes: &str, rows: &str) -> String {
    let head = format!("Sample in Buffer,Sample in Window,TRIGGER,{probes}\n{rows}");
    read_bytes(head.as_bytes(), None).err().unwrap_or("fine".into())
}

/// Returns the error for a CSV of one probe in a given radix.
fn fault_in(radix: &str, probe: &str, rows: &str) -> String {
    fault(probe, &format!("Radix - UNSIGNED,UNSIGNED,UNSIGNED,{radix}\n{rows}"))
}

#[test]
fn values_of_every_radix_and_odd_names_are_read() {
    let (opened, rows) = open("radices.csv");
    assert_eq!((opened.form, opened.radix_stated), (CaptureForm::Csv, true));
    let heads: Vec<_> = opened.columns.iter().map(Column::head).collect();
    let expected = [
        "top/u_tdc/code[8:0]",
        "level_reg_n_0[7:0]",
        "hits[15:4]",
        "state[2:0]",
        "mode[4:0]",
        "valid",
        "r[4]",
        "<const0>_17",
        "one[0:0]",
        "Interface_(i1:s0)_(axi_dma_0_M_AXIS_MM2S)[2:0]",
        "a,b[3:0]",
        "\\path/sum",
    ];
    assert_eq!(heads, expected);
    let value = |name| values(&opened, &rows, name);
    assert_eq!(value("top/u_tdc/code"), [0x1ff, 0xa, 0x1ff]);
    assert_eq!(value("level_reg_n_0"), [0xf4, 127, 128]);
    assert_eq!(value("hits"), [4095, 0, 17]);
    assert_eq!(value("state"), [5, 0, 2]);
    assert_eq!(value("mode"), [31, 0, 10]);
    assert_eq!(value("r[4]"), [0, 1, 1]);
    assert_eq!(value("a,b"), [15, 0, 10]);
    let triggers: Vec<_> = rows.iter().map(|row| row.trigger).collect();
    assert_eq!(triggers, [false, true, false]);
    assert_eq!((opened.columns[2].lsb, opened.columns[8].vector), (4, true));
}

#[test]
fn windows_line_ends_and_a_byte_order_mark_change_nothing() {
    let text = String::from_utf8(bytes("radices.csv")).unwrap();
    let (_, rows) = open("radices.csv");
    let crlf = text.replace('\n', "\r\n");
    assert_eq!(read_bytes(crlf.as_bytes(), None).unwrap().1, rows);
    let (opened, marked) = read_bytes(format!("\u{feff}{text}").as_bytes(), None).unwrap();
    assert_eq!((opened.columns.len(), marked), (12, rows.clone()));
    assert_eq!(read_bytes(text.trim_end().as_bytes(), None).unwrap().1, rows);
}

#[test]
fn radices_that_the_file_does_not_tell_are_inferred() {
    let (opened, rows) = open("legacy.csv");
    assert_eq!((opened.form, opened.radix_stated), (CaptureForm::LegacyCsv, false));
    let expected =
        [Radix::Hex, Radix::Signed, Radix::Unsigned, Radix::Binary, Radix::Hex, Radix::Hex];
    assert_eq!(radices(&opened), expected.map(Some));
    let value = |name| values(&opened, &rows, name);
    assert_eq!(value("code"), [0xff, 0x1000, 0x10]);
    assert_eq!(value("level"), [0xfff4, 10, 7]);
    assert_eq!(value("bits"), [10, 0xf0, 1]);
    assert_eq!(value("GAP"), [0, 1, 0]);
    assert!(rows.iter().all(|row| !row.gap));
}

#[test]
fn a_column_of_several_readings_is_an_error_until_one_is_chosen() {
    let error = read(&fixture("ambiguous.csv"), None).err().unwrap().to_string();
    let expected =
        "count[15:0] = 1000: may be HEX or UNSIGNED or SIGNED or BINARY; select one with --radix";
    assert!(error.contains(&format!("ambiguous.csv:2:9: {expected}")), "{error}");
    let counts = |radix| {
        let (opened, rows) = read(&fixture("ambiguous.csv"), Some(radix)).unwrap();
        values(&opened, &rows, "count")
    };
    assert_eq!(counts(Radix::Hex), [0x1000, 0x1010]);
    assert_eq!(counts(Radix::Unsigned), [1000, 1010]);
    assert_eq!(counts(Radix::Binary), [8, 10]);
}

#[test]
fn words_in_quotes_are_no_numbers() {
    let (opened, rows) = open("system_ila.csv");
    let texts: Vec<_> = opened.columns.iter().map(|column| column.text).collect();
    assert_eq!(texts, [false, true, true, false]);
    assert_eq!((rows[0].value.len(), opened.columns[3].word), (34, 33));
    let word = |name, row: usize| values(&opened, &rows, name)[row].to_le_bytes();
    assert_eq!(word("slot_0_axis_status", 1), *b"Active\0\0");
    assert_eq!(values(&opened, &rows, "slot_0_axis_tdata"), [0xa5, 0x5a]);
    assert_eq!(values(&opened, &rows, "slot_0_axis_tvalid"), [1, 0]);
    let text = String::from_utf8(bytes("system_ila.csv")).unwrap();
    let error =
        read_bytes(text.replace("Stream\",0", "Stream\",7").as_bytes(), None).err().unwrap();
    assert!(error.starts_with("capture:4:33: slot_0_axis_tvalid = 7: expected a HEX"), "{error}");
}

#[test]
fn gaps_are_unknown_digits() {
    let (opened, rows) = open("chipscopy_gap.csv");
    assert_eq!(opened.columns.len(), 2);
    let found: Vec<_> = rows.iter().map(|row| (row.gap, row.unknown.clone())).collect();
    assert_eq!(found[0], (false, vec![0, 0]));
    assert_eq!(found[1], (true, vec![0x1ff, 1]));
    assert_eq!(values(&opened, &rows, "count"), [0x1ff, 0, 0, 0]);
}

#[test]
fn windows_begin_where_their_samples_begin_again() {
    let (_, rows) = open("windows.csv");
    let found: Vec<_> =
        rows.iter().map(|row| (row.sample, row.in_window, row.window_start, row.trigger)).collect();
    assert_eq!(found[2..5], [(2, 2, false, false), (3, 0, true, true), (4, 1, false, false)]);
    assert_eq!(found[6], (6, 0, true, false));
}

#[test]
fn values_of_128_bits_and_more_are_exact() {
    let (_, rows) = open("wide.csv");
    let expected = [u64::MAX, u64::MAX, 0, 1 << 63, 0x2345_6789_abcd_ef01, 1, 0x80];
    assert_eq!(rows[0].value, expected);
}

#[test]
fn a_capture_without_samples_is_fine() {
    let (opened, rows) = open("empty.csv");
    assert_eq!((opened.columns.len(), rows.len()), (2, 0));
    let head = "Sample in Buffer,Sample in Window,TRIGGER,a[3:0]";
    let (_, rows) = read_bytes(head.as_bytes(), None).unwrap();
    assert_eq!(rows.len(), 0);
}

#[test]
fn rows_with_too_few_or_too_many_fields_are_refused_with_their_line() {
    let few = fault_in("HEX", "a[3:0]", "0,0,0,1\n1,1,0\n");
    assert_eq!(few, "capture:4:1: 1,1,0: too few fields: 3, expected 4");
    let many = fault("a[3:0]", "0,0,0,1\n1,1,0,1,1\n");
    assert_eq!(many, "capture:3:1: 1,1,0,1,1: too many fields: 5, expected 4");
    let radices = fault_in("HEX,HEX", "a", "0,0,0,1\n");
    assert_eq!(
        radices,
        "capture:2:1: Radix - UNSIGNED,UNSIGNED,UNSIGNED,HEX,HEX: 5 radices, expected 4"
    );
}

#[test]
fn cells_that_are_no_value_of_their_probe_are_refused() {
    let cell = |radix, cell| fault_in(radix, "a[7:0]", &format!("0,0,0,{cell}\n"));
    assert_eq!(
        cell("HEX", "0g"),
        "capture:3:7: a[7:0] = 0g: expected HEX digits only, unless the radix is wrong"
    );
    assert_eq!(cell("HEX", ""), "capture:3:7: a[7:0] = \"\": expected HEX digits");
    let wide = "expected a HEX number of 8 bits at most, unless the radix is wrong";
    assert_eq!(cell("HEX", "1ff"), format!("capture:3:7: a[7:0] = 1ff: {wide}"));
    let wide = "expected a UNSIGNED number of 8 bits at most, unless the radix is wrong";
    assert_eq!(cell("UNSIGNED", "256"), format!("capture:3:7: a[7:0] = 256: {wide}"));
    let wide = "expected a SIGNED number of 8 bits, from -2^7 to 2^7 - 1";
    assert_eq!(cell("SIGNED", "128"), format!("capture:3:7: a[7:0] = 128: {wide}"));
    assert_eq!(
        cell("BINARY", "12"),
        "capture:3:7: a[7:0] = 12: expected BINARY digits only, unless the radix is wrong"
    );
    assert_eq!(
        cell("OCTAL", "18"),
        "capture:3:7: a[7:0] = 18: expected OCTAL digits only, unless the radix is wrong"
    );
    let legacy = fault("a[7:0]", "0,0,0,0a\n1,1,0,-1\n");
    assert_eq!(legacy, "capture:3:7: a[7:0] = -1: expected HEX of 8 bits, as above");
}

#[test]
fn samples_windows_and_triggers_that_go_wrong_are_refused() {
    let rows = |rows| fault_in("HEX", "a", rows);
    let sample = "capture:4:1: Sample in Buffer = 2: expected 1, the sample after 0";
    assert_eq!(rows("0,0,0,1\n2,1,0,1\n"), sample);
    let window = "capture:4:3: Sample in Window = 2: expected 1, or 0 where a window begins";
    assert_eq!(rows("0,0,0,1\n1,2,0,1\n"), window);
    let trigger = "capture:4:5: TRIGGER = 1: a second trigger in this window";
    assert_eq!(rows("0,0,1,1\n1,1,1,1\n"), trigger);
    assert_eq!(rows("0,0,2,1\n"), "capture:3:5: TRIGGER = 2: expected 0 or 1");
    let number = "capture:3:1: Sample in Buffer = -1: expected a whole number";
    assert_eq!(rows("-1,0,0,1\n"), number);
}

#[test]
fn lines_that_end_differently_and_open_quotes_are_refused() {
    let mixed = fault_in("HEX", "a", "0,0,0,1\r\n1,1,0,1\n");
    assert!(mixed.starts_with("capture:3:8: the line ends with CRLF"), "{mixed}");
    let open = fault_in("HEX", "a", "0,0,0,\"1\n1,1,0,1\n");
    assert!(open.starts_with("capture:3:8: a quote is not closed on its line"), "{open}");
    let empty = fault_in("HEX", "a", "0,0,0,1\n\n1,1,0,1\n");
    assert!(empty.starts_with("capture:4:1: an empty line"), "{empty}");
}

#[test]
fn heads_and_radices_that_cannot_be_are_refused() {
    assert!(fault("a[0:15]", "").starts_with("capture:1:43: a[0:15]: expected a range [msb:lsb]"));
    assert!(fault("a[99999999999:0]", "").contains("expected a range [msb:lsb] of 1 to 4096"));
    assert!(fault("a,a", "").starts_with("capture:1:45: a: a second column of this name"));
    let word = fault_in("REAL", "a", "");
    assert!(word.starts_with("capture:2:36: a = REAL: expected HEX, SIGNED"), "{word}");
    for text in ["", "time,value\n0,1\n", "$date\n$end\n", "\u{0}\u{ff}"] {
        let error = read_bytes(text.as_bytes(), None).err().unwrap();
        assert!(error.contains("capture:1:1: ") && error.contains("expected a head"), "{error}");
    }
}

#[test]
fn text_that_is_not_utf_8_is_refused() {
    let head = b"Sample in Buffer,Sample in Window,TRIGGER,a,b\xff\n";
    let error = read_bytes(head, None).err().unwrap();
    assert!(error.starts_with("capture:1:45: b\u{fffd}: expected UTF-8 text"), "{error}");
    let mut text = bytes("system_ila.csv");
    let place = text.windows(6).position(|window| window == b"Active").unwrap();
    text[place] = 0xff;
    let error = read_bytes(&text, None).err().unwrap();
    assert!(error.starts_with("capture:4:10: \u{fffd}ctive: expected UTF-8 text"), "{error}");
}
