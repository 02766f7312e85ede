//! The JSON Schemas that documents are checked against.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use schemars::JsonSchema;
use serde_json::Value as Json;

/// Returns the JSON Schema of `T`, which is built the first time only: a scenario's takes two million instructions.
pub fn schema_of<T: JsonSchema>() -> Arc<Json> {
    static BUILT: Mutex<BTreeMap<Cow<'static, str>, Arc<Json>>> = Mutex::new(BTreeMap::new());
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    let build = || Arc::new(schemars::schema_for!(T).to_value());
    built.entry(T::schema_id()).or_insert_with(build).clone()
}
