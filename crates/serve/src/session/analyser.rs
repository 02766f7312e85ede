//! The page's logic analyser.

use std::fs;
use std::sync::Arc;

use serde::Serialize;

use tofsim::error::{Error, Input, Result};
use tofsim::kernel::Time;
use tofsim::sim::setup::Setup;
use tofsim::sim::{Live, Progress};
use tofsim::{Callback, Shot};
use tofsim_captures::ila::builtin::SET_UPS;
use tofsim_captures::ila::export::{CaptureFormat, export};
use tofsim_captures::ila::setup::AnalyserSetupFile;
use tofsim_captures::ila::{Analyser, AnalyserPlan, AnalyserSetup, Capture, capture_live};

use super::request::IlaRequest;
use super::shell::quoted;

/// Cycles from arming to the first sample, more than the largest number of input stages.
const AHEAD: u64 = 16;

/// The logic analyser.
#[derive(Default)]
pub struct Ila {
    armed: Option<Armed>,
    done: Option<Done>,
    /// Number of captures since the start of the program.
    captures: u64,
}

struct Armed {
    set_up: AnalyserSetup,
    plan: AnalyserPlan,
    analyser: Analyser,
}

/// A complete capture and its files.
struct Done {
    view: CaptureView,
    files: Vec<(CaptureFormat, Arc<[u8]>)>,
}

/// A built-in probe configuration, as the page shows it.
#[derive(Clone, Debug, Serialize)]
pub struct SetUpView {
    name: &'static str,
    description: String,
    clock: String,
    depth: u64,
    trigger: Option<String>,
}

/// Returns the built-in probe configurations whose signals all exist in the design.
pub fn set_ups(setup: &Setup) -> Vec<SetUpView> {
    let of_design = |name: &'static str| {
        let set_up = AnalyserSetup::load(name).ok()?;
        AnalyserPlan::new(&set_up, setup).ok()?;
        let AnalyserSetupFile { description, clock, depth, trigger, .. } = set_up.file;
        Some(SetUpView { name, description, clock, depth, trigger })
    };
    SET_UPS.iter().rev().filter_map(|(name, _)| of_design(name)).collect()
}

/// State of the logic analyser, as the page shows it.
#[derive(Clone, Debug, Serialize)]
pub struct IlaView {
    /// Status: `idle`, `armed` or `full`.
    status: &'static str,
    armed: Option<ArmedView>,
    capture: Option<CaptureView>,
}

/// An armed configuration, as the page shows it.
#[derive(Clone, Debug, Serialize)]
pub struct ArmedView {
    name: String,
    trigger: Option<String>,
    samples: u64,
    triggers: usize,
    windows: usize,
}

/// A capture, as the page shows it.
#[derive(Clone, Debug, Serialize)]
pub struct CaptureView {
    /// Number of the capture since the start of the program, from 1.
    number: u64,
    name: String,
    description: String,
    trigger: Option<String>,
    clock: String,
    arm_at_us: f64,
    depth: usize,
    position: usize,
    /// First sample of each window.
    windows: Vec<usize>,
    trigger_times_us: Vec<f64>,
    probes: Vec<ProbeView>,
    /// Command that makes the same files from the run's scenario.
    command: String,
    /// Whether the run's scenario contains everything that was done to the run.
    exact: bool,
}

#[derive(Clone, Debug, Serialize)]
struct ProbeView {
    name: String,
    width: u32,
}

impl Ila {
    /// Arms the analyser, starting with a later sample.
    ///
    /// # Errors
    /// If the configuration is invalid, or does not fit the design.
    pub fn arm(&mut self, request: &IlaRequest, live: &mut Live) -> Result<()> {
        let mut set_up = match (&request.set_up, &request.text) {
            (Some(name), None) if !name.contains(['/', '.']) => AnalyserSetup::load(name)?,
            (Some(name), None) => {
                let expected = "expected the name of a built-in probe configuration; your own goes into `text`";
                return Err(Input::new("ila", expected).field("set_up").value(name).into());
            }
            (None, Some(text)) => AnalyserSetup::parse("own", "set-up", text)?,
            _ => {
                let expected = "expected either set_up, a name, or text, a probe configuration";
                return Err(Input::new("ila", expected).into());
            }
        };
        let IlaRequest { clock, depth, windows, position, trigger, capture, .. } = request.clone();
        set_up.override_with("clock", "clock", clock, |file| &mut file.clock);
        set_up.override_with("depth", "depth", depth, |file| &mut file.depth);
        set_up.override_with("windows", "windows", windows, |file| &mut file.windows);
        set_up.override_with("position", "position", position, |file| &mut file.position);
        set_up.override_with("trigger", "trigger", trigger, |file| &mut file.trigger);
        set_up.override_with("capture", "capture", capture, |file| &mut file.capture);
        let setup = Arc::clone(live.setup());
        let ahead = Time::from_fs(AHEAD * setup.cycle().fs());
        let arm_at_us = ((live.now() + ahead).fs() / 1_000_000 + 1) as f64 / 1e3;
        set_up.override_with("arm_at_us", "arm_at_us", Some(arm_at_us), |file| &mut file.arm_at_us);
        let mut plan = AnalyserPlan::new(&set_up, &setup)?;
        plan.stop_when_full = true;
        let analyser = Analyser::new(&plan, &setup);
        self.armed = Some(Armed { set_up, plan, analyser });
        Ok(())
    }

