//! Places of a waveform's scopes in the Verilog, with numbers for the files' paths.

use crate::hierarchy::ModulePlaces;

/// A line of a file, by the number of its path.
pub(super) type Stem = (u64, u32);

/// What a scope stands for.
#[derive(Debug, Default, PartialEq)]
pub(super) struct ScopeSource {
    /// Name of the module; empty if it is none.
    pub(super) component: &'static str,
    /// Paths that have not been numbered before.
    pub(super) paths: Vec<(u64, String)>,
    /// Line of the module's declaration.
    pub(super) declared: Option<Stem>,
    /// Line of its instance.
    pub(super) instantiated: Option<Stem>,
}

/// Scopes that are open, and files so far.
#[derive(Default)]
pub(super) struct ScopeSources {
    places: ModulePlaces,
    open: Vec<String>,
    /// Modules whose files have a number.
    files: Vec<&'static str>,
}

impl ScopeSources {
    /// Enters a scope.
    pub(super) fn enter(&mut self, name: &str) -> ScopeSource {
        self.open.push(name.to_owned());
        let mut source = ScopeSource::default();
        let Some(place) = self.places.of(&self.open.join(".")) else { return source };
        source.component = place.component;
        let mut stem = |(module, line)| {
            let known = self.files.iter().position(|file| *file == module);
            let place = known.unwrap_or_else(|| {
                self.files.push(module);
                source.paths.push((self.files.len() as u64, format!("rtl_ref/{module}.v")));
                self.files.len() - 1
            });
            (place as u64 + 1, line)
        };
        source.instantiated = place.instantiated.map(&mut stem);
        source.declared = Some(stem(place.declared));
        source
    }

    /// Leaves the innermost scope.
    pub(super) fn leave(&mut self) {
        self.open.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_numbered_once() {
        let mut sources = ScopeSources::default();
        let top = sources.enter("tof_top");
        assert_eq!(
            (top.component, top.paths),
            ("tof_top", vec![(1, "rtl_ref/tof_top.v".to_owned())])
        );
        assert!(top.instantiated.is_none() && top.declared.is_some_and(|stem| stem.0 == 1));
        let first = sources.enter("reset_sync_sys");
        assert_eq!(first.paths, [(2, "rtl_ref/reset_sync.v".to_owned())]);
        sources.leave();
        let second = sources.enter("reset_sync_laser");
        assert_eq!((second.component, second.paths), ("reset_sync", Vec::new()));
        assert_eq!(second.declared, first.declared);
        assert_ne!(second.instantiated, first.instantiated);
        sources.leave();
        assert!(sources.enter("bench").declared.is_none());
        assert_eq!(sources.enter("tdc"), ScopeSource::default());
    }
}
