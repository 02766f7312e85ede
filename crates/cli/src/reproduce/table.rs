//! The item table: what the thesis prints in each table and figure, and how it is compared.
//!
//! `stimuli/thesis/` has a file for each chapter, with the items in the thesis's order.

use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer};
use toml::{Table, Value};

use tofsim::error::{self, Input};

/// The files of the table, a name and a text for each.
const CHAPTERS: [(&str, &str); 5] = [
    ("chapter-2", include_str!("../../../../stimuli/thesis/chapter-2.toml")),
    ("chapter-3", include_str!("../../../../stimuli/thesis/chapter-3.toml")),
    ("chapter-4", include_str!("../../../../stimuli/thesis/chapter-4.toml")),
    ("chapter-5", include_str!("../../../../stimuli/thesis/chapter-5.toml")),
    ("chapter-6", include_str!("../../../../stimuli/thesis/chapter-6.toml")),
];

/// A table, a figure or another place of the thesis.
///
/// An entry of `row` or `picture` with labels in `each` is there once for each label, or all of its `rows` are; `{each}` stands
/// for the label in every text, and a list in `thesis` has what is printed for each.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Item {
    /// Name on the command line: `table-4.3`, `fig-6.21`.
    pub id: String,
    /// Title of the item.
    pub title: String,
    /// Built-in plans of `tofsim sweep` whose points the rows compare and whose plots are shown.
    #[serde(default)]
    pub plans: Vec<String>,
    /// Rows, in their order.
    #[serde(default, rename = "row", deserialize_with = "expanded")]
    pub rows: Vec<RowSpec>,
    /// Pictures, in their order.
    #[serde(default, rename = "picture", deserialize_with = "expanded")]
    pub pictures: Vec<Picture>,
    /// Why something differs, and how to read the rest; may have `{values}`.
    #[serde(default)]
    pub reason: String,
    /// Commands of other verbs that show the same.
    #[serde(default)]
    pub commands: Vec<String>,
    /// Whether there is nothing that could be compared, whatever the rows.
    #[serde(default)]
    pub cannot_be_reproduced: bool,
}

/// A row: it compares `thesis` with `ours`, shows `ours` alone, or judges a claim, that all of `holds` hold or that the
/// scenario has the key of `sets`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RowSpec {
    /// Quantity that is compared.
    pub what: String,
    /// Unit.
    pub unit: String,
    /// Value printed in the thesis: a number, words or a value's name.
    pub thesis: Option<String>,
    /// Value obtained here: a formula, or words with `{values}`.
    pub ours: Option<String>,
    /// Digits after the point; without it, as many as the thesis prints.
    pub decimals: Option<usize>,
    /// Conditions of a claim.
    pub holds: Vec<String>,
    /// Evidence for a claim, with `{values}`.
    pub seen: String,
    /// An assignment that the scenario has to accept.
    pub sets: Option<String>,
    /// A line of a sweep, whose values the formulas can use.
    pub line: Option<LineSpec>,
    /// Another line of the same sweep, whose values have `other.` before their names.
    pub other: Option<LineSpec>,
    /// Whether there is a row for each point of the line, with its `x` and `y`.
    pub points: bool,
}

/// A column of a sweep over another.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineSpec {
    /// The plan; without it, the item's only one.
    #[serde(default)]
    pub plan: String,
    /// The column along the axis.
    pub x: String,
    /// The column of the values.
    pub y: String,
    /// Required values of other columns, as `key=value`.
    #[serde(default)]
    pub at: Vec<String>,
}

/// A picture: words below it, and title and axes of a plot. Title and words may have `{values}`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Picture {
    /// Title of a plot.
    pub title: String,
    /// Quantity along the horizontal axis, with the unit.
    pub x: String,
    /// Quantity along the vertical axis, with the unit.
    pub y: String,
    /// Text below the picture.
    pub words: String,
}

/// Reads a list whose entries may be groups, each there once for each of its labels.
fn expanded<'de, D: Deserializer<'de>, T: DeserializeOwned>(file: D) -> Result<Vec<T>, D::Error> {
    let mut entries = Vec::new();
    for mut entry in Vec::<Table>::deserialize(file)? {
        let Some(labels) = entry.remove("each") else {
            entries.push(Value::Table(entry));
            continue;
        };
        let rows = match entry.remove("rows") {
            Some(Value::Array(rows)) => rows,
            _ => vec![Value::Table(entry)],
        };
        let labels: Vec<String> = labels.try_into().map_err(D::Error::custom)?;
        for (place, label) in labels.iter().enumerate() {
            entries.extend(rows.iter().map(|row| labelled(row, place, label)));
        }
    }
    entries.into_iter().map(|entry| entry.try_into().map_err(D::Error::custom)).collect()
}

