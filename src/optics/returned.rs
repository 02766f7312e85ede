//! Laser light that a scene returns, by distance.

use super::air::Air;

/// Part of a beam that sums of solid angles may leave over where surfaces end all of it: the raster of a mesh differs from
/// the outline of a pixel by up to some 1e-6 [1].
const ROUNDING: f64 = 1e-5;

/// Light returned by surfaces.
#[derive(Clone, Debug, Default)]
pub struct Light {
    /// Distance, standard deviation of the distance, and weight of each part [m, m, 1/m^2].
    parts: Vec<[f64; 3]>,
    /// Sum of the weights [1/m^2].
    sum: f64,
    /// Sum of the weights in clear air [1/m^2].
    clear: f64,
}

impl Light {
    /// Adds light from the distance `at_m`, with a uniform spread of sqrt(12) times `spread_m`; `clear` is its weight
    /// in clear air [1/m^2].
    pub fn add(&mut self, at_m: f64, spread_m: f64, weight: f64, clear: f64) {
        if clear > 0.0 {
            self.parts.push([at_m, spread_m, weight]);
            (self.sum, self.clear) = (self.sum + weight, self.clear + clear);
        }
    }

    /// Returns the sum of the weights [1/m^2].
    pub fn sum(&self) -> f64 {
        self.sum
    }

    /// Returns the sum of the weights in clear air [1/m^2].
    pub fn clear(&self) -> f64 {
        self.clear
    }

    /// Returns the mean distance; `None` if no light is returned [m].
    pub fn mean_m(&self) -> Option<f64> {
        let moment: f64 = self.parts.iter().map(|[at_m, _, weight]| at_m * weight).sum();
        (self.sum > 0.0).then(|| moment / self.sum)
    }

    /// Returns the distance, standard deviation of the distance, and weight of each part [m, m, 1/m^2].
    pub fn parts(&self) -> &[[f64; 3]] {
        &self.parts
    }
}

/// Light scattered back by the air in front of the surfaces.
#[derive(Clone, Debug)]
pub struct Haze {
    air: Air,
    /// Solid angle of the visible part of the beam [sr].
    cone_sr: f64,
    /// Distances at which surfaces end the beam, in ascending order, with the solid angle ended up to there [m, sr].
    hidden: Vec<[f64; 2]>,
}

impl Haze {
    /// Creates the air of a cone, in which surfaces end the given solid angles at the given distances [m, sr].
    pub fn new(air: Air, cone_sr: f64, mut hidden: Vec<[f64; 2]>) -> Self {
        hidden.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut sum = 0.0;
        for [_, sr] in &mut hidden {
            sum += *sr;
            *sr = sum;
        }
        Haze { air, cone_sr, hidden }
    }

    /// Returns the distance below which the air returns no light [m].
    pub fn nearest_m(&self) -> f64 {
        self.air.from_m
    }

    /// Returns the distance beyond which the air returns no light, because surfaces have ended all of the beam; infinite
    /// if they do not [m].
    pub fn farthest_m(&self) -> f64 {
        let end = self.hidden.iter().find(|[_, hidden_sr]| self.beside(*hidden_sr) == 0.0);
        end.map_or(f64::INFINITY, |[end_m, _]| *end_m)
    }

    /// Returns the solid angle of the beam at a distance [sr].
    fn open_sr(&self, at_m: f64) -> f64 {
        let before = self.hidden.partition_point(|[end_m, _]| *end_m < at_m);
        self.beside(before.checked_sub(1).map_or(0.0, |last| self.hidden[last][1]))
    }

    /// Returns what is left of the beam's solid angle [sr].
    fn beside(&self, hidden_sr: f64) -> f64 {
        let open_sr = self.cone_sr - hidden_sr;
        if open_sr > ROUNDING * self.cone_sr { open_sr } else { 0.0 }
    }

    /// Returns the backscatter from a section so short that the beam has the same width throughout [1/m^2].
    pub fn sends_back(&self, near_m: f64, far_m: f64) -> f64 {
        self.open_sr((near_m + far_m) / 2.0) * self.air.sends_back(near_m, far_m)
    }
}

/// All returned light, without the factors of reflectance and coefficient of retroreflection.
#[derive(Clone, Debug, Default)]
pub struct Returned {
    /// Diffuse reflection of the surfaces.
    pub diffuse: Light,
    /// Light from a retroreflective patch.
    pub retro: Light,
    /// Diffuse reflection of a second surface.
    pub second: Light,
    /// Backscatter of the air, unless it is clear.
    pub air: Option<Haze>,
}

impl Returned {
    /// Returns the fraction of the surfaces' light that the air transmits [1].
    pub fn transmission(&self) -> f64 {
        let clear = self.diffuse.clear() + self.retro.clear();
        if clear > 0.0 { (self.diffuse.sum() + self.retro.sum()) / clear } else { 1.0 }
    }

    /// Returns the smallest and largest distance of a part of the target that returns light, or else of the second
    /// surface [m].
    pub fn target_ends_m(&self) -> Option<[f64; 2]> {
        let target = Returned::ends_m(&[&self.diffuse, &self.retro]);
        target.or_else(|| Returned::ends_m(&[&self.second]))
    }

    /// Returns the smallest and largest distance of a surface that returns light [m].
    pub fn surface_ends_m(&self) -> Option<[f64; 2]> {
        Returned::ends_m(&[&self.diffuse, &self.retro, &self.second])
    }

    fn ends_m(lights: &[&Light]) -> Option<[f64; 2]> {
        let parts = lights.iter().flat_map(|light| light.parts());
        let ends = |span: Option<[f64; 2]>, [at_m, spread_m, _]: &[f64; 3]| {
            let half_m = 3f64.sqrt() * spread_m;
            let [near_m, far_m] = span.unwrap_or([f64::INFINITY, 0.0]);
            Some([near_m.min(at_m - half_m), far_m.max(at_m + half_m)])
        };
        parts.fold(None, ends)
    }
}
