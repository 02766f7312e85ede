//! Link budgets of an array's pixels.

use crate::kernel::pulse::Pulse;
use crate::scenario::Scenario;
use crate::scenario::mesh::Mesh;

use super::budget::{Budget, PixelPath};
use super::photometry::AmbientRates;
use super::pixels::Pixels;
use super::scene::{PixelLight, Scene};

/// The light on every pixel of an array, by row, then column. A pixel's budget, whose temporal distribution takes
/// memory, is computed when it is asked for.
#[derive(Clone, Debug)]
pub struct PixelBudgets {
    pixels: Pixels,
    light: Vec<PixelLight>,
    ambient: AmbientRates,
}

impl PixelBudgets {
    /// Computes the light on the pixels of a scenario.
    pub fn new(scenario: &Scenario, pixels: Pixels, mesh: Option<&Mesh>) -> Self {
        let light = Scene::new(scenario, mesh).of_pixels(&pixels);
        PixelBudgets { pixels, light, ambient: AmbientRates::of(scenario) }
    }

    /// Returns the directions of the pixels.
    pub fn pixels(&self) -> &Pixels {
        &self.pixels
    }

    /// Computes the budget of the pixel at a place, for the given laser pulse and without measured dark rates.
    pub fn of(&self, scenario: &Scenario, pulse: Pulse, place: usize, path: &PixelPath) -> Budget {
        Budget::of_light(scenario, pulse, &self.ambient, &self.light[place], path)
    }
}

#[cfg(test)]
mod tests;
