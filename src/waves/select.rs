//! Selection of the signals in a waveform.

use globset::{Glob, GlobMatcher};

use crate::error::{Input, Result};
use crate::hierarchy::Entry;

/// Name of the option for the globs.
const OPTION: &str = "--signals";
/// Number of names suggested for a glob without a match.
const OFFERED: usize = 3;
/// Part of a glob that is compared with names, all of which are shorter [characters].
const LONGEST: usize = 200;

/// Selects the entries that match any of `globs`; without globs, all entries but the RAM's words.
///
/// A glob is matched against the dotted path, the path below the top, and the bare name; `*` crosses dots. The RAM's
/// words match only globs whose last part begins with `ram`, so that `*` or `histogram_builder.*` does not select
/// them.
///
/// # Errors
/// If a glob is invalid or matches nothing.
pub fn select(entries: Vec<Entry>, ram: Vec<Entry>, globs: &[String]) -> Result<Vec<Entry>> {
    if globs.is_empty() {
        return Ok(entries);
    }
    let candidates = with_ram(entries, ram);
    let mut chosen = vec![false; candidates.len()];
    for glob in globs {
        let (matcher, last) = (compile(glob)?, glob.rsplit('.').next().unwrap_or_default());
        let asks_for_ram = last.starts_with("ram");
        let mut found = false;
        for (candidate, chosen) in candidates.iter().zip(&mut chosen) {
            let matches = (asks_for_ram || !candidate.in_ram())
                && names(candidate).iter().any(|name| matcher.is_match(name));
            found |= matches;
            *chosen |= matches;
        }
        if !found {
            let near = nearest(glob, &candidates);
            let fault = Input::new(OPTION, format!("matches no signal; near it: {near}"));
            return Err(fault.field(glob).into());
        }
    }
    let pairs = candidates.into_iter().zip(chosen);
    Ok(pairs.filter(|(_, chosen)| *chosen).map(|(candidate, _)| candidate).collect())
}

/// Inserts the RAM's words at the end of their scope, if that scope is present.
fn with_ram(mut entries: Vec<Entry>, ram: Vec<Entry>) -> Vec<Entry> {
    let home = ram.first().map(|word| &word.scope);
    if let Some(last) = entries.iter().rposition(|entry| Some(&entry.scope) == home) {
        entries.splice(last + 1..last + 1, ram);
    }
    entries
}

fn compile(glob: &str) -> Result<GlobMatcher> {
    let compiled = Glob::new(glob).map_err(|error| {
        Input::new(OPTION, format!("expected a pattern such as `tdc.*`: {}", error.kind()))
            .field(glob)
    })?;
    Ok(compiled.compile_matcher())
}

/// Returns the names by which a user can select an entry: its path, the path below the top, and the bare name.
fn names(entry: &Entry) -> [String; 3] {
    [entry.path(), entry.below_top(), entry.signal.name.clone()]
}

/// Returns the paths below the top that are most similar to `glob`.
fn nearest(glob: &str, candidates: &[Entry]) -> String {
    let plain = glob.chars().filter(|c| !"*?[]{}".contains(*c)).take(LONGEST);
    let plain = plain.collect::<String>().to_lowercase();
    let score = |candidate: &Entry| {
        let likeness =
            names(candidate).map(|name| strsim::normalized_damerau_levenshtein(&plain, &name));
        (likeness.into_iter().fold(0.0, f64::max), candidate.below_top())
    };
    let outside = candidates.iter().filter(|candidate| !candidate.in_ram());
    let mut scored: Vec<(f64, String)> = outside.map(score).collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    let bare = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let mut offered: Vec<String> = Vec::new();
    for (_, path) in scored {
        if offered.len() < OFFERED && offered.iter().all(|other| bare(other) != bare(&path)) {
            offered.push(path);
        }
    }
    offered.join(", ")
}

#[cfg(test)]
mod tests {
    use super::super::tests::bench::params;
    use super::*;
    use crate::hierarchy::{entries, ram_entries};
    use crate::kernel::U;

    fn chosen(globs: &[&str]) -> Result<Vec<String>> {
        let globs: Vec<_> = globs.iter().map(ToString::to_string).collect();
        let entries = select(entries(&params()), ram_entries(&Default::default()), &globs)?;
        Ok(entries.iter().map(Entry::path).collect())
    }

    #[test]
    fn without_globs_everything_but_the_ram_is_chosen() {
        assert_eq!(chosen(&[]).unwrap().len(), entries(&params()).len());
        assert_eq!(chosen(&["*"]).unwrap(), chosen(&[]).unwrap());
    }

    #[test]
    fn a_glob_may_name_path_tail_or_bare_name() {
        let one = ["tof_top.frame_ctrl.state"];
        assert_eq!(chosen(&["tof_top.frame_ctrl.state"]).unwrap(), one);
        assert_eq!(chosen(&["frame_ctrl.state"]).unwrap(), one);
        assert_eq!(chosen(&["state"]).unwrap(), one);
        let scopes = chosen(&["tdc_code"]).unwrap();
        assert!(scopes.contains(&"tof_top.tdc_code".into()));
        assert!(scopes.contains(&"tof_top.tdc.tdc_decoder.tdc_code".into()));
    }

    #[test]
    fn a_star_crosses_dots_and_case_counts() {
        assert!(chosen(&["tdc.*"]).unwrap().contains(&"tof_top.tdc.tdc_latch.hit".into()));
        assert!(chosen(&["TDC.*"]).is_err());
    }

    #[test]
    fn words_of_the_ram_come_when_named_and_stand_in_their_scope() {
        assert_eq!(chosen(&["ram_7"]).unwrap(), ["tof_top.histogram_builder.ram_7"]);
        assert_eq!(chosen(&["ram_*"]).unwrap().len(), 256);
        let all = chosen(&["*", "ram_*"]).unwrap();
        let scopes = all.iter().map(|path| path.rsplit_once('.').unwrap().0);
        let mut blocks: Vec<_> = scopes.collect();
        blocks.dedup();
        let count = blocks.len();
        blocks.sort();
        blocks.dedup();
        assert_eq!(blocks.len(), count, "no scope stands in two places");
    }

    #[test]
    fn the_ram_is_absent_with_its_module() {
        let mut params = params();
        params.histogram_source =
            crate::firmware::tof_top::HistogramSource::Preload(Box::new([U::new(0); 256]));
        let globs = ["ram_*".to_owned()];
        assert!(select(entries(&params), ram_entries(&Default::default()), &globs).is_err());
    }

    #[test]
    fn a_glob_that_matches_nothing_is_refused_with_the_nearest_names() {
        let text = chosen(&["tdc_cod"]).unwrap_err().to_string();
        assert!(text.starts_with("--signals: tdc_cod: matches no signal; near it: tdc_code"));
        let text = chosen(&["*", "frame_ctl.*tate"]).unwrap_err().to_string();
        assert!(text.contains("frame_ctrl.state"), "{text}");
    }

    #[test]
    fn a_malformed_glob_is_refused() {
        let text = chosen(&["tdc[", "*"]).unwrap_err().to_string();
        assert!(text.starts_with("--signals: tdc[: expected a pattern"), "{text}");
    }
}
