//! The ends of a box plot.

/// Whiskers reach so many heights of the box at most (Tukey).
const REACH: f64 = 1.5;

/// Errors beyond a whisker that are kept on either side; of more, these and the farthest.
const KEPT: usize = 40;

/// Ends of a box's whiskers, and the errors beyond them.
#[derive(Clone, Debug, PartialEq)]
pub struct Tails {
    /// The last errors within one and a half boxes of the box [mm].
    pub whiskers_mm: [f64; 2],
    /// The errors beyond, in rising order; a part of them where there are many [mm].
    pub beyond_mm: Vec<f64>,
}

impl Tails {
    /// Of errors in rising order, of which there is one at least, with quartiles [mm].
    pub(super) fn of(sorted_mm: &[f64], [lower, upper]: [f64; 2]) -> Self {
        let reach = REACH * (upper - lower);
        let first = sorted_mm.partition_point(|&error| error < lower - reach);
        let end = sorted_mm.partition_point(|&error| error <= upper + reach);
        let mut beyond_mm: Vec<f64> = thinned(&sorted_mm[..first]);
        let above: Vec<f64> = sorted_mm[end..].iter().rev().copied().collect();
        beyond_mm.extend(thinned(&above).into_iter().rev());
        Tails { whiskers_mm: [sorted_mm[first], sorted_mm[end - 1]], beyond_mm }
    }
}

/// [`KEPT`] of the errors of a side at most, evenly far apart in their order, the first, which is the
/// farthest, among them.
fn thinned(errors_mm: &[f64]) -> Vec<f64> {
    let step = errors_mm.len().div_ceil(KEPT).max(1);
    errors_mm.iter().copied().step_by(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whiskers_end_at_errors_and_the_rest_lies_beyond() {
        let tails = Tails::of(&[-100.0, -2.5, -1.0, 0.0, 1.0, 2.0, 50.0], [-1.0, 1.0]);
        assert_eq!(tails.whiskers_mm, [-2.5, 2.0]);
        assert_eq!(tails.beyond_mm, [-100.0, 50.0]);
        let one = Tails::of(&[3.0; 4], [3.0; 2]);
        assert_eq!((one.whiskers_mm, one.beyond_mm), ([3.0; 2], Vec::new()));
    }

    #[test]
    fn of_many_errors_beyond_the_farthest_is_kept() {
        let far = (0..1000).map(|k| -2000.0 + f64::from(k));
        let near = (0..9000).map(|k| 1e-3 * f64::from(k));
        let up = (0..1000).map(|k| 1000.0 + f64::from(k));
        let errors_mm: Vec<f64> = far.chain(near).chain(up).collect();
        let tails = Tails::of(&errors_mm, [2.0, 7.0]);
        assert!(tails.beyond_mm.is_sorted() && tails.beyond_mm.len() <= 2 * KEPT);
        assert_eq!(tails.beyond_mm.first(), Some(&-2000.0));
        assert_eq!(tails.beyond_mm.last(), Some(&1999.0));
    }
}
