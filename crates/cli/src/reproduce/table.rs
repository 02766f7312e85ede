//! The item table: what the thesis prints in each table and figure, and how it is compared.
//!
//! `stimuli/thesis/` has a file for each chapter, with the items in the thesis's order.

use serde::Deserialize;

use tofsim::error::{Input, Result};

/// The files of the table, a name and a text for each.
const CHAPTERS: [(&str, &str); 5] = [
    ("chapter-2", include_str!("../../../../stimuli/thesis/chapter-2.toml")),
    ("chapter-3", include_str!("../../../../stimuli/thesis/chapter-3.toml")),
    ("chapter-4", include_str!("../../../../stimuli/thesis/chapter-4.toml")),
    ("chapter-5", include_str!("../../../../stimuli/thesis/chapter-5.toml")),
    ("chapter-6", include_str!("../../../../stimuli/thesis/chapter-6.toml")),
];

/// A table, a figure or another place of the thesis.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Item {
    /// Name on the command line: `table-4.3`, `fig-6.21`.
    pub id: String,
    /// What it shows.
    pub title: String,
    /// Built-in plans of `tofsim sweep` whose points the rows compare and whose plots are shown.
    #[serde(default)]
    pub plans: Vec<String>,
    /// Rows, in their order.
    #[serde(default, rename = "row")]
    pub rows: Vec<RowSpec>,
    /// Pictures, in their order.
    #[serde(default, rename = "picture")]
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

/// A row, or a group of rows for each of several labels.
///
/// A row compares `thesis` with `ours`, shows `ours` alone, or judges a claim: that all of `holds` hold, or that the
/// scenario has the key of `sets`. In a group, `{each}` stands for the label.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RowSpec {
    /// Labels of a group.
    pub each: Vec<String>,
    /// Rows of a group, all of them for the first label, then for the second, and so on.
    pub rows: Vec<RowSpec>,
    /// What is compared.
    pub what: String,
    /// Unit.
    pub unit: String,
    /// What the thesis prints: a number, words or a value's name; in a group, one for each label.
    pub thesis: Printed,
    /// What comes out: a formula, or words with `{values}`.
    pub ours: Option<String>,
    /// Digits after the point; without it, as many as the thesis prints.
    pub decimals: Option<usize>,
    /// Conditions of a claim.
    pub holds: Vec<String>,
    /// What one sees a claim by, with `{values}`.
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

/// What the thesis prints.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(untagged)]
pub enum Printed {
    /// Nothing.
    #[default]
    Nothing,
    /// The same for each label.
    One(String),
    /// Something for each label.
    Each(Vec<String>),
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
    /// What other columns have to be, as `key=value`.
    #[serde(default)]
    pub at: Vec<String>,
}

/// A picture: words below it, and title and axes of a plot; all may have `{values}`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Picture {
    /// Labels, if there is a picture for each.
    pub each: Vec<String>,
    /// Title of a plot.
    pub title: String,
    /// What is along its horizontal axis, with the unit.
    pub x: String,
    /// What is along its vertical axis, with the unit.
    pub y: String,
    /// What it shows.
    pub words: String,
}

impl Printed {
    /// Returns what is printed for a label, by its place.
    pub fn at(&self, place: usize) -> Option<&str> {
        match self {
            Printed::Nothing => None,
            Printed::One(printed) => Some(printed),
            Printed::Each(all) => all.get(place).map(String::as_str),
        }
    }
}

impl RowSpec {
    /// Returns the row for a label of its group.
    pub fn at(&self, place: usize, label: &str) -> RowSpec {
        let with = |text: &String| text.replace("{each}", label);
        let line =
            |line: &LineSpec| LineSpec { at: line.at.iter().map(with).collect(), ..line.clone() };
        RowSpec {
            what: with(&self.what),
            thesis: self
                .thesis
                .at(place)
                .map_or(Printed::Nothing, |printed| Printed::One(printed.replace("{each}", label))),
            ours: self.ours.as_ref().map(with),
            holds: self.holds.iter().map(with).collect(),
            seen: with(&self.seen),
            line: self.line.as_ref().map(line),
            other: self.other.as_ref().map(line),
            ..self.clone()
        }
    }
}

impl Picture {
    /// Returns the picture for each of its labels, or itself without any.
    pub fn all(&self) -> Vec<Picture> {
        let at = |label: &String| {
            let [title, words] =
                [&self.title, &self.words].map(|text| text.replace("{each}", label));
            Picture { title, words, ..self.clone() }
        };
        if self.each.is_empty() { vec![self.clone()] } else { self.each.iter().map(at).collect() }
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
pub fn items() -> Result<Vec<Item>> {
    let chapter = |(name, text): &(&str, &str)| {
        let chapter: Chapter = toml::from_str(text).map_err(|fault| Input::new(*name, fault))?;
        Ok(chapter.item)
    };
    Ok(CHAPTERS.iter().map(chapter).collect::<Result<Vec<_>>>()?.concat())
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
        let text = "each = ['a', 'b']\nrows = [{ what = 'w {each}', ours = 'v.{each}', thesis = ['1', '2'] }]";
        let group: RowSpec = toml::from_str(text).unwrap();
        let row = group.rows[0].at(1, "b");
        assert_eq!(
            (&*row.what, row.ours.as_deref(), row.thesis.at(0)),
            ("w b", Some("v.b"), Some("2"))
        );
    }
}
