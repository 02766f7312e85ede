//! Places of an array's pixels, as a dataset's files have them.

use std::path::Path;

use tofsim::error::{Input, Result};

use super::format::TRUTH_ARRAY;
use super::grid::Scene;
use super::parquet_columns::ParquetColumns;
use super::scene_columns::PIXEL;

/// Most rows and most columns of an array.
const MOST: usize = 64;

/// Returns row and column of the pixel of each row of a table, if it has them.
pub(super) fn of_table(columns: &ParquetColumns) -> Result<Option<Vec<[f64; 2]>>> {
    let names = columns.names();
    if !PIXEL.iter().all(|name| names.iter().any(|known| known == name)) {
        return Ok(None);
    }
    let [rows, columns] = [columns.numbers(PIXEL[0])?, columns.numbers(PIXEL[1])?];
    Ok(Some(rows.into_iter().zip(columns).map(|(row, column)| [row, column]).collect()))
}

/// Returns the columns of the arrays of a dataset that have row and column of the pixel, by its description.
pub(super) fn columns_by(json: &str) -> Option<[usize; 2]> {
    let description: serde_json::Value = serde_json::from_str(json).ok()?;
    let labels = description["labels"].as_array()?;
    let column = |name: &str| {
        let label = labels.iter().find(|of| of["name"] == name && of["file"] == TRUTH_ARRAY)?;
        label["column"].as_u64().map(|column| column as usize)
    };
    Some([column(PIXEL[0])?, column(PIXEL[1])?])
}

/// Gives scenes their pixels by row and column, and returns the size of the array.
///
/// # Errors
/// When a place is none.
pub(super) fn assign(path: &Path, scenes: &mut [Scene], places: &[[f64; 2]]) -> Result<[usize; 2]> {
    if places.len() != scenes.len() {
        let expected = format!("{} pixels, expected {}, one a row", places.len(), scenes.len());
        return Err(Input::new(path.display(), expected).into());
    }
    let mut size = [1; 2];
    for (row, place) in places.iter().enumerate() {
        for ((name, &index), most) in PIXEL.iter().zip(place).zip(&mut size) {
            if index.fract() != 0.0 || !(0.0..MOST as f64).contains(&index) {
                let expected = format!("expected a whole number from 0 to {}", MOST - 1);
                let fault = Input::new(path.display(), expected);
                return Err(fault.field(format!("row {row}, column {name}")).value(index).into());
            }
            *most = (index as usize + 1).max(*most);
        }
    }
    for (scene, &[row, column]) in scenes.iter_mut().zip(places) {
        scene.pixel = row as usize * size[1] + column as usize;
    }
    Ok(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_is_numbered_by_row_then_column_of_the_array_that_holds_all() {
        let path = Path::new("own");
        let mut scenes = [Scene::default(); 3];
        let places = [[0.0, 2.0], [1.0, 0.0], [1.0, 1.0]];
        assert_eq!(assign(path, &mut scenes, &places).unwrap(), [2, 3]);
        assert_eq!(scenes.map(|scene| scene.pixel), [2, 3, 4]);
        for wrong in [-1.0, 0.5, 64.0, f64::NAN] {
            let error = assign(path, &mut scenes[..1], &[[0.0, wrong]]).unwrap_err().to_string();
            assert!(error.contains("row 0, column pixel_column") && error.contains("0 to 63"));
        }
    }
}
