//! A recipe from TOML and from the command line, and its settings by name.

use toml_edit::{DocumentMut, Item};

use tofsim::error::{Input, Result};
use tofsim::files::toml::{Checked, assign, merge, read};

use super::Recipe;

/// Name and text of each recipe that comes with the program.
const BUILTIN: &[(&str, &str)] = &[
    ("short", include_str!("../../../../../stimuli/recipes/short.toml")),
    ("brief", include_str!("../../../../../stimuli/recipes/brief.toml")),
    ("long", include_str!("../../../../../stimuli/recipes/long.toml")),
    ("trainlm", include_str!("../../../../../stimuli/recipes/trainlm.toml")),
    ("uniform-16", include_str!("../../../../../stimuli/recipes/uniform-16.toml")),
];

impl Recipe {
    /// Names of the recipes that come with the program.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        BUILTIN.iter().map(|(name, _)| *name)
    }

    /// The text of a recipe that comes with the program, with what it has over the default one.
    pub fn builtin_text(name: &str) -> Option<&'static str> {
        BUILTIN.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
    }

    /// The recipe in the text of a file; messages name `source`.
    ///
    /// # Errors
    /// When the text is no TOML, a key is unknown, or a value makes no sense.
    pub fn parse(text: &str, base: &Recipe, overrides: &[String], source: &str) -> Result<Self> {
        let mut table = base.table()?;
        merge(table.as_table_mut(), Checked::part::<Recipe>(source, text)?.table());
        for assignment in overrides {
            assign::<Recipe>(table.as_table_mut(), "--with", assignment)?;
        }
        let recipe: Recipe = read(source, table.as_table())?;
        recipe.check()?;
        Ok(recipe)
    }

    fn table(&self) -> Result<DocumentMut> {
        let table = toml_edit::ser::to_document(self);
        table.map_err(|error| Input::new("recipe", error).into())
    }

    /// All settings by dotted key, in TOML.
    pub fn settings(&self) -> Result<Vec<(String, String)>> {
        let mut settings = Vec::new();
        flatten("", self.table()?.as_item(), &mut settings);
        Ok(settings)
    }
}

fn flatten(path: &str, item: &Item, into: &mut Vec<(String, String)>) {
    match item.as_table_like() {
        Some(table) => table.iter().for_each(|(key, item)| {
            let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            flatten(&path, item, into);
        }),
        None => into.push((path.to_owned(), item.to_string().trim().to_owned())),
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
    fn the_built_in_recipes_are_ones() {
        for (name, text) in BUILTIN {
            assert_ne!(
                Recipe::parse(text, &Recipe::default(), &[], name).unwrap(),
                Recipe::default()
            );
        }
    }

    #[test]
    fn settings_have_dotted_keys() {
        let settings = Recipe::default().settings().unwrap();
        assert!(settings.contains(&("finish.blocks".to_owned(), "14".to_owned())));
        assert!(settings.contains(&("optimiser.mu".to_owned(), "0.001".to_owned())));
    }
}
