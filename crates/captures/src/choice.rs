//! Selection of signals by patterns.

use globset::{Glob, GlobSet, GlobSetBuilder};

use tofsim::error::{Input, Result};

/// Selection of signals by name.
#[derive(Clone, Debug, Default)]
pub struct SignalChoice {
    /// Signals to select, with wildcards * and ?; all if empty.
    pub only: Vec<String>,
    /// Signals to exclude, with wildcards * and ?.
    pub ignore: Vec<String>,
}

/// The patterns of a selection.
pub(crate) struct Patterns {
    /// None selects all.
    only: Option<GlobSet>,
    ignored: GlobSet,
}

impl SignalChoice {
    /// Compiles the patterns, and further ones to exclude.
    ///
    /// # Errors
    /// If a pattern is invalid.
    pub(crate) fn patterns(&self, ignore: &[String]) -> Result<Patterns> {
        let only = globs(self.only.iter(), "--signals")?;
        let ignored = globs(self.ignore.iter().chain(ignore), "--ignore")?;
        Ok(Patterns { only: (!self.only.is_empty()).then_some(only), ignored })
    }
}

impl Patterns {
    /// Returns whether a signal with these names is selected; a pattern may be of the whole name, of the name below
    /// the outermost scope, or of the last part. Of the name `renamed`, it is of the whole name.
    pub(crate) fn has(&self, names: &[&str], renamed: Option<&str>) -> bool {
        let is_in = |set: &GlobSet| {
            renamed.is_some_and(|name| set.is_match(name))
                || names.iter().any(|name| {
                    let below = name.split_once('.').map_or(*name, |(_, below)| below);
                    let last = name.rsplit(['.', '/']).next().unwrap_or(name);
                    [*name, below, last].iter().any(|name| set.is_match(name))
                })
        };
        !is_in(&self.ignored) && self.only.as_ref().is_none_or(is_in)
    }
}

fn globs<'a>(texts: impl Iterator<Item = &'a String>, option: &str) -> Result<GlobSet> {
    let mut set = GlobSetBuilder::new();
    for text in texts {
        let glob = Glob::new(text).map_err(|error| {
            Input::new(option, format!("expected a pattern: {}", error.kind())).value(text)
        })?;
        set.add(glob);
    }
    let fault = |error: globset::Error| Input::new(option, error.kind());
    Ok(set.build().map_err(fault)?)
}
