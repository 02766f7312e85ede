//! A TOML document as serde reads it.

use serde::de::value::{Error, MapAccessDeserializer, MapDeserializer, SeqDeserializer};
use serde::de::{Deserializer, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;
use toml_edit::{Item, TableLike, Value};

/// A part of a document. Unlike the deserializers of the `toml` crates, it gives a struct its fields in one way only, so
/// that the code of each struct is compiled once.
#[derive(Clone, Copy)]
pub(super) enum Node<'a> {
    Table(&'a dyn TableLike),
    Tables(&'a toml_edit::ArrayOfTables),
    Value(&'a Value),
}

impl<'a> Node<'a> {
    /// Returns the node of an item, if it holds anything.
    fn of(item: &'a Item) -> Option<Self> {
        match item {
            Item::None => None,
            Item::Value(value) => Some(Node::Value(value)),
            Item::Table(table) => Some(Node::Table(table)),
            Item::ArrayOfTables(tables) => Some(Node::Tables(tables)),
        }
    }

    /// Returns the table, if it is one.
    fn table(self) -> Option<&'a dyn TableLike> {
        match self {
            Node::Table(table) => Some(table),
            Node::Value(value) => value.as_inline_table().map(|table| table as &dyn TableLike),
            Node::Tables(_) => None,
        }
    }
}

/// Keys of a table with their nodes.
type Entries<'a> = Box<dyn Iterator<Item = (&'a str, Node<'a>)> + 'a>;

fn map<'a>(table: &'a dyn TableLike) -> MapDeserializer<'a, Entries<'a>, Error> {
    let entries = table.iter().filter_map(|(key, item)| Some((key, Node::of(item)?)));
    MapDeserializer::new(Box::new(entries))
}

/// Nodes of a list.
type Elements<'a> = Box<dyn Iterator<Item = Node<'a>> + 'a>;

impl<'a> IntoDeserializer<'a, Error> for Node<'a> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for Node<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let elements: Elements = match self {
            Node::Table(table) => return visitor.visit_map(map(table)),
            Node::Tables(tables) => Box::new(tables.iter().map(|table| Node::Table(table))),
            Node::Value(Value::String(text)) => return visitor.visit_borrowed_str(text.value()),
            Node::Value(Value::Integer(number)) => return visitor.visit_i64(*number.value()),
            Node::Value(Value::Float(number)) => return visitor.visit_f64(*number.value()),
            Node::Value(Value::Boolean(truth)) => return visitor.visit_bool(*truth.value()),
            Node::Value(Value::Datetime(moment)) => {
                return visitor.visit_string(moment.value().to_string());
            }
            Node::Value(Value::InlineTable(table)) => return visitor.visit_map(map(table)),
            Node::Value(Value::Array(list)) => Box::new(list.iter().map(Node::Value)),
        };
        visitor.visit_seq(SeqDeserializer::new(elements))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match (self, self.table()) {
            (Node::Value(Value::String(text)), _) => {
                visitor.visit_enum(text.value().as_str().into_deserializer())
            }
            (_, Some(table)) => visitor.visit_enum(MapAccessDeserializer::new(map(table))),
            _ => self.deserialize_any(visitor),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct
        seq tuple tuple_struct map struct identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;
    use toml_edit::Document;

    use super::*;

    #[derive(Debug, Deserialize, PartialEq)]
    struct Inner {
        list: Vec<f64>,
        pair: Option<(u32, String)>,
    }

    #[derive(Debug, Deserialize, PartialEq)]
    #[serde(rename_all = "snake_case")]
    enum Kind {
        Plain,
        Of(i64),
    }

    #[derive(Debug, Deserialize, PartialEq)]
    struct Outer {
        truth: bool,
        kinds: Vec<Kind>,
        inline: Inner,
        rows: Vec<Inner>,
        missing: Option<u8>,
    }

    fn read(text: &str) -> Result<Outer, String> {
        let document = Document::parse(text).unwrap();
        Outer::deserialize(Node::Table(document.as_table())).map_err(|error| error.to_string())
    }

    const TEXT: &str = "truth = true\nkinds = ['plain', { of = -3 }]\n\
        inline = { list = [1, 2.5], pair = [7, 'b'] }\n[[rows]]\nlist = [inf]\n[[rows]]\nlist = []\n";

    #[test]
    fn every_kind_of_value_is_what_the_toml_crate_makes_of_it() {
        let found = read(TEXT).unwrap();
        assert_eq!(found, toml::from_str(TEXT).unwrap());
        assert_eq!(found.kinds, [Kind::Plain, Kind::Of(-3)]);
        assert_eq!(found.inline.pair, Some((7, "b".to_owned())));
        assert_eq!(found.rows[0].list, [f64::INFINITY]);
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let error = |from, to| read(&TEXT.replace(from, to)).unwrap_err();
        assert_eq!(error("true", "1"), "invalid type: integer `1`, expected a boolean");
        assert_eq!(error("truth = true\n", ""), "missing field `truth`");
        assert!(error("'plain'", "'plane'").starts_with("unknown variant `plane`, expected"));
        assert_eq!(error("[7, 'b']", "[7]"), "invalid length 1, expected a tuple of size 2");
        assert!(error("'plain'", "2026-11-30").starts_with("invalid type: string \"2026-11-30\""));
    }
}
