//! A recipe from TOML and from the command line, and its settings by name.

use tofsim::error::{Input, Result};

use super::Recipe;

impl Recipe {
    /// The recipe in the text of a file; messages name `source`.
    ///
    /// # Errors
    /// When the text is no TOML, a key is unknown, or a value makes no sense.
    pub fn parse(text: &str, base: &Recipe, overrides: &[String], source: &str) -> Result<Self> {
        let fault = |error: toml::de::Error| Input::new(source, error.to_string().trim_end());
        let mut table =
            toml::Table::try_from(base).map_err(|error| Input::new("recipe", error.to_string()))?;
        merge(&mut table, text.parse::<toml::Table>().map_err(fault)?);
        for assignment in overrides {
            let option = format!("--with {assignment}");
            let fault = |error: toml::de::Error| Input::new(&option, error.message());
            if assignment.contains(char::is_control) || !assignment.contains('=') {
                return Err(Input::new(option, "expected key=value, on one line").into());
            }
            let set = assignment.parse::<toml::Table>().map_err(fault)?;
            merge(&mut table, set.clone());
            // A wrong key is the option's fault, not the file's.
            table.clone().try_into::<Recipe>().map_err(fault)?;
        }
        let recipe: Recipe = table.try_into().map_err(fault)?;
        recipe.check()?;
        Ok(recipe)
    }

    /// All settings by dotted key, in TOML.
    pub fn settings(&self) -> Result<Vec<(String, String)>> {
        let table =
            toml::Table::try_from(self).map_err(|error| Input::new("recipe", error.to_string()))?;
        let mut settings = Vec::new();
        flatten("", &toml::Value::Table(table), &mut settings);
        Ok(settings)
    }
}

/// Lays a table over another, key by key.
fn merge(under: &mut toml::Table, over: toml::Table) {
    for (key, value) in over {
        match (under.get_mut(&key), value) {
            (Some(toml::Value::Table(under)), toml::Value::Table(over)) => merge(under, over),
            (_, value) => {
                under.insert(key, value);
            }
        }
    }
}

fn flatten(path: &str, value: &toml::Value, into: &mut Vec<(String, String)>) {
    match value {
        toml::Value::Table(table) => {
            for (key, value) in table {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                flatten(&path, value, into);
            }
        }
        value => into.push((path.to_owned(), value.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str, overrides: &[&str]) -> Result<Recipe> {
        let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
        Recipe::parse(text, &Recipe::default(), &overrides, "a.toml")
    }

    #[test]
    fn what_is_not_said_stays_and_an_option_comes_last() {
        let recipe = parse("table_noise = 0.0\n[finish]\nblocks = 3\n", &["finish.blocks=4"]);
        let recipe = recipe.unwrap();
        assert_eq!((recipe.table_noise, recipe.finish.blocks), (0.0, 4));
        assert_eq!(recipe.finish.epochs, Recipe::default().finish.epochs);
        assert_eq!(parse("", &[]).unwrap(), Recipe::default());
        Recipe::quick().check().unwrap();
    }

    #[test]
    fn settings_have_dotted_keys() {
        let settings = Recipe::default().settings().unwrap();
        assert!(settings.contains(&("finish.blocks".to_owned(), "14".to_owned())));
        assert!(settings.contains(&("optimiser.mu".to_owned(), "0.001".to_owned())));
    }
}
