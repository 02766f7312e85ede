//! Symmetric systems of equations, solved by Cholesky's factors.
//!
//! Every sum has one order, whatever the processor: columns are vectors, so that wider registers
//! change the speed and not a bit of the result.

/// The lower half of a symmetric matrix: each column from the diagonal down.
#[derive(Clone, Debug, PartialEq)]
pub struct Symmetric {
    columns: Vec<Vec<f64>>,
}

impl Symmetric {
    /// A matrix of zeros with `size` rows.
    pub fn zeros(size: usize) -> Self {
        Symmetric { columns: (0..size).map(|column| vec![0.0; size - column]).collect() }
    }

    /// The element of a row and a column, in either order.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.columns[row.min(column)][row.abs_diff(column)]
    }

    /// Adds to the element of a row and a column, which is also that of the column and the row.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.columns[row.min(column)][row.abs_diff(column)] += value;
    }

    /// Multiplies every element.
    pub fn scale(&mut self, factor: f64) {
        self.columns.iter_mut().flatten().for_each(|element| *element *= factor);
    }

    /// Solves `(self + damping I) x = right`; `None` unless that matrix is positive definite.
    pub fn solve(&self, damping: f64, right: &[f64]) -> Option<Vec<f64>> {
        let mut factor = self.clone();
        factor.columns.iter_mut().for_each(|column| column[0] += damping);
        // With the widest vectors that the processor has.
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || factor.factorise(),
        )?;
        Some(factor.substitute(right))
    }

    /// Turns the matrix into its factor L, column by column.
    #[inline(always)]
    fn factorise(&mut self) -> Option<()> {
        for k in 0..self.columns.len() {
            let (before, rest) = self.columns.split_at_mut(k);
            let target = &mut rest[0];
            for (place, column) in before.iter().enumerate() {
                let column = &column[k - place..];
                let factor = column[0];
                target.iter_mut().zip(column).for_each(|(target, row)| *target -= row * factor);
            }
            let square = target[0];
            // Neither a negative nor a non-number has a root to divide by.
            if square.is_nan() || square <= 0.0 || square.is_infinite() {
                return None;
            }
            target[0] = square.sqrt();
            let root = target[0];
            target[1..].iter_mut().for_each(|row| *row /= root);
        }
        Some(())
    }

    /// Forward through L, and back through its transpose.
    fn substitute(&self, right: &[f64]) -> Vec<f64> {
        let mut x = right.to_vec();
        for (k, column) in self.columns.iter().enumerate() {
            x[k] /= column[0];
            let value = x[k];
            x[k..].iter_mut().zip(column).skip(1).for_each(|(x, row)| *x -= row * value);
        }
        for (k, column) in self.columns.iter().enumerate().rev() {
            let known: f64 = column.iter().zip(&x[k..]).skip(1).map(|(row, x)| row * x).sum();
            x[k] = (x[k] - known) / column[0];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A positive definite matrix that is not near any other.
    fn matrix(size: usize) -> Symmetric {
        let mut matrix = Symmetric::zeros(size);
        for row in 0..size {
            for column in 0..=row {
                matrix.add(row, column, ((row * 7 + column * 13) % 11) as f64 / 11.0);
            }
            matrix.add(row, row, size as f64);
        }
        matrix
    }

    #[test]
    fn the_solution_solves_the_damped_system() {
        for size in [1, 2, 7, 8, 9, 37, 64] {
            let matrix = matrix(size);
            let expected: Vec<f64> = (0..size).map(|k| (k as f64 * 0.7).sin()).collect();
            let product = |row| -> f64 {
                let sum = (0..size).map(|column| matrix.at(row, column) * expected[column]);
                sum.sum::<f64>() + 0.25 * expected[row]
            };
            let right: Vec<f64> = (0..size).map(product).collect();
            let found = matrix.solve(0.25, &right).unwrap();
            assert_eq!(found.len(), size);
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-12, "{size}: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_singular_matrix_has_no_solution_until_it_is_damped() {
        let mut singular = Symmetric::zeros(2);
        for (row, column) in [(0, 0), (1, 0), (1, 1)] {
            singular.add(row, column, 1.0);
        }
        assert_eq!(singular.solve(0.0, &[1.0, 1.0]), None);
        let found = singular.solve(1.0, &[1.0, 1.0]).unwrap();
        assert!(found.iter().all(|x| (x - 1.0 / 3.0).abs() < 1e-15));
    }

    #[test]
    fn what_is_no_number_is_not_solved() {
        for value in [f64::NAN, f64::INFINITY, -1.0] {
            let mut matrix = Symmetric::zeros(1);
            matrix.add(0, 0, value);
            assert_eq!(matrix.solve(0.0, &[1.0]), None);
        }
    }
}
