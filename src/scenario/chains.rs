//! Carry chains of an array's columns, from a CSV file with columns `column,profile` or `column,profile,seed`.

use crate::error::{Input, Result};
use crate::files::csv::{CsvInput, Header};
use crate::firmware::carry_chain::Delays;
use crate::kernel::Time;
use crate::kernel::scan::MOST_COLUMNS;

use super::builtin::Source;
use super::chain::Profile;
use super::model::Scenario;

/// Columns of the file.
const HEADERS: [Header; 2] = [&["column", "profile", "seed"], &["column", "profile"]];

/// Loads the chain of every column, if the array names a file; the paths of it and of its profiles are relative to
/// `base`. The chains are sampled with the clock period `cycle`. Columns beyond the array's are checked only.
///
/// # Errors
/// If a file cannot be read or lacks a column, or if the chains differ in their number of taps.
pub fn load(scenario: &Scenario, base: &Source, cycle: Time) -> Result<Vec<Delays>> {
    let Some(name) = &scenario.array.chains_file else { return Ok(Vec::new()) };
    let (source, text) = base.read(name)?;
    let columns = scenario.array.columns as usize;
    let mut input = CsvInput::with_any(&source, &text, &HEADERS)?;
    let mut chains = vec![None; MOST_COLUMNS as usize];
    let mut taps = None;
    while input.advance()? {
        let column = input.place(0, chains.len())?;
        let profile = input.field::<String>(1).unwrap_or_default();
        let profile = Profile::find(&profile, base, |expected| input.fault(1, expected))?;
        let seed = match input.field::<String>(2) {
            Some(text) if !text.is_empty() => {
                let expected = "expected a seed, a whole number from 0, or nothing";
                Some(input.whole(2).ok_or_else(|| input.fault(2, expected))?)
            }
            _ => None,
        };
        let chain = profile.delays(seed, cycle)?;
        let most = *taps.get_or_insert(chain.taps());
        if chain.taps() != most {
            let expected =
                format!("it has {} taps, expected {most} as those before it", chain.taps());
            return Err(input.fault(1, expected).into());
        }
        if chains[column].replace(chain).is_some() {
            return Err(input.fault(0, "expected each column once").into());
        }
    }
    let lacks = |column: usize| {
        let expected = format!("expected a line for each of {columns} columns (array.columns)");
        Input::new(&source, expected).field("missing").value(format!("column {column}"))
    };
    let whole = chains
        .into_iter()
        .take(columns)
        .enumerate()
        .map(|(at, chain)| chain.ok_or_else(|| lacks(at)));
    Ok(whole.collect::<std::result::Result<_, _>>()?)
}

/// Returns the profiles that a file of chains names, as far as it can be read.
pub fn profiles(source: &str, text: &str) -> Vec<String> {
    let mut names = Vec::new();
    if let Ok(mut input) = CsvInput::with_any(source, text, &HEADERS) {
        while input.advance().unwrap_or(false) {
            names.extend(input.field::<String>(1));
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario;

    const CYCLE: Time = Time::from_ns(8);

    fn loaded(lines: &str) -> Result<Vec<Delays>> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("c.csv"), lines).unwrap();
        std::fs::write(folder.path().join("own.toml"), "tap_ps = 12").unwrap();
        let keys = ["array.columns=3".to_owned(), "array.chains_file=c.csv".to_owned()];
        let scenario = scenario::load("kc705", &keys).unwrap().scenario;
        load(&scenario, &Source::Folder(folder.path().to_owned()), CYCLE)
    }

    #[test]
    fn every_column_has_its_chain_in_any_order() {
        let found = loaded("column,profile,seed\n2,kintex7,7\n0,own.toml,\n1,kintex7,\n").unwrap();
        let own = |name: &str| {
            let base = Source::BuiltIn;
            Profile::find(name, &base, |expected| Input::new(name, expected)).unwrap()
        };
        let kintex7 = own("kintex7");
        assert_eq!(found[1], kintex7.delays(None, CYCLE).unwrap());
        assert_eq!(found[2], kintex7.delays(Some(7), CYCLE).unwrap());
        assert_ne!(found[2], found[1]);
        assert_eq!(found[0].longest() - found[0].tap_0(), Time::from_fs(12_000 * 799));
        let without = loaded("column,profile\n1,ideal\n0,uniform\n2,ideal\n").unwrap();
        assert_eq!(without[1], own("ideal").delays(None, CYCLE).unwrap());
    }

    #[test]
    fn faults_name_line_column_and_field() {
        let error =
            |lines: &str| loaded(&format!("column,profile,seed\n{lines}")).unwrap_err().to_string();
        for (lines, said) in [
            ("0,ideal,\n1,ideal,\n", "missing = column 2: expected a line for each of 3 columns"),
            ("64,ideal,\n", "c.csv:2:1: column = 64: expected 0 to 63"),
            ("0,ideal,\n0,ideal,\n", "c.csv:3:1: column = 0: expected each column once"),
            ("0,idael,\n", "c.csv:2:3: profile = idael: expected"),
            ("0,kintex7,-1\n", "c.csv:2:11: seed = -1: expected a seed"),
            ("0,ideal,4\n", "tap_ps = 12.5: expected [silicon], a random model"),
            ("0,ideal,\n1,ecp5,\n", "c.csv:3:3: profile = ecp5: it has 256 taps, expected 800"),
            ("0,none.toml,\n", "none.toml"),
        ] {
            let found = error(lines);
            assert!(found.contains(said), "{lines}: {found}");
        }
    }
}
