//! Which rows a dataset has.

use super::grid::Grid;
use super::scene::Scene;
use super::subset::Subset;

/// A row: what its histogram is drawn for, and where its random numbers are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberedScene {
    /// Row number; with the seed it decides the random numbers.
    pub number: u64,
    /// The scene.
    pub scene: Scene,
}

/// The rows of a dataset, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// All of a grid.
    All(Grid),
    /// Some of a grid's scenes, with row numbers of their own.
    Subset(Subset),
}

impl Rows {
    /// Number of rows.
    pub fn len(&self) -> u64 {
        match self {
            Rows::All(grid) => grid.len(),
            Rows::Subset(subset) => subset.len,
        }
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The grid that the scenes are taken from.
    pub fn grid(&self) -> &Grid {
        match self {
            Rows::All(grid) => grid,
            Rows::Subset(subset) => &subset.grid,
        }
    }

    /// The row at `index`, from 0 and below [`Rows::len`].
    pub fn row(&self, index: u64) -> NumberedScene {
        match self {
            Rows::All(grid) => {
                NumberedScene { number: grid.first_row + index, scene: grid.scene(index) }
            }
            Rows::Subset(subset) => {
                NumberedScene { number: subset.first_row() + index, scene: subset.scene(index) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_sets_share_a_row_number() {
        let (train, test) = (Grid::training(), Grid::test());
        let subset = |grid| Rows::Subset(Subset::new(grid, 1_000_000, 1));
        let sets = [Rows::All(train), subset(train), Rows::All(test), subset(test)];
        let numbers = sets.map(|rows| (rows.row(0).number, rows.row(rows.len() - 1).number));
        assert!(numbers.windows(2).all(|pair| pair[0].1 < pair[1].0), "{numbers:?}");
        assert!(numbers[3].1 < 1 << 56, "beyond what a stream can hold");
    }
}
