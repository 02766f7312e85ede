//! Combination of a plan's axes to points.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use tofsim::error::Result;
use tofsim::files::digest::digest_of;
use tofsim::files::toml::Checked;

use super::axis::Axis;
use super::file::{Combine, PlanFile};

/// Largest number of points of a plan.
pub const MOST_POINTS: u64 = 10_000_000;

/// Largest number of scenes per point.
const MOST_SCENES: u128 = 100_000;

/// Points of a plan, computed from their numbers.
#[derive(Clone, Debug)]
pub struct Combination {
    /// Axes; the last one changes fastest.
    pub axes: Vec<Axis>,
    combine: Combine,
    count: u64,
    /// For a Latin hypercube, the interval of each point on each axis.
    parts: Vec<Vec<u32>>,
    seed: u64,
}

impl Combination {
    /// Combines a plan's axes.
    ///
    /// # Errors
    /// If there are no points or too many, or the axes are inconsistent.
    pub fn new(checked: &Checked, file: &PlanFile, axes: Vec<Axis>, seed: u64) -> Result<Self> {
        let is_hypercube = file.combine == Combine::LatinHypercube;
        let fault = |key: String, expected: &str| checked.fault(&key, expected);
        if file.samples.is_some() != is_hypercube {
            let expected =
                "expected samples with combine = \"latin_hypercube\", and with that only";
            return Err(fault("samples".to_owned(), expected).into());
        }
        let counts: Vec<_> = axes.iter().map(Axis::count).collect();
        let missing = counts.iter().position(Option::is_none).filter(|_| !is_hypercube);
        if let Some(axis) = missing {
            let expected = "expected count, the number of values, with a range or a distribution";
            return Err(fault(format!("axis.{axis}.count"), expected).into());
        }
        let counts: Vec<_> = counts.into_iter().map(|count| count.unwrap_or(1)).collect();
        let count = match file.combine {
            Combine::Product => product(&axes),
            Combine::Zip => {
                let first = counts.first().copied().unwrap_or(1);
                if let Some(axis) = counts.iter().position(|count| *count != first) {
                    let expected = format!(
                        "it has {} values, expected {first} as the first axis has, to be zipped",
                        counts[axis]
                    );
                    return Err(fault(format!("axis.{axis}.key"), &expected).into());
                }
                u128::from(first)
            }
            Combine::LatinHypercube => file.samples.unwrap_or(1).into(),
        };
        if count > u128::from(MOST_POINTS) {
            let expected = format!(
                "the plan has {} points, expected {} at most",
                grouped(count),
                grouped(MOST_POINTS.into())
            );
            let key = if is_hypercube { "samples" } else { "axis" };
            return Err(checked.fault(key, expected).into());
        }
        let mut points = Combination {
            axes,
            combine: file.combine,
            count: count as u64,
            parts: Vec::new(),
            seed,
        };
        if is_hypercube {
            points.parts = points.axes.iter().map(|axis| points.permutation(&axis.key)).collect();
        }
        Ok(points)
    }

    /// Returns the number of points.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the settings of a point, as an assignment for each axis.
    pub fn settings(&self, point: u64) -> Vec<String> {
        let values = self.values(point);
        let pairs = self.axes.iter().zip(values);
        pairs.map(|(axis, value)| format!("{}={value}", axis.key)).collect()
    }

    /// Returns the value of each axis at a point, as TOML.
    pub fn values(&self, point: u64) -> Vec<String> {
        let mut rest = point;
        let mut places = vec![0; self.axes.len()];
        for (place, axis) in places.iter_mut().zip(&self.axes).rev() {
            *place = match self.combine {
                Combine::Product => {
                    let count = axis.count().unwrap_or(1);
                    let place = rest % count;
                    rest /= count;
                    place
                }
                Combine::Zip | Combine::LatinHypercube => point,
            };
        }
        let value = |(k, (axis, place)): (usize, (&Axis, u64))| match self.combine {
            Combine::LatinHypercube => {
                let part = f64::from(self.parts[k][point as usize]);
                axis.at((part + self.draw(&axis.key, point)) / self.count as f64)
            }
            _ if axis.is_drawn() => axis.value(place, self.draw(&axis.key, place)),
            _ => axis.value(place, 0.0),
        };
        self.axes.iter().zip(places).enumerate().map(value).collect()
    }

    /// Draws a number between 0 and 1, excluding both, which depends only on the seed, the key and the index.
    fn draw(&self, key: &str, place: u64) -> f64 {
        let mut random = self.stream(key);
        random.set_word_pos(2 * u128::from(place) + (1 << 40));
        let word: u64 = random.random();
        tofsim::sensor::streams::uniform(word)
    }

    /// Draws a permutation of the points' numbers, which depends only on the seed and the key.
    fn permutation(&self, key: &str) -> Vec<u32> {
        let mut random = self.stream(key);
        let mut order: Vec<_> = (0..self.count as u32).collect();
        for last in (1..order.len()).rev() {
            order.swap(last, random.random_range(0..=last));
        }
        order
    }

    fn stream(&self, key: &str) -> ChaCha8Rng {
        let mut bytes = *b"................tofsim axis v1..";
        bytes[..8].copy_from_slice(&self.seed.to_le_bytes());
        bytes[8..16].copy_from_slice(&digest_of(format_args!("{key}")).to_le_bytes());
        ChaCha8Rng::from_seed(bytes)
    }
}

/// Returns the number of points in the Cartesian product of the axes.
pub fn product(axes: &[Axis]) -> u128 {
    axes.iter().fold(1, |all, axis| all.saturating_mul(axis.count().unwrap_or(1).into()))
}

/// Returns all scenes in the Cartesian product of the axes, as an assignment for each key; keys in `taken` are not
/// allowed.
///
/// # Errors
/// If there are too many, or an axis has no listed values.
pub fn scenes(
    checked: &Checked,
    place: &str,
    axes: &[Axis],
    taken: &[&str],
) -> Result<Vec<Vec<String>>> {
    let fault = |k: usize, expected| checked.fault(&format!("{place}.{k}.key"), expected);
    if let Some(k) = axes.iter().position(|axis| taken.contains(&axis.key.as_str())) {
        return Err(fault(k, "expected a key that nothing else varies").into());
    }
    if let Some(k) = axes.iter().position(|axis| axis.count().is_none() || axis.is_drawn()) {
        return Err(fault(k, "expected values, range, or from, to and count").into());
    }
    let count = product(axes);
    if count > MOST_SCENES {
        let expected =
            format!("it has {} scenes, expected {} at most", grouped(count), grouped(MOST_SCENES));
        return Err(checked.fault(place, expected).into());
    }
    let scene = |scene: u128| {
        let mut rest = scene as u64;
        let assignment = |axis: &Axis| {
            let count = axis.count().unwrap_or(1);
            let value = axis.value(rest % count, 0.0);
            rest /= count;
            format!("{}={value}", axis.key)
        };
        axes.iter().map(assignment).collect()
    };
    Ok((0..count).map(scene).collect())
}

/// Formats a number with thousands separators.
fn grouped(number: u128) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy);
    groups.collect::<Vec<_>>().join(",")
}
