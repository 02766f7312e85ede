//! The setups of an array's pixels: what they have in common is elaborated once.

use std::sync::{Arc, OnceLock};

use rand_chacha::rand_core::Rng;

use crate::error::Result;
use crate::firmware::tof_top::Params;
use crate::optics::budget::PixelPath;
use crate::optics::dark::DarkRates;
use crate::optics::{Budget, Camera, PixelBudgets, Pixels};
use crate::scenario::builtin::Source as FileSource;
use crate::scenario::effects::Effect;
use crate::scenario::wiring::Wiring;
use crate::scenario::{Loaded, MOST_SEED, Scenario, cover_fractions, dark, offsets};
use crate::sensor::light::Light;
use crate::sensor::streams::{Seeds, Source, stream};

use super::Setup;
use super::converter::Converter;
use super::detector::{SimulatedRow, by_budget, by_budgets};
use super::pixel_files::{Column, PixelFiles};

mod firmware;

/// Largest number of columns, by which pixels are numbered for random streams and dark rates: a pixel's number does not
/// depend on the size of its array.
const MOST_COLUMNS: usize = 64;

/// An array of pixels, ready to run. Each pixel is simulated as an instrument of one pixel.
#[derive(Clone, Debug)]
pub struct ArraySetup {
    common: Setup,
    /// The light on each pixel; `None` for a single one that sees a cone.
    budgets: Option<PixelBudgets>,
    /// The light on each row, where crosstalk joins its pixels; made when first needed.
    rows: Arc<[OnceLock<Arc<Light>>]>,
}

impl ArraySetup {
    /// Loads the files that the scenario names, and elaborates it.
    ///
    /// # Errors
    /// When one of the files cannot be read or used, or the estimator is a network for another histogram.
    pub fn new(loaded: Loaded) -> Result<Self> {
        let array = ArraySetup::of_counts(loaded)?;
        array.common.check_estimator()?;
        for own in &array.common.pixel_files.columns {
            array.common.clone().with_column(own).check_estimator()?;
        }
        Ok(array)
    }

    /// Elaborates the same for histograms without depths: unlike [`ArraySetup::new`], it accepts a network for another
    /// histogram.
    ///
    /// # Errors
    /// When one of the files cannot be read or used.
    pub fn of_counts(loaded: Loaded) -> Result<Self> {
        let files = loaded.files.clone();
        let Some(pixels) = Pixels::of(&loaded.scenario) else {
            let common = Setup::of_counts(loaded)?;
            return Ok(ArraySetup { common, budgets: None, rows: Arc::default() });
        };
        let without_light = |scenario: &Scenario, pulse, _: Option<&_>| {
            let pulse_energy_j = scenario.laser.pulse_energy_j();
            Budget { pulse, pulse_energy_j, ..Budget::default() }
        };
        let mut common = Setup::elaborated(loaded, without_light)?;
        let pixel_files = PixelFiles {
            offsets_ps: offsets::load(&common.scenario, &files)?,
            cover_fractions: cover_fractions::load(&common.scenario, &files)?,
            columns: common.columns(&files)?,
            measured: dark::load(&common.scenario, &files)?,
        };
        (common.no_depth, common.pixel_files) = (None, Arc::new(pixel_files));
        let budgets = PixelBudgets::new(&common.scenario, pixels, common.mesh.as_deref());
        let rows = (0..common.scenario.array.rows).map(|_| OnceLock::new()).collect();
        Ok(ArraySetup { common, budgets: Some(budgets), rows })
    }

    /// Returns the part that all pixels have in common: everything but light and random streams.
    pub fn common(&self) -> &Setup {
        &self.common
    }

    /// Returns the directions of the pixels; `None` for a single one that sees a cone.
    pub fn pixels(&self) -> Option<&Pixels> {
        self.budgets.as_ref().map(PixelBudgets::pixels)
    }

    /// Returns the pixels as a camera; `None` for a single one that sees a cone.
    pub fn camera(&self) -> Option<Camera> {
        let distortion = self.common.scenario.array.distortion;
        self.pixels().map(|pixels| Camera::of(pixels, distortion))
    }

    /// Returns the number of rows and of columns.
    pub fn size(&self) -> [usize; 2] {
        self.common.scenario.array.size()
    }

    /// Returns the direction of a pixel's middle as a unit vector: to the right, down and forward [1].
    pub fn sight(&self, row: usize, column: usize) -> [f64; 3] {
        self.pixels().map_or([0.0, 0.0, 1.0], |pixels| pixels.sight(row, column))
    }

    /// Returns the part that the pixels of a column have in common: with the chain of its TDC.
    pub fn column(&self, column: usize) -> Setup {
        let common = self.common.clone();
        match self.common.pixel_files.columns.get(column) {
            Some(own) => common.with_column(own),
            None => common,
        }
    }

    /// Returns the part that the pixels of each column have in common; that of all columns, if their TDCs have the same
    /// chain. Pixel `n` by row, then column, has the one with index `n` modulo their number.
    pub fn columns(&self) -> Vec<Setup> {
        let own = self.common.pixel_files.columns.len().max(1);
        (0..own).map(|column| self.column(column)).collect()
    }

