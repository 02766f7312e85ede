//! Columns of words, against words and against bits.

use crate::common;

use super::which::rows;
use super::{csv, different, same, write};

#[test]
fn columns_of_words_are_compared_as_words() {
    let folder = common::empty();
    let folder = folder.path();
    let table = |words: [&str; 2]| {
        let values = [0, 1].map(|k| format!("{k},\"{}\"", words[k]));
        csv("x,axi", "HEX,HEX", 0, &rows(&values.each_ref().map(String::as_str)))
    };
    write(folder, "a.csv", &table(["_", "Active"]));
    write(folder, "b.csv", &table(["_", "Inactive"]));
    same(folder, &["a.csv", "a.csv"]);
    let json = different(folder, &["a.csv", "b.csv"]);
    assert_eq!(
        (&json["first"]["name"], &json["first"]["first"]["got"]),
        (&"axi".into(), &"Inactive".into())
    );
    same(folder, &["a.csv", "b.csv", "--ignore", "axi"]);
    let bits = csv("x,axi", "HEX,HEX", 0, &rows(&["0,0", "1,1"]));
    write(folder, "bits.csv", &bits);
    let json = same(folder, &["a.csv", "bits.csv"]);
    assert!(
        json["notes"]
            .to_string()
            .contains("axi is not compared because its words are `_`, `Active`"),
        "{json:#}"
    );
    write(folder, "map.toml", "[[signal]]\na = [\"axi\"]\nstates = { _ = 0, Active = 1 }\n");
    let json = same(folder, &["a.csv", "bits.csv", "--map", "map.toml"]);
    assert_eq!(json["signals"].as_array().unwrap().len(), 2);
}
