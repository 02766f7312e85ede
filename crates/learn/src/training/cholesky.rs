//! Symmetric systems of equations, solved by Cholesky's factors.
//!
//! Every sum has one order, whatever the processor: panels of eight columns are vectors across, so
//! that wider registers change the speed and not a bit of the result.

/// Columns of a panel.
pub const PANEL: usize = 8;

/// The lower half of a symmetric matrix; panel `p` has the columns `8 p ..` of rows `8 p ..`.
#[derive(Clone, Debug, PartialEq)]
pub struct Symmetric {
    size: usize,
    panels: Vec<Vec<[f64; PANEL]>>,
}

impl Symmetric {
    /// A matrix of zeros with `size` rows.
    pub fn zeros(size: usize) -> Self {
        let rows = size.next_multiple_of(PANEL);
        let panel = |p| vec![[0.0; PANEL]; rows - p * PANEL];
        Symmetric { size, panels: (0..rows / PANEL).map(panel).collect() }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The element of a row and a column, in either order.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        let (row, column) = (row.max(column), row.min(column));
        self.panels[column / PANEL][row - column / PANEL * PANEL][column % PANEL]
    }

    /// Adds to the element of a row and a column, which is also that of the column and the row.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let (row, column) = (row.max(column), row.min(column));
        self.panels[column / PANEL][row - column / PANEL * PANEL][column % PANEL] += value;
    }

    /// Multiplies every element.
    pub fn scale(&mut self, factor: f64) {
        self.panels.iter_mut().flatten().flatten().for_each(|element| *element *= factor);
    }

    /// Solves `(self + damping I) x = right`; `None` unless that matrix is positive definite.
    pub fn solve(&self, damping: f64, right: &[f64]) -> Option<Vec<f64>> {
        let mut factor = self.clone();
        for row in 0..factor.panels.len() * PANEL {
            factor.add(row, row, if row < self.size { damping } else { 1.0 });
        }
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
        for p in 0..self.panels.len() {
            let (before, rest) = self.panels.split_at_mut(p);
            let target = &mut rest[0];
            for (q, panel) in before.iter().enumerate() {
                let rows = &panel[(p - q) * PANEL..];
                // Transposed, so that its rows are vectors.
                let top: [[f64; PANEL]; PANEL] =
                    std::array::from_fn(|k| std::array::from_fn(|column| rows[column][k]));
                for (target, row) in target.iter_mut().zip(rows) {
                    for k in 0..PANEL {
                        for column in 0..PANEL {
                            target[column] -= row[k] * top[k][column];
                        }
                    }
                }
            }
            factorise_panel(target)?;
        }
        Some(())
    }

    /// Forward through L, and back through its transpose.
    fn substitute(&self, right: &[f64]) -> Vec<f64> {
        let mut x = right.to_vec();
        x.resize(self.panels.len() * PANEL, 0.0);
        for (p, panel) in self.panels.iter().enumerate() {
            for k in 0..PANEL {
                let (pivot, first) = (p * PANEL + k, p * PANEL);
                x[pivot] /= panel[k][k];
                let value = x[pivot];
                for (place, row) in x[first..].iter_mut().zip(panel).skip(k + 1) {
                    *place -= row[k] * value;
                }
            }
        }
        for (p, panel) in self.panels.iter().enumerate().rev() {
            for k in (0..PANEL).rev() {
                let (below, first) = (&panel[k + 1..], p * PANEL + k + 1);
                let known: f64 = below.iter().zip(&x[first..]).map(|(row, x)| row[k] * x).sum();
                x[first - 1] = (x[first - 1] - known) / panel[k][k];
            }
        }
        x.truncate(self.size);
        x
    }
}

/// The last steps for the eight columns of a panel, among themselves.
#[inline(always)]
fn factorise_panel(panel: &mut [[f64; PANEL]]) -> Option<()> {
    for k in 0..PANEL {
        let square = panel[k][k];
        // Neither a negative nor a non-number has a root to divide by.
        if square.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) || square.is_infinite() {
            return None;
        }
        let root = square.sqrt();
        panel[k][k] = root;
        panel[k + 1..].iter_mut().for_each(|row| row[k] /= root);
        for column in k + 1..PANEL {
            let factor = panel[column][k];
            panel[column..].iter_mut().for_each(|row| row[column] -= row[k] * factor);
        }
    }
    Some(())
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