    /// Returns the setup of a pixel. Its random streams have a seed of their own, by row and column, and those that it shares
    /// with its row a seed of the row: the first 64 bits of the streams [`Source::Pixel`] and [`Source::Row`], of which 63
    /// count.
    pub fn pixel(&self, row: usize, column: usize) -> Setup {
        let Some(budgets) = &self.budgets else { return self.common.clone() };
        let (budget, dark) = self.light(budgets, &self.common.scenario, [row, column]);
        let pixel = self.column(column).with_light(budget, dark, self.seeds(row, column));
        Setup { row: self.row(budgets, row, column), ..pixel }
    }

    fn seeds(&self, row: usize, column: usize) -> Seeds {
        let scenario = &self.common.scenario;
        if scenario.array.count() == 1 {
            return scenario.seed.into();
        }
        let seed = |source, number: usize| {
            stream(scenario.seed, source, number as u64).next_u64() & MOST_SEED
        };
        Seeds { pixel: seed(Source::Pixel, number(row, column)), row: seed(Source::Row, row) }
    }

    /// Returns the row of a pixel as its TDC sees it, if crosstalk joins the row's pixels. Each of them simulates all of
    /// the row, with the same random numbers, so that it sees the same avalanches alone as in an image.
    fn row(&self, budgets: &PixelBudgets, row: usize, column: usize) -> Option<SimulatedRow> {
        let scenario = &self.common.scenario;
        Effect::Crosstalk.occurrence(scenario)?;
        let columns = self.size()[1];
        let spad =
            |column| (self.light(budgets, scenario, [row, column]).0, self.seeds(row, column));
        let light = self.rows[row].get_or_init(|| Arc::new(by_budgets((0..columns).map(spad))));
        Some(SimulatedRow { light: Arc::clone(light), wiring: Wiring::of_column(column, columns) })
    }

    /// Returns the budget of a pixel that sees white surfaces in an irradiance of 1 W/m^2/nm, from which
    /// [`Budget::of_white`] makes others.
    pub fn white(&self, row: usize, column: usize) -> Budget {
        let mut scenario = self.common.scenario.clone();
        (scenario.target.reflectance, scenario.ambient.irradiance_w_m2_nm) = (1.0, 1.0);
        match &self.budgets {
            Some(budgets) => self.light(budgets, &scenario, [row, column]).0,
            None => {
                let (pulse, mesh) = (self.common.budget.pulse.clone(), self.common.mesh.as_deref());
                Budget::of_scene(&scenario, pulse, mesh).with_dark_rates(&self.common.dark)
            }
        }
    }

    /// Returns the budget and the dark count rates of a pixel, in the light of a scenario.
    fn light(
        &self,
        budgets: &PixelBudgets,
        scenario: &Scenario,
        [row, column]: [usize; 2],
    ) -> (Budget, DarkRates) {
        let (common, place) = (&self.common, row * self.size()[1] + column);
        let PixelFiles { offsets_ps, cover_fractions, measured, .. } = &*common.pixel_files;
        let path = PixelPath {
            offset_ps: offsets_ps.get(place).copied().unwrap_or_default(),
            cover_fraction: cover_fractions.get(place).copied(),
        };
        let budget = budgets.of(scenario, common.budget.pulse.clone(), place, &path);
        let dark = if scenario.array.count() == 1 {
            common.dark.clone()
        } else {
            let measured = measured.as_ref().and_then(|rates| rates.rate(row, column));
            DarkRates::of_pixel(&scenario.spad, measured, number(row, column))
        };
        (budget.with_dark_rates(&dark), dark)
    }
}

/// Returns the number of a pixel, which does not depend on the size of its array.
fn number(row: usize, column: usize) -> usize {
    row * MOST_COLUMNS + column
}

impl Setup {
    /// Returns the setup with other light, and with random streams of other seeds.
    fn with_light(self, budget: Budget, dark: DarkRates, seeds: Seeds) -> Self {
        let light = by_budget(&budget, seeds);
        let words = stream(seeds.pixel, Source::SetupWindow, 0);
        let disturbance = self.disturbance.map(|one| one.with_words(words));
        let setup = Setup { budget, dark, light, disturbance, seeds, ..self };
        Setup { no_depth: setup.why_no_depth(), ..setup }
    }

    /// Returns what the columns of the array have of their own, if it names a file of chains.
    fn columns(&self, files: &FileSource) -> Result<Vec<Column>> {
        let converters = Converter::of_columns(&self.scenario, files, self.cycle())?;
        let column = |converter| {
            let column = Column { converter, edges: None };
            let setup = self.clone().with_column(&column);
            setup.check_fits()?;
            let shots = setup.params.frame_ctrl.shots_per_frame.into();
            let edges = setup.likelihood(shots).ok().map(|own| own.edges);
            Ok(Column { edges, ..column })
        };
        converters.into_iter().map(column).collect()
    }

    /// Returns the setup with the converter of a column, and its bins in the estimator.
    fn with_column(mut self, own: &Column) -> Self {
        let Converter { tdc, tdc_calibration, calibrated, known, course, disturbance } =
            own.converter.clone();
        if let Some(edges) = &own.edges {
            let common = &mut self.params.estimators.likelihood_estimator;
            *common = Arc::new((**common).clone().with_edges(Arc::clone(edges)));
        }
        let params = Params { tdc, tdc_calibration, ..self.params };
        Setup { params, calibrated, known_tdc: known, course, disturbance, ..self }
    }
}

#[cfg(test)]
mod tests;
