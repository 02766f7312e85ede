//! The contents of the files that a scenario names, to be sent to another machine with it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use tempfile::TempDir;
use toml_edit::DocumentMut;

use crate::error::{Error, Result, read_bytes};
use crate::files::toml::read;

use super::builtin::Source;
use super::chain::Chain;
use super::chains;
use super::model::{Scenario, Stimulus, TdcCalibration};

/// Greatest number of `..` with which a file name in a bundle may begin [1].
const ABOVE: usize = 8;

/// Folder of a bundle for files that the scenario names by absolute paths.
const ABSOLUTE: &str = "absolute";

/// File contents, keyed by their path relative to the scenario's folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bundle {
    /// Contents of each file, by its relative path.
    pub files: BTreeMap<String, Vec<u8>>,
    /// Override for each key with an absolute path, which gives it the relative path.
    pub set: Vec<String>,
}

impl Bundle {
    /// Collects the files that a scenario names, including those that its chain file names. Built-in and missing
    /// files are left out, except that the stimuli of a built-in scenario are included when it also names a file of
    /// the user's.
    ///
    /// # Errors
    /// If a file cannot be read.
    pub fn of(files: &Source, scenario: &Scenario) -> Result<Bundle> {
        let mut bundle = Bundle::default();
        let folder = match files {
            Source::BuiltIn => Path::new(""),
            Source::Folder(folder) => folder,
        };
        for (key, name) in names(scenario) {
            let path = Path::new(name);
            if path.is_absolute() && path.is_file() {
                let name = relative(name);
                bundle.add_as(path, &name)?;
                bundle.set.push(format!("{key}={}", toml::Value::from(name)));
            }
            bundle.add(folder, name)?;
        }
        if let Some(name) = &scenario.array.chains_file {
            bundle.add_chains(files, folder, name)?;
        }
        if *files == Source::BuiltIn && !bundle.files.is_empty() {
            let Stimulus { photons, codes, histogram } = &scenario.stimulus;
            for name in [photons, codes, histogram].into_iter().flatten() {
                if !bundle.files.contains_key(name) {
                    bundle.files.insert(name.clone(), files.read(name)?.1.into_bytes());
                }
            }
        }
        Ok(bundle)
    }

    /// Adds the file `name` of `folder`, if there is one. A file with an absolute path has no name in a folder, and is
    /// not added.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn add(&mut self, folder: &Path, name: &str) -> Result<()> {
        let path = folder.join(name);
        if Path::new(name).is_absolute() || !path.is_file() {
            return Ok(());
        }
        self.add_as(&path, name)
    }

    /// Adds the file at `path` under another name, and the files that it names if it is a chain, which may be absolute
    /// there too.
    fn add_as(&mut self, path: &Path, name: &str) -> Result<()> {
        let mut bytes = read_bytes(path)?;
        let text = String::from_utf8_lossy(&bytes);
        let chain = |document: DocumentMut| Some((read("", &document).ok()?, document));
        if let Some((chain, mut document)) = text.parse().ok().and_then(chain) {
            let Chain { delays_file, counts_file, .. } = chain;
            let folder = path.parent().unwrap_or(Path::new(""));
            let beside = Path::new(name).parent().unwrap_or(Path::new(""));
            for (key, own) in [("delays_file", delays_file), ("counts_file", counts_file)] {
                let Some(own) = own.filter(|own| folder.join(own).is_file()) else { continue };
                let there = relative(&own);
                self.add_as(&folder.join(&own), &beside.join(&there).display().to_string())?;
                if there != own {
                    document[key] = there.into();
                    bytes = document.to_string().into_bytes();
                }
            }
        }
        self.files.insert(name.to_owned(), bytes);
        Ok(())
    }

    /// Adds the chains that the file of an array's chains names, as the scenario would find them.
    fn add_chains(&mut self, base: &Source, folder: &Path, name: &str) -> Result<()> {
        let Ok((source, text)) = base.read(name) else { return Ok(()) };
        for profile in chains::profiles(&source, &text) {
            self.add(folder, &profile)?;
        }
        Ok(())
    }

    /// Writes the files to a temporary folder, and returns that folder and the subfolder to which the file names are
    /// relative.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn unpack(&self) -> Result<(TempDir, PathBuf)> {
        let temporary = Path::new("temporary folder");
        let home = TempDir::with_prefix("tofsim-").map_err(Error::io(temporary, "create"))?;
        // Names may begin with `..`.
        let folder = (0..ABOVE).fold(home.path().to_owned(), |folder, _| folder.join("files"));
        std::fs::create_dir_all(&folder).map_err(Error::io(&folder, "create"))?;
        for (name, bytes) in &self.files {
            let path = folder.join(name);
            let parent = path.parent().unwrap_or(&folder);
            std::fs::create_dir_all(parent).map_err(Error::io(parent, "create"))?;
            std::fs::write(&path, bytes).map_err(Error::io(&path, "write"))?;
        }
        Ok((home, folder))
    }
}

/// Returns the name that a file has in a bundle: that below [`ABSOLUTE`] if its path is absolute.
fn relative(name: &str) -> String {
    let path = Path::new(name);
    if path.is_relative() {
        return name.to_owned();
    }
    let below: PathBuf = path.components().skip(1).collect();
    Path::new(ABSOLUTE).join(below).display().to_string()
}

