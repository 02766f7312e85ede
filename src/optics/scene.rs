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
    second: Option<Surface>,
}

/// Received ambient light, as projected solid angles of a white target with equal effect [sr].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ambient {
    /// Part reflected by the target.
    pub target_sr: f64,
    /// Part reflected by a second surface.
    pub second_sr: f64,
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
            second: target.second().and_then(|second| surfaces(&second).pop()).map(Surface::second),
        }
    }

    /// Passes the elements inside a view to `take`, each with the part of its solid angle in which it is seen.
    fn elements(&self, view: &View, mut take: impl FnMut(Element)) {
        let cells = self.scenario.target.cells;
        for surface in self.all_surfaces() {
            // A quadrant has that many.
            elements(surface, view, 2 * cells, |element| take(self.shared(element)));
        }
        if let Some(mesh) = &self.mesh {
            mesh.elements(view, cells, |element| take(self.shared(element)));
        }
    }

    /// Returns all surfaces but those of a mesh.
    fn all_surfaces(&self) -> impl Iterator<Item = &Surface> {
        self.surfaces.iter().chain(&self.second)
    }

    /// Reduces an element to the lines of sight that end on it, of those that the target and a second surface share.
    fn shared(&self, element: Element) -> Element {
        let share = self.scenario.target.second_share;
        let part = if element.kind == Kind::Second { share } else { 1.0 - share };
        Element { sr: element.sr * part, ..element }
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
        let mut seen = Ambient::default();
        self.elements(&view, |element| seen.add(&element, &self.air));
        self.with_airlight(seen, &view, self.scenario.target.cells)
    }

    /// Adds the light of the air in a view in which such surfaces are seen.
    fn with_airlight(&self, seen: Ambient, view: &View, cells: u32) -> Ambient {
        if self.is_clear() {
            return seen;
        }
        let surfaces_sr = seen.target_sr + seen.second_sr;
        let air_sr =
            self.air.airlight * (view.solid_angle(cells).projected_sr - surfaces_sr).max(0.0);
        Ambient { air_sr, ..seen }
    }

    /// Computes the returned laser light.
    pub fn returned(&self) -> Returned {
        let (laser, spad) = (&self.scenario.laser, &self.scenario.spad);
        let view = View::cone(laser.field_of_illumination_deg.min(spad.field_of_view_deg));
        let target = &self.scenario.target;
        let is_plain = self.is_plain();
        let mut collected = Collected::default();
        self.elements(&view, |element| {
            let on_the_axis_m = if element.kind == Kind::Second {
                target.second_distance_m
            } else {
                target.distance_m
            };
            collected.add(&element, &self.air, is_plain.then_some(on_the_axis_m));
        });
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

impl Ambient {
    /// Adds the light of an element.
    fn add(&mut self, element: &Element, air: &Air) {
        let of =
            if element.kind == Kind::Second { &mut self.second_sr } else { &mut self.target_sr };
        *of += element.seen_sr(air);
    }
}

/// Light on a pixel.
#[derive(Clone, Debug)]
pub struct PixelLight {
    /// Ambient light.
    pub ambient: Ambient,
    /// Returned laser light.
    pub returned: Returned,
    /// Its part of the array's field of view, by solid angle [1].
    pub share: f64,
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
            Kind::Second => (cos / square * sr, &mut self.returned.second),
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
