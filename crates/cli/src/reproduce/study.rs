//! State shared by all items: seed, size, the thesis's instrument, and common intermediate results.

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use tofsim::error::{Input, Result};
use tofsim::network::Histogram;
use tofsim::optics::BinProbabilities;
use tofsim::scenario;
use tofsim::sim::Run;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;
use tofsim_captures::ila::{AnalyserSetup, Capture};
use tofsim_learn::dataset::{HistogramSource, Scene};

use crate::page::trace::captured;

use super::networks::Networks;
use super::peaks::Peaks;

/// Row numbers of single histograms, which no grid has.
const OWN_ROWS: u64 = 8 << 40;

/// How items are made.
pub struct Study {
    pub seed: u64,
    /// Few histograms instead of as many as the thesis has.
    pub quick: bool,
    pub stop: Option<Arc<AtomicBool>>,
    /// Whether the present item has fewer histograms than in a full run.
    is_reduced: Cell<bool>,
    peaks: RefCell<Option<Rc<Peaks>>>,
    networks: RefCell<Option<Rc<Networks>>>,
}

impl Study {
    pub fn new(seed: u64, quick: bool, stop: Option<Arc<AtomicBool>>) -> Self {
        let (peaks, networks) = (RefCell::new(None), RefCell::new(None));
        Study { seed, quick, stop, is_reduced: Cell::new(false), peaks, networks }
    }

    /// Begins an item.
    pub fn begin_item(&self) {
        self.is_reduced.set(false);
    }

    /// Returns whether the present item has fewer histograms than in a full run.
    pub fn is_reduced(&self) -> bool {
        self.is_reduced.get()
    }

    /// Returns whether to take fewer histograms.
    pub fn reduces(&self) -> bool {
        self.is_reduced.set(self.is_reduced.get() || self.quick);
        self.quick
    }

    /// One of two sizes.
    pub fn size(&self, full: u64, quick: u64) -> u64 {
        if self.reduces() { quick } else { full }
    }

    /// Looked at between blocks of work.
    pub fn stop(&self) -> Option<&AtomicBool> {
        self.stop.as_deref()
    }

    /// A scenario with keys set, with the study's seed.
    ///
    /// # Errors
    /// When a key or value is wrong.
    pub fn setup(&self, name: &str, set: &[&str]) -> Result<Setup> {
        let set: Vec<_> = set.iter().map(|&text| text.to_owned()).collect();
        let mut loaded = scenario::load(name, &set)?;
        loaded.scenario.seed = self.seed;
        Setup::new(loaded)
    }

    /// The thesis's instrument of chapters 3 to 5: bins of exactly 25 ps, and a network for them.
    ///
    /// # Errors
    /// As [`Study::setup`].
    pub fn ideal(&self) -> Result<Setup> {
        self.setup(scenario::DEFAULT, &["tdc.profile=ideal", "estimator.network=ideal"])
    }

    /// Captures what a built-in probe configuration sees of its own scenario, with more keys set.
    ///
    /// # Errors
    /// When there is no such configuration, it never triggers, or the run is stopped.
    pub fn captured(&self, name: &str, set: &[&str]) -> Result<(Setup, Capture)> {
        self.capture(&AnalyserSetup::load(name)?, set)
    }

    /// Captures the same by the text of a probe configuration.
    ///
    /// # Errors
    /// As [`Study::captured`].
    pub fn captured_by(&self, text: &str, set: &[&str]) -> Result<(Setup, Capture)> {
        self.capture(&AnalyserSetup::parse("scope", "set-up", text)?, set)
    }

    fn capture(&self, set_up: &AnalyserSetup, set: &[&str]) -> Result<(Setup, Capture)> {
        let own = set_up.file.set.iter().map(String::as_str);
        let set: Vec<_> = own.chain(set.iter().copied()).collect();
        let setup = self.setup(&set_up.file.scenario, &set)?;
        let seen = captured(&setup, set_up, self.stop())?;
        let seen = seen.ok_or_else(|| Input::new(&set_up.name, "never triggered"))?;
        Ok((setup, seen))
    }

    /// Simulates a frame through every register, and returns its shots.
    ///
    /// # Errors
    /// When it is stopped.
    pub fn shots(&self, setup: &Setup) -> Result<Vec<Shot>> {
        let mut shots = Vec::new();
        let mut take = |shot: &Shot| {
            shots.push(*shot);
            Ok(())
        };
        let watch = Observers { shots: Some(&mut take), stop: self.stop(), ..Observers::default() };
        Run::new(setup).observe(1, watch)?;
        Ok(shots)
    }

    /// Returns the distribution of its histograms.
    ///
    /// # Errors
    /// As [`Study::setup`].
    pub fn source(&self) -> Result<HistogramSource> {
        HistogramSource::new(&self.ideal()?)
    }

    /// A histogram of a scene; each `number` is another.
    pub fn draw(
        &self,
        source: &HistogramSource,
        codes: &BinProbabilities,
        number: u64,
    ) -> Histogram {
        source.draw_from(codes, &Scene::default(), self.seed, OWN_ROWS + number)
    }

    /// Peak detection over the grid of Table 4.3; worked out once.
    ///
    /// # Errors
    /// When it is stopped.
    pub fn peaks(&self) -> Result<Rc<Peaks>> {
        let size = self.size(100, 10);
        once(&self.peaks, || Peaks::measure(&self.source()?, size, self.seed, self.stop()))
    }

    /// The networks over the thesis's test grid; worked out once.
    ///
    /// # Errors
    /// When it is stopped.
    pub fn networks(&self) -> Result<Rc<Networks>> {
        let quick = self.reduces();
        once(&self.networks, || Networks::measure(&self.ideal()?, quick, self.stop()))
    }
}

/// Returns the cached value, which is computed on first use.
fn once<T>(place: &RefCell<Option<Rc<T>>>, make: impl FnOnce() -> Result<T>) -> Result<Rc<T>> {
    if let Some(made) = &*place.borrow() {
        return Ok(Rc::clone(made));
    }
    let made = Rc::new(make()?);
    *place.borrow_mut() = Some(Rc::clone(&made));
    Ok(made)
}
