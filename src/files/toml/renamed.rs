//! Former names of keys, which remain valid in input.
//!
//! The present key's schema holds its former name in the attribute `formerly`.

use schemars::JsonSchema;
use serde_json::Value as Json;
use toml_edit::{Table, TableLike};

use crate::error::{Input, Result};

use super::schema::schema_of;
use super::walk::{resolve, shown};

/// A key that was given by its former name.
#[derive(Clone, Debug, PartialEq)]
pub struct RenamedKey {
    /// Former dotted key, as given.
    pub former: String,
    /// Present dotted key.
    pub present: String,
    /// Value of the key, as a message shows it.
    pub value: String,
}

/// Replaces former names of keys in a table of type `T` by the present ones, and returns those that it replaced.
///
/// # Errors
/// If a key is given by both of its names.
pub fn rename<T: JsonSchema>(source: &str, table: &mut Table) -> Result<Vec<RenamedKey>> {
    let (schema, mut renamed) = (schema_of::<T>(), Vec::new());
    below(source, table, &schema, &schema, "", &mut renamed)?;
    Ok(renamed)
}

fn below(
    source: &str,
    table: &mut dyn TableLike,
    root: &Json,
    schema: &Json,
    path: &str,
    renamed: &mut Vec<RenamedKey>,
) -> Result<()> {
    let Some(properties) = resolve(root, schema)["properties"].as_object() else {
        return Ok(());
    };
    let formerly = properties.iter().filter_map(|(key, of)| Some((key, of.get("formerly")?)));
    for (key, former) in formerly {
        let former = former.as_str().unwrap_or_default();
        let Some(item) = table.remove(former) else { continue };
        let (former, present) = (format!("{path}{former}"), format!("{path}{key}"));
        let value = shown(&item);
        if table.insert(key, item).is_some() {
            let expected = format!("expected one of {present} and its former name");
            return Err(Input::new(source, expected).field(former).value(value).into());
        }
        renamed.push(RenamedKey { former, present, value });
    }
    for (key, item) in table.iter_mut() {
        let key = key.get();
        if let Some((inner, schema)) = item.as_table_like_mut().zip(properties.get(key)) {
            below(source, inner, root, schema, &format!("{path}{key}."), renamed)?;
        }
    }
    Ok(())
}
