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
    let properties = resolve(root, schema)["properties"].as_object();
    for (key, schema) in properties.into_iter().flatten() {
        let present = format!("{path}{key}");
        let former = schema["formerly"].as_str().unwrap_or_default();
        if let Some(item) = table.remove(former) {
            let (former, value) = (format!("{path}{former}"), shown(&item));
            if table.insert(key, item).is_some() {
                let expected = format!("expected one of {present} and its former name");
                return Err(Input::new(source, expected).field(former).value(value).into());
            }
            renamed.push(RenamedKey { former, present, value });
        } else if let Some(inner) = table.get_mut(key).and_then(|item| item.as_table_like_mut()) {
            below(source, inner, root, schema, &format!("{present}."), renamed)?;
        }
    }
    Ok(())
}
