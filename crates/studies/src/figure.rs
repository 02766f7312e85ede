//! Values with standard errors.

use tofsim_learn::evaluation::spread::mean_and_error;

/// A value with its standard error, if it has one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figure {
    /// Value, in the column's unit.
    pub value: Option<f64>,
    /// Standard error.
    pub se: Option<f64>,
    /// Number of cases, if it is a rate [1].
    pub of: Option<f64>,
}

impl Figure {
    /// Creates a value with its standard error.
    pub fn new(value: Option<f64>, se: Option<f64>) -> Self {
        Figure { value, se, of: None }
    }
}

/// Computes the mean of numbers, with its standard error.
pub fn mean(numbers: impl Iterator<Item = f64> + Clone) -> Figure {
    let (mean, se) = mean_and_error(numbers);
    Figure::new(mean, se)
}

/// Combines repeats: their mean, with the standard error derived from their scatter; the first one if there is only
/// one or the values are not random.
pub fn of_repeats(
    is_random: bool,
    mut repeats: impl ExactSizeIterator<Item = Figure> + Clone,
) -> Figure {
    if repeats.len() == 1 || !is_random {
        return repeats.next().unwrap_or_default();
    }
    mean(repeats.filter_map(|figure| figure.value))
}

/// Combines scenes with independent errors: the mean of their values or, for rates, the rate over all cases.
pub fn mean_of_scenes(figures: impl Iterator<Item = Figure>) -> Figure {
    let (mut all, mut sum, mut variance) = (0.0, 0.0, Some(0.0));
    for figure in figures {
        let Some(value) = figure.value else { continue };
        let weight = figure.of.unwrap_or(1.0);
        all += weight;
        sum += weight * value;
        variance = variance.zip(figure.se).map(|(sum, se)| sum + weight * weight * se * se);
    }
    if all > 0.0 {
        Figure::new(Some(sum / all), variance.map(|sum: f64| sum.sqrt() / all))
    } else {
        Figure::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(values: [f64; 3]) -> [Figure; 3] {
        values.map(|value| Figure::new(Some(value), Some(0.3)))
    }

    #[test]
    fn repeats_have_the_error_of_their_scatter_and_scenes_that_of_each() {
        let three = figures([1.0, 2.0, 3.0]);
        let repeats = of_repeats(true, three.iter().copied());
        assert_eq!(repeats.value, Some(2.0));
        assert!((repeats.se.unwrap() - (1.0f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!(of_repeats(false, three.iter().copied()), three[0]);
        assert_eq!(of_repeats(true, three[..1].iter().copied()), three[0]);
        let scenes = mean_of_scenes(three.into_iter().chain([Figure::default()]));
        assert_eq!(scenes.value, Some(2.0));
        assert!((scenes.se.unwrap() - 0.3 / 3f64.sqrt()).abs() < 1e-12);
        assert_eq!(mean_of_scenes([Figure::default()].into_iter()), Figure::default());
    }

    #[test]
    fn the_mean_of_rates_is_the_rate_over_all() {
        // One of one, and none of 99.
        let rate = |value, of| Figure { of: Some(of), ..Figure::new(Some(value), Some(0.1)) };
        let all = mean_of_scenes([rate(1.0, 1.0), rate(0.0, 99.0), Figure::default()].into_iter());
        assert_eq!(all.value, Some(0.01));
        assert!((all.se.unwrap() - 0.1 * (1.0f64 + 99.0 * 99.0).sqrt() / 100.0).abs() < 1e-12);
    }
}
