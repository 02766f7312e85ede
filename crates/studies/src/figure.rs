//! A number and how well it is known.

/// A value with its standard error, where there is one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figure {
    /// The value, in the column's unit.
    pub value: Option<f64>,
    /// Its standard error.
    pub se: Option<f64>,
}

impl Figure {
    /// A value that no noise moves.
    pub fn exact(value: f64) -> Figure {
        Figure { value: Some(value), se: None }
    }
}

/// The mean of numbers, with its standard error.
pub fn mean(numbers: impl Iterator<Item = f64> + Clone) -> Figure {
    let count = numbers.clone().count() as f64;
    if count == 0.0 {
        return Figure::default();
    }
    let mean = numbers.clone().sum::<f64>() / count;
    let squares: f64 = numbers.map(|number| (number - mean) * (number - mean)).sum();
    let se = (count > 1.0).then(|| (squares / (count - 1.0) / count).sqrt());
    Figure { value: Some(mean), se }
}
