//! Light from targets other than a plain rectangle, and from the air in front of them.
//!
//! Laser and sensor share one point. A surface element of solid angle `dw`, at the end of a line of sight `r` with
//! the cosine `c` to its normal, returns `c / r^2 dw` of the laser light, which is the summand `cos^2 / r^4 dA` of
//! eq. 3.13. A retroreflective patch, whose coefficient refers to its own area, returns `1 / (c r^2) dw`. Air returns
//! `beta / r^2 dr dw` of the lidar equation up to the first surface. All of it passes through the air twice, `exp(-2
//! alpha r)`.

mod array;
mod element;
pub(super) mod outline;
mod raster;
mod surface;
mod view;

use crate::scenario::Scenario;
use crate::scenario::effects::Effect;
use crate::scenario::mesh::Mesh;

use super::air::Air;
use super::returned::{Haze, Returned};
use element::{Element, elements};
use raster::Placed;
use surface::{Kind, Surface, surfaces};
use view::View;

/// A target and the air in front of it.
pub struct Scene<'a> {
    scenario: &'a Scenario,
    air: Air,
    surfaces: Vec<Surface>,
    mesh: Option<Placed>,
}

/// Received ambient light, as projected solid angles of a white target with equal effect [sr].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ambient {
    /// Part reflected by the target.
    pub target_sr: f64,
    /// Part scattered by the air.
    pub air_sr: f64,
}

impl<'a> Scene<'a> {
    /// Creates the scene of a scenario, with its mesh if it names one.
    pub fn new(scenario: &'a Scenario, mesh: Option<&Mesh>) -> Self {
        let target = &scenario.target;
        Scene {
            scenario,
            air: Air::of(scenario),
            surfaces: surfaces(target),
            mesh: mesh.map(|mesh| Placed::new(mesh, target)),
        }
    }

    /// Passes the elements inside a view to `take`.
    fn elements(&self, view: &View, mut take: impl FnMut(Element)) {
        let cells = self.scenario.target.cells;
        for surface in &self.surfaces {
            // A quadrant has that many.
            elements(surface, view, 2 * cells, &mut take);
        }
        if let Some(mesh) = &self.mesh {
            mesh.elements(view, cells, take);
        }
    }

    /// Whether all light of the target comes after the way along the axis.
    fn is_plain(&self) -> bool {
        Effect::Target.occurrence(self.scenario).is_none()
    }

    /// Whether there is nothing in the air.
    fn is_clear(&self) -> bool {
        Effect::Air.occurrence(self.scenario).is_none()
    }

    /// Computes the ambient light: that from the target, attenuated on its way to the sensor, and that scattered by
    /// the air (Koschmieder).
    pub fn ambient(&self) -> Ambient {
        let view = View::cone(self.scenario.spad.field_of_view_deg);
        let mut target_sr = 0.0;
        self.elements(&view, |element| target_sr += element.seen_sr(&self.air));
        self.with_airlight(target_sr, &view, self.scenario.target.cells)
    }

    /// Returns the ambient light of a view that sees a target of that projected solid angle through the air [sr].
    fn with_airlight(&self, target_sr: f64, view: &View, cells: u32) -> Ambient {
        if self.is_clear() {
            return Ambient { target_sr, air_sr: 0.0 };
        }
        let air_sr =
            self.air.airlight * (view.solid_angle(cells).projected_sr - target_sr).max(0.0);
        Ambient { target_sr, air_sr }
    }

    /// Computes the returned laser light.
    pub fn returned(&self) -> Returned {
        let (laser, spad) = (&self.scenario.laser, &self.scenario.spad);
        let view = View::cone(laser.field_of_illumination_deg.min(spad.field_of_view_deg));
        let together = self.is_plain().then_some(self.scenario.target.distance_m);
        let mut collected = Collected::default();
        self.elements(&view, |element| collected.add(&element, &self.air, together));
        self.with_air(collected, &view, self.scenario.target.cells)
    }

    /// Returns what was collected, and the light that the air in front of it returns.
    fn with_air(&self, collected: Collected, view: &View, cells: u32) -> Returned {
        let Collected { mut returned, hidden } = collected;
        if !self.is_clear() {
            returned.air = Some(Haze::new(self.air, view.solid_angle(cells).sr, hidden));
        }
        returned
    }
}

/// Light on a pixel.
#[derive(Clone, Debug)]
pub struct PixelLight {
    /// Ambient light.
    pub ambient: Ambient,
    /// Returned laser light.
    pub returned: Returned,
}

/// Light returned by surfaces within a view.
#[derive(Default)]
struct Collected {
    returned: Returned,
    /// Distances at which the surfaces end the beam, each with a solid angle [m, sr].
    hidden: Vec<[f64; 2]>,
}

impl Collected {
    /// Adds the light of an element, at its own distance or, for a plain target, at that along the axis [m].
    fn add(&mut self, element: &Element, air: &Air, together: Option<f64>) {
        let &Element { kind, sight_m, cos, sr, .. } = element;
        let passes = air.passes(2.0 * sight_m);
        let square = sight_m * sight_m;
        let (weight, of) = match kind {
            Kind::Diffuse => (cos / square * sr, &mut self.returned.diffuse),
            Kind::Retro => (sr / (square * cos), &mut self.returned.retro),
        };
        let (at_m, spread_m) = match together {
            Some(distance_m) => (distance_m, 0.0),
            None => (sight_m, element.spread_m),
        };
        of.add(at_m, spread_m, weight * passes, weight);
        self.hidden.push([sight_m, sr]);
    }
}

#[cfg(test)]
mod tests;
