//! Record of a setup's run, and provenance of files.

use std::path::Path;

use crate::error::{Input, Result};
use crate::files::digest::digest_of;
use crate::hierarchy;
use crate::kernel::Time;
use crate::scenario::bundle::names;
use crate::scenario::window::Window;
use crate::sensor::light::Light;
use crate::waves::{self, WaveFormat, Waves};

use super::Setup;

/// Shots of the waveform when nothing else is asked for.
const FIRST_SHOTS: u64 = 16;

impl Setup {
    /// The windows that go into the waveform: those given, or the scenario's, or a first look.
    ///
    /// # Errors
    /// When one lies past the end of the run, as far as that is known before.
    pub fn windows(&self, given: &[Window], frames: u64) -> Result<Vec<Window>> {
        let end = self.end(frames).unwrap_or(Time::NEVER);
        self.windows_within(given, self.shots(frames), end)
    }

    /// The windows of a run of so many shots that ends at `end`, as far as that is known before.
    pub(super) fn windows_within(
        &self,
        given: &[Window],
        shots: u64,
        end: Time,
    ) -> Result<Vec<Window>> {
        let own = &self.scenario.report.windows;
        let (source, windows) = match (given, own.as_slice()) {
            ([], []) => {
                let first = Window::Shots { from: 0, to: shots.min(FIRST_SHOTS) };
                return Ok((shots > 0)
                    .then_some(first)
                    .into_iter()
                    .chain([Window::Estimation])
                    .collect());
            }
            ([], own) => ("report.windows", own.to_vec()),
            (given, _) => ("--window", given.to_vec()),
        };
        for window in &windows {
            window
                .check(shots, end)
                .map_err(|expected| Input::new(source, expected).value(window))?;
        }
        Ok(windows)
    }

    /// Begins a waveform file of the signals that match one of `globs`, or without globs of all but the
    /// words of the RAM. It takes no part in the run before [`Run::observe`](crate::Run::observe) has it.
    ///
    /// # Errors
    /// When a glob matches no signal, or the file cannot be written.
    pub fn waves(&self, path: &Path, format: WaveFormat, globs: &[&str]) -> Result<Waves> {
        let globs: Vec<_> = globs.iter().map(|&glob| glob.to_owned()).collect();
        let entries = self.entries(&globs)?;
        let encoder = &self.params.tdc.decoder.encoder;
        Waves::create(path, format, &entries, encoder, &self.provenance())
    }

    /// The signals of a waveform that match one of `globs`, or without globs all but the words of the RAM.
    ///
    /// # Errors
    /// When a glob matches no signal.
    #[doc(hidden)]
    pub fn entries(&self, globs: &[String]) -> Result<Vec<hierarchy::Entry>> {
        let mut entries = hierarchy::entries(&self.params);
        entries.extend(hierarchy::column_entries(&self.params));
        let outputs = match &self.row {
            Some(row) => row.wiring.simulated.len(),
            None => self.scenario.spad.row_outputs as usize,
        };
        entries.extend(hierarchy::row_entries(outputs));
        waves::select(entries, hierarchy::ram_entries(&self.params.histogram), globs)
    }

    /// Returns the provenance to write to a file, in lines.
    pub fn provenance(&self) -> Vec<String> {
        let mut lines = vec![
            format!("tofsim {}", env!("CARGO_PKG_VERSION")),
            format!("scenario {}", self.name),
            format!("seed {}", self.scenario.seed),
        ];
        lines.extend(self.set.iter().map(|set| format!("set {set}")));
        lines.push(format!("hash {}", self.hash()));
        lines
    }

    /// A number, in hexadecimal, that changes with any key of the scenario and with what is in the files
    /// that it names. It does not depend on the folder of a file that is named by its whole path.
    pub fn hash(&self) -> String {
        let (scenario, params) = (&self.scenario, &self.params);
        let given = match &self.light {
            Light::List(list) => Some(list),
            Light::Optics(_) | Light::None | Light::Row(_) => None,
        };
        let pulse = &self.budget.pulse;
        // Each pixel has a dark rate of its own.
        let is_one = scenario.array.count() == 1;
        let dark = is_one.then_some(&self.dark);
        let (mesh, pixels) = (&self.mesh, (!is_one).then_some(&self.pixel_files));
        let mut keys = format!("{scenario:?}");
        for (_, name) in names(scenario).filter(|(_, name)| Path::new(name).is_absolute()) {
            let short = Path::new(name).file_name().unwrap_or_default().to_string_lossy();
            keys = keys.replace(&format!("{name:?}"), &format!("{short:?}"));
        }
        let all =
            format_args!("{keys} {params:?} {given:?} {pulse:?} {dark:?} {mesh:?} {pixels:?}");
        format!("{:016x}", digest_of(all))
    }
}
