//! Equations with a symmetric positive matrix of a few rows.

/// A symmetric matrix.
pub type Matrix<const N: usize> = [[f64; N]; N];

/// A pivot below this part of its diagonal element makes a matrix singular [1].
const SINGULAR: f64 = 1e-13;

/// `x` with `matrix x = right`, after the diagonal has grown by the part `damping`. Rows and columns that are `held` are
/// left out, and `x` is 0 there. `None` for a singular matrix.
pub fn solve<const N: usize>(
    matrix: &Matrix<N>,
    right: &[f64; N],
    damping: f64,
    held: &[bool; N],
) -> Option<[f64; N]> {
    let free = || (0..N).filter(|&row| !held[row]);
    let mut lower = [[0.0; N]; N];
    for row in free() {
        for column in free().take_while(|&column| column <= row) {
            let done: f64 = (0..column).map(|k| lower[row][k] * lower[column][k]).sum();
            let element = matrix[row][column];
            lower[row][column] = if row == column {
                let pivot = element * (1.0 + damping) - done;
                // Not a number is no pivot either.
                if pivot.is_nan() || pivot <= element * SINGULAR || !pivot.is_finite() {
                    return None;
                }
                pivot.sqrt()
            } else {
                (element - done) / lower[column][column]
            };
        }
    }
    let mut x = [0.0; N];
    for row in free() {
        let done: f64 = (0..row).map(|k| lower[row][k] * x[k]).sum();
        x[row] = (right[row] - done) / lower[row][row];
    }
    for row in free().rev() {
        let done: f64 = (row + 1..N).map(|k| lower[k][row] * x[k]).sum();
        x[row] = (x[row] - done) / lower[row][row];
    }
    Some(x)
}

/// The diagonal of the inverse; as in [`solve`] if `held`.
pub fn inverse_diagonal<const N: usize>(matrix: &Matrix<N>, held: &[bool; N]) -> Option<[f64; N]> {
    let mut diagonal = [0.0; N];
    for (k, element) in diagonal.iter_mut().enumerate() {
        let mut unit = [0.0; N];
        unit[k] = 1.0;
        *element = solve(matrix, &unit, 0.0, held)?[k];
    }
    Some(diagonal)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATRIX: Matrix<3> = [[4.0, 2.0, -2.0], [2.0, 5.0, 1.0], [-2.0, 1.0, 6.0]];

    #[test]
    fn a_solution_fulfils_its_equations() {
        let x = solve(&MATRIX, &[2.0, -1.0, 3.0], 0.0, &[false; 3]).unwrap();
        for (row, right) in MATRIX.iter().zip([2.0, -1.0, 3.0]) {
            let left: f64 = row.iter().zip(x).map(|(a, x)| a * x).sum();
            assert!((left - right).abs() < 1e-14);
        }
    }

    #[test]
    fn a_held_coordinate_does_not_move() {
        let x = solve(&MATRIX, &[8.0, 5.0, 7.0], 0.0, &[false, false, true]).unwrap();
        assert!((x[0] - 30.0 / 16.0).abs() < 1e-14 && (x[1] - 4.0 / 16.0).abs() < 1e-14);
        assert_eq!(x[2], 0.0);
        let x = solve(&MATRIX, &[8.0, 7.0, 2.0], 0.0, &[false, true, false]).unwrap();
        assert!((x[0] - 52.0 / 20.0).abs() < 1e-14 && (x[2] - 24.0 / 20.0).abs() < 1e-14);
        assert_eq!(x[1], 0.0);
    }

    #[test]
    fn the_inverse_of_a_diagonal_matrix() {
        let matrix = [[4.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 16.0]];
        assert_eq!(inverse_diagonal(&matrix, &[false; 3]), Some([0.25, 1.0, 0.0625]));
        assert_eq!(inverse_diagonal(&matrix, &[false, false, true]), Some([0.25, 1.0, 0.0]));
    }

    #[test]
    fn a_singular_matrix_has_no_solution_until_it_is_damped() {
        let singular = [[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(solve(&singular, &[1.0; 3], 0.0, &[false; 3]), None);
        assert!(solve(&singular, &[1.0; 3], 0.01, &[false; 3]).is_some());
        assert_eq!(solve(&[[f64::NAN; 3]; 3], &[1.0; 3], 0.0, &[false; 3]), None);
    }
}
