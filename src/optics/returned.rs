//! What comes back of the laser's light, by the distance that it comes back from.

use super::air::Air;

/// What surfaces send back.
#[derive(Clone, Debug, Default)]
pub struct Light {
    /// Distances, how much they are spread, and weights [m, m, 1/m^2].
    parts: Vec<[f64; 3]>,
    /// Sum of the weights [1/m^2].
    sum: f64,
    /// What it would be in clear air [1/m^2].
    clear: f64,
}

impl Light {
    /// Adds what comes back from a distance, spread over sqrt(12) times a deviation [m]; `clear` is what it
    /// would be in clear air [1/m^2].
    pub fn add(&mut self, at_m: f64, spread_m: f64, weight: f64, clear: f64) {
        if clear > 0.0 {
            self.parts.push([at_m, spread_m, weight]);
            (self.sum, self.clear) = (self.sum + weight, self.clear + clear);
        }
    }

    /// All of it [1/m^2].
    pub fn sum(&self) -> f64 {
        self.sum
    }

    /// What it would be in clear air [1/m^2].
    pub fn clear(&self) -> f64 {
        self.clear
    }

    /// Mean distance; `None` where nothing comes back [m].
    pub fn mean_m(&self) -> Option<f64> {
        let moment: f64 = self.parts.iter().map(|[at_m, _, weight]| at_m * weight).sum();
        (self.sum > 0.0).then(|| moment / self.sum)
    }

    /// Distances, how much they are spread, and weights [m, m, 1/m^2].
    pub fn parts(&self) -> &[[f64; 3]] {
        &self.parts
    }
}

/// What air sends back from before the surfaces.
#[derive(Clone, Debug)]
pub struct Haze {
    air: Air,
    /// Solid angle of the beam, as far as it is seen [sr].
    cone_sr: f64,
    /// Distances at which surfaces end it, in order, and the solid angle of those up to there [m, sr].
    hidden: Vec<[f64; 2]>,
}

impl Haze {
    /// In a cone where surfaces end lines of sight after such ways, under such solid angles [m, sr].
    pub fn new(air: Air, cone_sr: f64, mut hidden: Vec<[f64; 2]>) -> Self {
        hidden.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut sum = 0.0;
        for [_, sr] in &mut hidden {
            sum += *sr;
            *sr = sum;
        }
        Haze { air, cone_sr, hidden }
    }

    /// Nearer air sends nothing back [m].
    pub fn nearest_m(&self) -> f64 {
        self.air.from_m
    }

    /// Solid angle of the beam at a distance [sr].
    fn open_sr(&self, at_m: f64) -> f64 {
        let before = self.hidden.partition_point(|[end_m, _]| *end_m < at_m);
        let hidden_sr = before.checked_sub(1).map_or(0.0, |last| self.hidden[last][1]);
        (self.cone_sr - hidden_sr).max(0.0)
    }

    /// What comes back from distances so near to each other that the beam is as wide all the way [1/m^2].
    pub fn sends_back(&self, near_m: f64, far_m: f64) -> f64 {
        self.open_sr((near_m + far_m) / 2.0) * self.air.sends_back(near_m, far_m)
    }
}

/// All of it, before reflectance and coefficient of retroreflection.
#[derive(Clone, Debug, Default)]
pub struct Returned {
    /// What surfaces diffuse.
    pub diffuse: Light,
    /// What a patch sends back to where it comes from.
    pub retro: Light,
    /// What the air sends back, if there is something in it.
    pub air: Option<Haze>,
}

impl Returned {
    /// The part of the surfaces' light that the air leaves of it [1].
    pub fn transmission(&self) -> f64 {
        let clear = self.diffuse.clear() + self.retro.clear();
        if clear > 0.0 { (self.diffuse.sum() + self.retro.sum()) / clear } else { 1.0 }
    }

    /// Nearest and farthest distance of a surface that sends light back [m].
    pub fn ends_m(&self) -> Option<[f64; 2]> {
        let parts = self.diffuse.parts().iter().chain(self.retro.parts());
        let ends = |span: Option<[f64; 2]>, [at_m, spread_m, _]: &[f64; 3]| {
            let half_m = 3f64.sqrt() * spread_m;
            let [near_m, far_m] = span.unwrap_or([f64::INFINITY, 0.0]);
            Some([near_m.min(at_m - half_m), far_m.max(at_m + half_m)])
        };
        parts.fold(None, ends)
    }
}