/// Returns all keys that may name a file, with their values.
pub fn names(scenario: &Scenario) -> impl Iterator<Item = (&'static str, &str)> {
    let Scenario { target, cover, laser, spad, array, tdc, stimulus, training, estimator, .. } =
        scenario;
    let calibration = match &tdc.calibration {
        TdcCalibration::File(name) => Some(name.as_str()),
        TdcCalibration::True | TdcCalibration::Uniform => None,
    };
    let given = [
        ("target.mesh_file", target.mesh_file.as_deref()),
        ("cover.fraction_file", cover.fraction_file.as_deref()),
        ("laser.pulse_file", laser.pulse_file.as_deref()),
        ("spad.dark_file", spad.dark_file.as_deref()),
        ("array.offset_file", array.offset_file.as_deref()),
        ("array.chains_file", array.chains_file.as_deref()),
        ("tdc.conditions", tdc.conditions.as_deref()),
        ("stimulus.photons", stimulus.photons.as_deref()),
        ("stimulus.codes", stimulus.codes.as_deref()),
        ("stimulus.histogram", stimulus.histogram.as_deref()),
        ("training.recipe", training.recipe.as_deref()),
        ("estimator.network", Some(&*estimator.network)),
        ("estimator.glass_file", estimator.glass_file.as_deref()),
        ("tdc.profile", Some(&*tdc.profile)),
        ("tdc.calibration", calibration),
    ];
    given.into_iter().filter_map(|(key, name)| Some((key, name?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Time;
    use crate::scenario::load;

    const CYCLE: Time = Time::from_ns(8);

    #[test]
    fn the_chains_of_an_array_s_columns_go_with_it() {
        let here = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(here.path().join("chains")).unwrap();
        let write = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
        write("chains/own.toml", "delays_file = \"taps.csv\"\n");
        write("chains/taps.csv", "tap,delay_ps\n0,1\n");
        write("c.csv", "column,profile\n0,ideal\n1,chains/own.toml\n");
        write("s.toml", "[array]\ncolumns = 2\nchains_file = \"c.csv\"\n");
        let loaded = load(&here.path().join("s.toml").display().to_string(), &[]).unwrap();
        let bundle = Bundle::of(&loaded.files, &loaded.scenario).unwrap();
        let names: Vec<_> = bundle.files.keys().collect();
        assert_eq!(names, ["c.csv", "chains/own.toml", "chains/taps.csv"]);
    }

    #[test]
    fn a_scenario_reads_its_files_where_they_were_unpacked() {
        let here = tempfile::tempdir().unwrap();
        let folder = here.path().join("scenarios");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::create_dir_all(here.path().join("chains")).unwrap();
        let chain = "description = \"own\"\noffset_ps = 2230\ndelays_file = \"taps.csv\"\n";
        std::fs::write(here.path().join("chains/own.toml"), chain).unwrap();
        std::fs::write(here.path().join("chains/taps.csv"), "tap,ps\n0,1\n").unwrap();
        let text = "[tdc]\nprofile = \"../chains/own.toml\"\n";
        std::fs::write(folder.join("s.toml"), text).unwrap();
        let loaded = load(&folder.join("s.toml").display().to_string(), &[]).unwrap();
        let bundle = Bundle::of(&loaded.files, &loaded.scenario).unwrap();
        let names: Vec<_> = bundle.files.keys().collect();
        assert_eq!(names, ["../chains/own.toml", "../chains/taps.csv"]);
        let (_home, unpacked) = bundle.unpack().unwrap();
        let read = |name| std::fs::read_to_string(unpacked.join(name)).unwrap();
        assert_eq!(read("../chains/own.toml"), chain);
        assert_eq!(read("../chains/taps.csv"), "tap,ps\n0,1\n");
    }

    #[test]
    fn a_file_with_an_absolute_path_gets_a_relative_one() {
        let here = tempfile::tempdir().unwrap();
        let path = here.path().join("own");
        let chain = "description = \"own\"\noffset_ps = 2230\ndelays_file = \"taps.csv\"\n";
        std::fs::write(&path, chain).unwrap();
        std::fs::write(here.path().join("taps.csv"), "tap,ps\n0,1\n").unwrap();
        let mut loaded = load("kc705", &[]).unwrap();
        loaded.scenario.tdc.profile = path.display().to_string();
        let bundle = Bundle::of(&loaded.files, &loaded.scenario).unwrap();
        let name = format!("{ABSOLUTE}{}", path.display());
        assert_eq!(bundle.set, [format!("tdc.profile=\"{name}\"")]);
        let taps = Path::new(&name).with_file_name("taps.csv").display().to_string();
        assert_eq!(bundle.files.keys().collect::<Vec<_>>(), [&name, &taps]);
    }

    #[test]
    fn a_file_that_a_chain_names_by_an_absolute_path_comes_with_it() {
        let here = tempfile::tempdir().unwrap();
        let taps = here.path().join("taps.csv");
        let rows: String = (0..800).map(|tap| format!("{tap},11.5\n")).collect();
        std::fs::write(&taps, format!("tap,delay_ps\n{rows}")).unwrap();
        let chain = format!("# own\ndelays_file = {:?}\n", taps.display().to_string());
        std::fs::write(here.path().join("own.toml"), chain).unwrap();
        std::fs::write(here.path().join("s.toml"), "tdc.profile = \"own.toml\"\n").unwrap();
        let scenario = here.path().join("s.toml").display().to_string();
        let loaded = load(&scenario, &[]).unwrap();
        let (_home, unpacked) =
            Bundle::of(&loaded.files, &loaded.scenario).unwrap().unpack().unwrap();
        let own = super::super::chain::load("own.toml", &loaded.files, CYCLE).unwrap();
        drop(here);
        let there = super::super::chain::load("own.toml", &Source::Folder(unpacked), CYCLE);
        assert_eq!(there.unwrap(), own);
    }
}
