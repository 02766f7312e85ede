//! Every key of a scenario, with its schema.

use std::borrow::Cow;

use serde_json::Value as Json;

use crate::files::toml::schema_of;

use super::model::Scenario;

/// Returns the JSON Schema of a scenario.
pub fn schema() -> Json {
    Json::clone(&schema_of::<Scenario>())
}

/// Returns the path of each key, such as `target.distance_m`, with its schema, in the order of the schema. A list is one
/// key.
pub fn keys() -> Vec<(String, Json)> {
    let (root, mut found) = (schema(), Vec::new());
    collect(&root, &root, "", &mut found);
    found
}

fn collect(root: &Json, table: &Json, path: &str, found: &mut Vec<(String, Json)>) {
    for (key, schema) in table["properties"].as_object().into_iter().flatten() {
        let (key, schema) = (format!("{path}{key}"), resolve(root, schema));
        if schema.get("properties").is_some() {
            collect(root, &schema, &format!("{key}."), found);
        } else {
            found.push((key, schema.into_owned()));
        }
    }
}

/// Follows a reference to another place of the schema.
pub(super) fn resolve<'a>(root: &'a Json, schema: &'a Json) -> Cow<'a, Json> {
    let Some(place) = schema["$ref"].as_str() else { return Cow::Borrowed(schema) };
    let mut found = root.pointer(place.trim_start_matches('#')).cloned().unwrap_or(Json::Null);
    if let (Some(description), Some(found)) = (schema.get("description"), found.as_object_mut()) {
        found.insert("description".into(), description.clone());
    }
    Cow::Owned(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_a_scenario_is_found() {
        let values = serde_json::to_value(Scenario::default()).unwrap();
        let all = keys();
        for (key, schema) in &all {
            let value = key.split('.').try_fold(&values, |table, part| table.get(part));
            // Of all tables this one alone may be left out.
            let is_found = value.is_some() || key.starts_with("training.");
            assert!(is_found && schema["description"].is_string(), "{key}: {schema}");
        }
        for key in ["seed", "target.distance_m", "pll.multiply", "laser.pulse_file", "control"] {
            assert!(all.iter().any(|(known, _)| known == key), "{key}");
        }
        assert!(all.len() > 120, "{}", all.len());
    }
}