/// An entry of a group for one of its labels.
fn labelled(entry: &Value, place: usize, label: &str) -> Value {
    match entry {
        Value::String(text) => text.replace("{each}", label).into(),
        Value::Array(all) => {
            Value::Array(all.iter().map(|one| labelled(one, place, label)).collect())
        }
        Value::Table(table) => {
            let with = |(key, value): (&String, &Value)| {
                let value = value.get(place).filter(|_| key == "thesis").unwrap_or(value);
                (key.clone(), labelled(value, place, label))
            };
            Value::Table(table.iter().map(with).collect())
        }
        other => other.clone(),
    }
}

/// A file of the table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Chapter {
    item: Vec<Item>,
}

/// Reads all items, in the order of the thesis.
///
/// # Errors
/// When a file of the table is not one.
pub fn items() -> error::Result<Vec<Item>> {
    let chapter = |(name, text): &(&str, &str)| {
        let chapter: Chapter = toml::from_str(text).map_err(|fault| Input::new(*name, fault))?;
        Ok(chapter.item)
    };
    Ok(CHAPTERS.iter().map(chapter).collect::<error::Result<Vec<_>>>()?.concat())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Chapter, kind, number and letter of an item.
    fn order(id: &str) -> (u32, usize, u32, String) {
        let (kind, place) = id.split_once('-').unwrap_or((id, "6."));
        let (chapter, rest) = place.split_once('.').unwrap();
        let number = rest.trim_end_matches(char::is_alphabetic);
        let kinds = ["eq", "listing", "clocks", "table", "fig"];
        let kind = kinds.iter().position(|known| *known == kind).unwrap();
        let letter = rest[number.len()..].to_owned();
        (chapter.parse().unwrap(), kind, number.parse().unwrap_or(0), letter)
    }

    #[test]
    fn every_item_has_a_name_of_its_own_and_they_are_in_the_order_of_the_thesis() {
        let items = items().unwrap();
        let places: Vec<_> = items.iter().map(|item| order(&item.id)).collect();
        assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{places:?}");
    }

    #[test]
    fn every_numbered_table_and_figure_is_there() {
        let numbers = |kind: &str, chapter: u32| -> BTreeSet<u32> {
            let items = items().unwrap();
            let ids = items.iter().filter(|item| item.id.starts_with(kind));
            let places = ids.map(|item| order(&item.id));
            places.filter(|place| place.0 == chapter).map(|place| place.2).collect()
        };
        for (kind, counts) in [("table", [0, 2, 3, 5, 5]), ("fig", [4, 3, 9, 7, 21])] {
            for (chapter, count) in (2..).zip(counts) {
                assert_eq!(numbers(kind, chapter), (1..=count).collect(), "{kind}-{chapter}");
            }
        }
    }

    #[test]
    fn a_group_has_its_label_wherever_it_is_asked_for() {
        let text = "id = ''\ntitle = ''\nrow = [{ what = 'first' }, { each = ['a', 'b'], rows = [\
            { what = 'w {each}', thesis = ['1', '2'], holds = ['v.{each}'] }, { what = 'x' }] }]\n\
            picture = [{ each = ['c', 'd'], words = '{each}' }]";
        let item: Item = toml::from_str(text).unwrap();
        let rows =
            item.rows.iter().map(|row| (&*row.what, row.thesis.as_deref(), row.holds.concat()));
        let row = |what, thesis, holds: &str| (what, thesis, holds.to_owned());
        assert!(rows.eq([
            row("first", None, ""),
            row("w a", Some("1"), "v.a"),
            row("x", None, ""),
            row("w b", Some("2"), "v.b"),
            row("x", None, ""),
        ]));
        assert!(item.pictures.iter().map(|picture| &*picture.words).eq(["c", "d"]));
        assert!(toml::from_str::<Item>("id = ''\ntitle = ''\nrow = [{ wat = '' }]").is_err());
    }
}