    /// Disarms the analyser. An earlier capture is kept.
    pub fn disarm(&mut self) {
        self.armed = None;
    }

    /// Returns whether the analyser is armed.
    pub fn is_armed(&self) -> bool {
        self.armed.is_some()
    }

    /// Continues a run with the analyser, as [`Live::advance`] does.
    ///
    /// # Errors
    /// Any error of `shots`.
    pub fn advance(
        &mut self,
        live: &mut Live,
        cycles: u64,
        shots: Option<Callback<Shot>>,
    ) -> Result<Progress> {
        match &mut self.armed {
            Some(armed) => capture_live(live, cycles, &mut armed.analyser, shots),
            None => Ok(Progress::Going),
        }
    }

    /// Stores the capture if it is complete. `exact` states whether the run's scenario contains everything that was
    /// done to the run.
    ///
    /// # Errors
    /// If the files cannot be written.
    pub fn take(&mut self, live: &Live, setup: &Setup, exact: bool) -> Result<()> {
        if !self.armed.as_ref().is_some_and(|armed| armed.analyser.is_full()) {
            return Ok(());
        }
        let Some(armed) = self.armed.take() else { return Ok(()) };
        self.captures += 1;
        let triggers = armed.analyser.triggers();
        let capture = armed.analyser.finish();
        let files = files(&capture, &armed.set_up.name)?;
        let file = &armed.set_up.file;
        let view = CaptureView {
            number: self.captures,
            name: armed.set_up.name.clone(),
            description: file.description.clone(),
            trigger: file.trigger.clone(),
            clock: armed.plan.sampling.to_string(),
            arm_at_us: file.arm_at_us,
            depth: armed.plan.shape.depth,
            position: armed.plan.shape.position,
            windows: capture.windows.clone(),
            trigger_times_us: triggers.iter().map(|time| time.fs() as f64 / 1e9).collect(),
            probes: capture
                .probes
                .iter()
                .map(|probe| ProbeView { name: probe.head(), width: probe.width })
                .collect(),
            command: command(&armed.set_up, live.done() + 1, setup),
            exact,
        };
        self.done = Some(Done { view, files });
        Ok(())
    }

    /// Returns a file of the capture, with its name.
    ///
    /// # Errors
    /// If there is no capture.
    pub fn file(&self, format: CaptureFormat) -> Result<(String, Arc<[u8]>)> {
        let none = || Input::new("ila", "nothing has been captured yet: arm it first");
        let done = self.done.as_ref().ok_or_else(none)?;
        let file = done.files.iter().find(|(known, _)| *known == format);
        let (_, bytes) = file.ok_or_else(none)?;
        Ok((format!("{}.{format}", done.view.name), Arc::clone(bytes)))
    }

    /// Returns the state for the page.
    pub fn view(&self) -> IlaView {
        let armed = self.armed.as_ref().map(|armed| ArmedView {
            name: armed.set_up.name.clone(),
            trigger: armed.set_up.file.trigger.clone(),
            samples: armed.analyser.taken(),
            triggers: armed.analyser.triggers().len(),
            windows: armed.plan.shape.windows,
        });
        let capture = self.done.as_ref().map(|done| done.view.clone());
        let status = match (&armed, &capture) {
            (Some(_), _) => "armed",
            (None, Some(_)) => "full",
            (None, None) => "idle",
        };
        IlaView { status, armed, capture }
    }
}

fn files(capture: &Capture, name: &str) -> Result<Vec<(CaptureFormat, Arc<[u8]>)>> {
    let folder = tempfile::tempdir().map_err(Error::io(&std::env::temp_dir(), "create"))?;
    let paths = export(capture, folder.path(), name, CaptureFormat::ALL, true)?;
    let read = |(format, path): (CaptureFormat, &std::path::PathBuf)| {
        let bytes = fs::read(path).map_err(Error::io(path, "read"))?;
        Ok((format, Arc::from(bytes)))
    };
    CaptureFormat::ALL.iter().copied().zip(&paths).map(read).collect()
}

/// Formats the command that makes the same capture from the run's scenario.
fn command(set_up: &AnalyserSetup, frames: u64, setup: &Setup) -> String {
    let file = &set_up.file;
    let mut words = vec![
        format!("tofsim ila capture {}_run.toml --probes {}", setup.name, set_up.name),
        format!("--clock {}", quoted(&file.clock)),
        format!("--depth {} --windows {}", file.depth, file.windows),
    ];
    words.extend(file.position.map(|position| format!("--position {position}")));
    words.extend(file.trigger.as_ref().map(|text| format!("--trigger {}", quoted(text))));
    words.extend(file.capture.as_ref().map(|text| format!("--capture {}", quoted(text))));
    words.push(format!("--arm-at-us {} --frames {frames}", file.arm_at_us));
    words.push("--stop-when-full -o ila".to_owned());
    words.join(" ")
}
