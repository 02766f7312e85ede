//! Tests of archives as written by Vivado, and of faulty ones.

use tofsim_captures::ila::read::{CaptureForm, CaptureRow, Column, Opened};

use crate::ila::fixtures::{archive_but, bytes, views_but};
use crate::ila::{archive, read_bytes};

/// Returns the error for an archive with some entries replaced.
fn archive_fault(but: &[(&str, &[u8])]) -> String {
    read_bytes(&archive_but(but), None).err().unwrap_or("fine".into())
}

#[test]
fn an_archive_is_read_from_its_dump() {
    let (csv, rows) = read_bytes(&bytes("archive/waveform.csv"), None).unwrap();
    let (opened, from_dump) = read_bytes(&archive_but(&[]), None).unwrap();
    assert_eq!((opened.form, opened.radix_stated), (CaptureForm::Archive, true));
    assert_eq!(opened.columns, csv.columns);
    assert_eq!(from_dump, rows);
}

#[test]
fn an_archive_without_a_csv_has_its_names_from_the_list_of_probes() {
    let (csv, rows) = read_bytes(&bytes("archive/waveform.csv"), None).unwrap();
    let (opened, from_dump) = read_bytes(&archive_but(&[("waveform.csv", b"")]), None).unwrap();
    assert!(!opened.radix_stated && opened.columns.iter().all(|column| column.radix.is_none()));
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

/// Returns the values of a column in all rows.
fn by_name(opened: &Opened, rows: &[CaptureRow], name: &str) -> Vec<u64> {
    let column = opened.columns.iter().find(|column| column.name == name).unwrap();
    rows.iter().map(|row| row.value[column.word]).collect()
}

/// Asserts that an archive with some entries replaced has the CSV's values, with notes that contain `words`.
fn falls_back(but: &[(&str, &[u8])], words: &[&str]) {
    let (opened, rows) = read_bytes(&archive_but(but), None).unwrap();
    let (_, whole) = read_bytes(&archive_but(&[]), None).unwrap();
    assert_eq!(rows, whole);
    let notes = opened.notes.join("\n");
    assert!(words.iter().all(|words| notes.contains(words)), "{notes}");
}

#[test]
fn an_archive_of_windows_and_of_vivado_2016_is_the_same() {
    let crlf = ["waveform.csv", "waveform.dmp", "probes.ltx"].map(|name| {
        let text = String::from_utf8(bytes(&format!("archive/{name}"))).unwrap();
        (name, text.replace('\n', "\r\n"))
    });
    let crlf = crlf.each_ref().map(|(name, text)| (*name, text.as_bytes()));
    let (_, whole) = read_bytes(&archive_but(&[]), None).unwrap();
    assert_eq!(read_bytes(&archive_but(&crlf), None).unwrap().1, whole);
    let lines = |name: &str, drop: &dyn Fn(&str) -> bool| -> String {
        let text = String::from_utf8(bytes(name)).unwrap();
        text.lines().filter(|line| !drop(line)).map(|line| format!("{line}\n")).collect()
    };
    let dump = lines("archive/waveform.dmp", &|line| {
        line.starts_with("clock_") || line.starts_with("timestamp_")
    });
    let csv = lines("archive/waveform.csv", &|line| line.starts_with("Radix"));
    let list =
        lines("archive/probes.ltx", &|line| line.contains("BSCAN") || line.contains("CORE_UUID"));
    let list = list.replace("version=\"2\"", "version=\"1\"");
    let old = [("waveform.dmp", &dump), ("waveform.csv", &csv), ("probes.ltx", &list)];
    let (opened, rows) =
        read_bytes(&archive_but(&old.map(|(n, t)| (n, t.as_bytes()))), None).unwrap();
    assert_eq!((rows, opened.notes, opened.radix_stated), (whole, vec![], false));
}

#[test]
fn an_archive_without_samples_is_fine() {
    let dump = "core_id :1_1_0\ndata_width             :0\nsample_count           :0\nwindow_marks           :\n";
    let csv = "Sample in Buffer,Sample in Window,TRIGGER,a[1:0],b[7:4],c\n";
    let empty = [("waveform.dmp", dump.as_bytes()), ("waveform.csv", csv.as_bytes())];
    let (opened, rows) = read_bytes(&archive_but(&empty), None).unwrap();
    assert_eq!((opened.columns.len(), rows.len(), opened.notes), (3, 0, vec![]));
}

#[test]
fn columns_share_bits_of_the_dump_as_the_list_of_probes_says() {
    let (opened, rows) = read_bytes(&views_but(&[]), None).unwrap();
    let value = |name| by_name(&opened, &rows, name);
    assert_eq!(value("slot_0_ctrl"), [1, 3, 7, 2]);
    assert_eq!(
        (value("slot_0_valid"), value("slot_0_ready")),
        (vec![1, 1, 1, 0], vec![0, 1, 1, 1])
    );
    assert_eq!(opened.notes, ["taken from waveform.vcd: Interface_(i1:s0)_(dma_0)[2:0]"]);
}

#[test]
fn words_have_their_bits_from_the_dump_and_the_vcd() {
    let (opened, rows) = read_bytes(&views_but(&[]), None).unwrap();
    assert!(opened.columns.iter().all(|column| !column.text));
    assert_eq!(by_name(&opened, &rows, "state"), [0, 1, 2, 1]);
    assert_eq!(by_name(&opened, &rows, "Interface_(i1:s0)_(dma_0)"), [0, 1, 1, 3]);
    let states = |column: usize| {
        let states = opened.columns[column].states.iter();
        states.map(|state| (state.name.as_str(), state.bits)).collect::<Vec<_>>()
    };
    assert_eq!(states(3), [("idle", Some(0)), ("run", Some(1))]);
    assert_eq!(states(4), [("_", Some(0)), ("Active", Some(1)), ("Inactive", Some(3))]);
}

#[test]
fn words_without_bits_are_kept_as_words() {
    let (opened, rows) = read_bytes(&views_but(&[("waveform.vcd", b"")]), None).unwrap();
    let texts: Vec<_> = opened.columns.iter().map(|column| column.text).collect();
    assert_eq!(texts, [false, false, false, false, true]);
    let letter = |bytes: &[u8; 8]| u64::from_le_bytes(*bytes);
    let expected = [
        letter(b"_\0\0\0\0\0\0\0"),
        letter(b"Active\0\0"),
        letter(b"Active\0\0"),
        letter(b"Inactive"),
    ];
    assert_eq!(by_name(&opened, &rows, "Interface_(i1:s0)_(dma_0)"), expected);
    assert_eq!(opened.notes, ["taken from waveform.csv: Interface_(i1:s0)_(dma_0)[2:0]"]);
}

#[test]
fn columns_that_are_nowhere_in_the_dump_are_taken_from_the_csv() {
    let list = String::from_utf8(bytes("views/probes.ltx")).unwrap();
    let renamed = list.replace("\"slot_0_ready\"", "\"other\"");
    let but: [(&str, &[u8]); 1] = [("probes.ltx", renamed.as_bytes())];
    let (opened, rows) = read_bytes(&views_but(&but), None).unwrap();
    assert_eq!(by_name(&opened, &rows, "slot_0_ready"), [0, 1, 1, 1]);
    assert!(
        opened.notes.contains(&"taken from waveform.csv: slot_0_ready".to_owned()),
        "{:?}",
        opened.notes
    );
}

#[test]
fn a_damaged_part_is_replaced_by_the_others_with_a_note() {
    let broken = "expected a key, a colon and a value";
    let from_csv = "the values are those of waveform.csv, not of waveform.dmp";
    falls_back(&[("waveform.dmp", b"nonsense")], &["waveform.dmp is not used", broken, from_csv]);
    falls_back(
        &[("probes.ltx", b"<a>")],
        &["probes.ltx is not used: ", "capture/probes.ltx:1:1: the root node"],
    );
    let (opened, rows) =
        read_bytes(&views_but(&[("waveform.dmp", b"x"), ("waveform.csv", b"x")]), None).unwrap();
    assert_eq!(by_name(&opened, &rows, "state"), [0, 1, 2, 1]);
    assert_eq!((rows[2].trigger, rows[0].window_start), (true, true));
    let notes = opened.notes.join("\n");
    assert!(notes.contains("the values are those of waveform.vcd"), "{notes}");
    let cut = "Sample in Buffer,Sample in Window,TRIGGER,a[1:0],b[7:4],c\n0,0,0";
    falls_back(&[("waveform.csv", cut.as_bytes())], &[]);
}

#[test]
fn an_archive_that_is_cut_off_gives_what_is_left_of_it() {
    let whole = archive_but(&[]);
    let (_, rows) = read_bytes(&whole, None).unwrap();
    let directory = whole.windows(4).position(|bytes| bytes == b"PK\x01\x02").unwrap();
    let list = whole.windows(10).position(|bytes| bytes == b"probes.ltx").unwrap();
    for end in [directory, list + 20] {
        let (opened, read) = read_bytes(&whole[..end], None).unwrap();
        assert_eq!(read, rows);
        assert!(
            opened.notes[0].starts_with("the archive is cut off or damaged: "),
            "{:?}",
            opened.notes
        );
    }
    let nothing = read_bytes(&whole[..20], None).err().unwrap();
    assert!(nothing.starts_with("capture: expected a whole ZIP archive: "), "{nothing}");
}

#[test]
fn an_archive_inside_a_zip_is_read_and_of_several_none() {
    let inner = archive_but(&[]);
    let (_, rows) = read_bytes(&inner, None).unwrap();
    let (opened, read) =
        read_bytes(&archive(&[("day/board.ila", &inner), ("a.txt", b"a")]), None).unwrap();
    assert_eq!(read, rows);
    assert_eq!(opened.notes, ["the capture is day/board.ila, an archive inside this one"]);
    let several = archive(&[("a.ila", &inner), ("b.ila", &inner)]);
    let error = read_bytes(&several, None).err().unwrap();
    assert_eq!(
        error,
        "capture: a.ila, b.ila: expected one archive inside; unpack the one that is meant"
    );
}

#[test]
fn cells_that_are_not_the_dump_s_bits_are_noted() {
    let csv = String::from_utf8(bytes("archive/waveform.csv")).unwrap();
    let other = csv.replace("2,2,0,3,8,1", "2,2,0,3,9,1");
    falls_back(
        &[("waveform.csv", other.as_bytes())],
        &["b[7:4]: 1 cells of waveform.csv, the first at sample 2"],
    );
}

#[test]
fn a_word_that_stands_for_two_values_has_none() {
    let csv = String::from_utf8(bytes("views/waveform.csv")).unwrap();
    let twice = csv.replace("1,1,2,\"Active\"", "1,1,\"run\",\"Active\"");
    let (opened, _) = read_bytes(&views_but(&[("waveform.csv", twice.as_bytes())]), None).unwrap();
    let state = opened.columns.iter().find(|column| column.name == "state").unwrap();
    let states: Vec<_> = state.states.iter().map(|state| &state.name[..]).collect();
    assert_eq!(states, ["idle"]);
    let note = "state[1:0]: `run` represents both 0x1 and 0x2, and is read as unknown";
    assert!(opened.notes.iter().any(|own| own == note), "{:?}", opened.notes);
    let words = twice.replace("\"idle\"", "\"run\"");
    let (opened, _) = read_bytes(&views_but(&[("waveform.csv", words.as_bytes())]), None).unwrap();
    assert!(opened.columns.iter().all(|column| column.name != "state" || column.states.is_empty()));
}

#[test]
fn archives_of_which_no_part_can_be_read_are_refused() {
    let stored = read_bytes(&archive(&[("waveform.dmp", b"")]), None).err().unwrap();
    assert!(stored.contains("capture/waveform.dmp: expected data_width"), "{stored}");
    let none = archive_fault(&[("waveform.dmp", b""), ("waveform.csv", b"")]);
    assert_eq!(none, "capture: expected an entry waveform.dmp or waveform.csv in the archive");
    let names = archive_fault(&[("waveform.csv", b""), ("probes.ltx", b"")]);
    assert!(names.starts_with("capture: expected an entry waveform.csv or probes.ltx"), "{names}");
}

#[test]
fn counts_in_an_archive_that_do_not_agree_are_told() {
    let dump = String::from_utf8(bytes("archive/waveform.dmp")).unwrap();
    let fault = |from: &str, to: &str| {
        archive_fault(&[("waveform.dmp", dump.replace(from, to).as_bytes()), ("waveform.csv", b"")])
    };
    let width = fault("    ch[6]: 00110\n", "");
    assert_eq!(width, "capture/waveform.dmp: ends after 6 channels, expected 7 (data_width)");
    let samples = fault("sample_count           :5", "sample_count           :6");
    let place = "capture/waveform.dmp:16:17: ch[0]: 5 samples, expected 6";
    assert!(samples.starts_with(place), "{samples}");
    let bits = fault("data_width             :7", "data_width             :6");
    assert!(bits.contains("expected no more than 6 channels"), "{bits}");
    let huge = fault("sample_count           :5", "sample_count :99999999");
    assert!(huge.contains("more than any FPGA's block RAM holds"), "{huge}");
}

#[test]
fn a_flipped_bit_in_an_archive_is_found_by_its_check_sum() {
    let stored = archive_but(&[]);
    let (_, rows) = read_bytes(&stored, None).unwrap();
    let start = stored.windows(12).position(|window| window == b"waveform.dmp").unwrap();
    for place in start + 12..start + 132 {
        let mut flipped = stored.clone();
        flipped[place] ^= 1;
        let (opened, read) = read_bytes(&flipped, None).unwrap();
        assert_eq!(read, rows);
        assert!(
            opened.notes.iter().any(|note| note.starts_with("waveform.dmp is not used")),
            "{place}"
        );
    }
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
