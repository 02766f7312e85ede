//! Histograms in Parquet files of other programs, and damaged ones of ours.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{Compression, GzipLevel, ZstdLevel};
use parquet::data_type::Int32Type;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use crate::common::{empty, json, refused, stdout};

const C06: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cases/c06_512_bins_read_as_256.parquet");
const C07: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cases/c07_zstd.parquet");
/// Key of the checksum of a whole file.
const WHOLE: &[u8] = b"tofsim.crc32";

/// Writes a table of columns of those names, row by row the same counts.
fn table(path: &Path, names: &[String], rows: usize, compression: Compression) {
    let columns: String = names.iter().map(|name| format!("required int32 {name}; ")).collect();
    let schema = parse_message_type(&format!("message measured {{ {columns} }}")).unwrap();
    let properties = WriterProperties::builder().set_compression(compression).build();
    let file = fs::File::create(path).unwrap();
    let mut writer =
        SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties)).unwrap();
    if rows > 0 {
        let mut group = writer.next_row_group().unwrap();
        let mut place = 0;
        while let Some(mut column) = group.next_column().unwrap() {
            let counts = vec![place % 7; rows];
            column.typed::<Int32Type>().write_batch(&counts, None, None).unwrap();
            column.close().unwrap();
            place += 1;
        }
        group.close().unwrap();
    }
    writer.close().unwrap();
}

fn bins(count: usize) -> Vec<String> {
    (0..count).map(|bin| format!("b{bin}")).collect()
}

#[test]
fn a_table_with_more_bins_than_the_scenario_or_a_bin_twice_is_refused() {
    let folder = empty();
    let folder = folder.path();
    let expected =
        "bins = 512: expected 256, b0 to b255: a column for each bin of the scenario's histogram";
    let own = "bins = 512: expected 256 as tdc.bins of scenario kc705 says, or --bin-ps";
    for (verb, expected) in [
        (&["estimate"][..], own),
        (&["evaluate", "--data"], expected),
        (&["train", "--quick", "--data"], expected),
    ] {
        let error = refused(folder, &[verb, &[C06]].concat());
        assert!(error.contains(expected), "{error}");
    }
    let path = folder.join("m.parquet");
    table(&path, &[bins(256), vec!["b7".to_owned()]].concat(), 2, Compression::UNCOMPRESSED);
    assert!(refused(folder, &["estimate", "m.parquet"]).contains("bins = 257"));
    table(&path, &[bins(255), vec!["b7".to_owned()]].concat(), 2, Compression::UNCOMPRESSED);
    assert!(refused(folder, &["estimate", "m.parquet"]).contains("column b7: there twice"));
    table(&path, &bins(255), 2, Compression::UNCOMPRESSED);
    assert!(refused(folder, &["estimate", "m.parquet"]).contains("bins = 255"));
    let error = refused(folder, &["evaluate", "--data", "m.parquet"]);
    assert!(error.contains("column b255: missing"), "{error}");
}

#[test]
fn a_table_without_rows_is_refused_by_every_verb() {
    let folder = empty();
    let folder = folder.path();
    table(&folder.join("m.parquet"), &bins(256), 0, Compression::UNCOMPRESSED);
    let calibrate = ["calibrate", "pulse", "m.parquet", "-o", "pulse"];
    for args in [&["estimate", "m.parquet"][..], &["evaluate", "--data", "m.parquet"], &calibrate] {
        let error = refused(folder, args);
        assert!(error.contains("m.parquet: no rows; expected one histogram at least"), "{error}");
    }
}

#[test]
fn tables_of_other_compressions_are_read_and_brotli_is_refused_in_words() {
    let folder = empty();
    let folder = folder.path();
    let rows = json(folder, &["estimate", "--json", C07]);
    let depths = rows["histograms"].as_array().unwrap();
    assert!(depths.len() > 1 && depths.iter().all(|row| row["depth_m"].is_f64()), "{rows}");
    let path = folder.join("m.parquet");
    table(&path, &bins(256), 3, Compression::UNCOMPRESSED);
    let plain = json(folder, &["estimate", "--json", "m.parquet"]);
    for compression in [
        Compression::ZSTD(ZstdLevel::default()),
        Compression::GZIP(GzipLevel::default()),
        Compression::LZ4_RAW,
        Compression::LZ4,
        Compression::SNAPPY,
    ] {
        table(&path, &bins(256), 3, compression);
        assert_eq!(json(folder, &["estimate", "--json", "m.parquet"]), plain, "{compression}");
    }
    // The library cannot write it either: the footer of an uncompressed file is made to say so.
    table(&path, &bins(256), 3, Compression::UNCOMPRESSED);
    brotli(&path);
    let error = refused(folder, &["estimate", "m.parquet"]);
    let expected = "compression of column b0 = BROTLI: expected no compression, or Snappy, gzip, LZ4 or Zstandard";
    assert!(error.contains(expected), "{error}");
}

/// Changes the codec of the first column in the footer to that of Brotli.
fn brotli(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    // Path of the column, a list of one text, and the next field, the codec as a number in zigzag.
    let column = [0x19, 0x18, 2, b'b', b'0', 0x15];
    let place = bytes.windows(6).rposition(|part| part == column).unwrap() + column.len();
    assert_eq!(bytes[place], 0);
    bytes[place] = 8;
    fs::write(path, bytes).unwrap();
}

/// A folder with a data set in `d`, its path, and its bytes.
fn dataset() -> (tempfile::TempDir, PathBuf, Vec<u8>) {
    let folder = empty();
    let drawn = ["dataset", "--grid", "target.distance_m=0.2,0.5", "--repeats", "3", "-q"];
    stdout(folder.path(), &[&drawn[..], &["--format", "parquet", "-o", "d"]].concat());
    let path = folder.path().join("d/dataset.parquet");
    let bytes = fs::read(&path).unwrap();
    (folder, path, bytes)
}

#[test]
fn every_flipped_bit_of_a_dataset_is_noticed() {
    let (folder, path, whole) = dataset();
    let name = whole.windows(WHOLE.len()).rposition(|part| part == WHOLE).unwrap();
    for k in 0..60 {
        let place = 4 + (whole.len() - 5) * k / 59;
        // Without its name there is no checksum, and all else is right.
        if !(name..name + WHOLE.len()).contains(&place) {
            let mut bytes = whole.clone();
            bytes[place] ^= 1 << (k % 8);
            fs::write(&path, bytes).unwrap();
            let error = refused(folder.path(), &["estimate", "d/dataset.parquet"]);
            assert!(error.contains("unreadable Parquet"), "byte {place}: {error}");
        }
    }
}

#[test]
fn pages_have_checksums_of_their_own_for_other_readers() {
    let (folder, path, mut bytes) = dataset();
    let name = bytes.windows(WHOLE.len()).rposition(|part| part == WHOLE).unwrap();
    bytes[name] = b'T';
    fs::write(&path, &bytes).unwrap();
    stdout(folder.path(), &["estimate", "d/dataset.parquet", "-q"]);
    let file = SerializedFileReader::new(fs::File::open(&path).unwrap()).unwrap();
    let columns = file.metadata().row_group(0).columns();
    let bins = columns.iter().filter(|column| column.column_path().string().starts_with('b'));
    for column in bins.step_by(37) {
        let (begin, length) = column.byte_range();
        let last = (begin + length - 1) as usize;
        bytes[last] ^= 0x10;
        fs::write(&path, &bytes).unwrap();
        let error = refused(folder.path(), &["estimate", "d/dataset.parquet"]);
        assert!(error.contains("Page CRC checksum mismatch"), "{error}");
        bytes[last] ^= 0x10;
    }
}
