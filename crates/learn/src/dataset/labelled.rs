//! Histograms from files, measured ones or those that `tofsim dataset` wrote, with what is known of each.
//!
//! CSV and `.npy` are read by [`histogram_file`]; here are Parquet files and folders with both.

use std::path::Path;

use tofsim::error::{Input, Result, read_text};
use tofsim::firmware::histogram_builder::Params;
use tofsim::network::histogram::count_range;
use tofsim::network::{Histogram, histogram_file};
use tofsim::scenario::Scenario;

use super::files::DESCRIPTION;
use super::format::{TABLE, TRUTH_ARRAY};
use super::grid::Scene;
use super::npy::numbers;
use super::parquet_columns::ParquetColumns;
use super::parquet_input::is_parquet;
use super::pixel_places;
use super::scene_columns::TRUTH;

/// Table, histograms and truth in the folder of a dataset.
const FILES: [&str; 3] = [TABLE, "histograms.npy", TRUTH_ARRAY];
/// Key of the description in the metadata of a Parquet file.
const KEY: &str = "tofsim.dataset";

/// Histograms of known distances.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labelled {
    /// Counts by bin [hits].
    pub histograms: Vec<Histogram>,
    /// Scene of each histogram; reflectance and irradiance are 0 if they are unknown. Only a pixel of an array may have
    /// no distance (NaN).
    pub scenes: Vec<Scene>,
    /// Rows and columns of the array whose pixels they are, if the file has their places.
    pub array: Option<[usize; 2]>,
    /// Whether reflectance and irradiance are known.
    pub knows_light: bool,
    /// Carry chain, if the file says so.
    pub profile: Option<String>,
    /// Shots of a histogram, if the file says so.
    pub shots: Option<u64>,
}

/// The histograms of a file, which are as large as a scenario says: CSV, `.npy` or Parquet, told apart by content.
///
/// # Errors
/// When the file cannot be read, or a count is none.
pub fn histograms(path: &Path, size: Params) -> Result<histogram_file::Histograms> {
    if !is_parquet(path)? {
        return histogram_file::open(path, size);
    }
    let all = ParquetColumns::with(path, |columns| counts(path, columns, &size))?;
    Ok(Box::new(all.into_iter().map(Ok)))
}

impl Labelled {
    /// Of a Parquet file with a column for each bin, `b0` and so on, and `distance_m`, of the folder of a dataset, or of an
    /// `.npy` file with the true distances in another.
    ///
    /// # Errors
    /// When a file cannot be read, a column is missing or a number makes no sense, or there are not as
    /// many distances as histograms.
    pub fn read(path: &Path, truth: Option<&Path>, size: &Params) -> Result<Self> {
        let [table, arrays, own_truth] = FILES.map(|name| path.join(name));
        if path.is_dir() {
            let description = path.join(DESCRIPTION);
            let description = description.exists().then(|| read_text(&description)).transpose()?;
            let labelled = match (table.exists(), arrays.exists(), truth) {
                (true, _, None) => parquet(&table, size)?,
                (_, true, Some(truth)) => of_arrays(&arrays, truth, None, size)?,
                (_, true, None) => {
                    let places = description.as_deref().and_then(pixel_places::columns_by);
                    of_arrays(&arrays, &own_truth, places, size)?
                }
                _ => {
                    let expected =
                        format!("expected {}, or {} and {} in it", FILES[0], FILES[1], FILES[2]);
                    return Err(Input::new(path.display(), expected).into());
                }
            };
            return Ok(match description {
                Some(json) => labelled.described(&json),
                None => labelled,
            });
        }
        match (is_parquet(path)?, truth) {
            (true, None) => parquet(path, size),
            (false, Some(truth)) => of_arrays(path, truth, None, size),
            (true, Some(_)) => {
                let expected = "expected none: a Parquet file has its column distance_m";
                Err(Input::new("--truth", expected).into())
            }
            (false, None) => {
                let expected =
                    "expected the folder of a dataset, a Parquet file, or --truth FILE.npy";
                Err(Input::new(path.display(), expected).into())
            }
        }
    }

    /// With what a description says of chain and shots.
    fn described(mut self, json: &str) -> Self {
        let description: serde_json::Value = serde_json::from_str(json).unwrap_or_default();
        let profile = description["profile"].as_str().map(str::to_owned);
        self.profile = profile.or(self.profile);
        self.shots = description["shots_per_frame"].as_u64().or(self.shots);
        self
    }

    /// Checks that chain and shots stated in the files equal those of a scenario; `source` is the path of the files.
    ///
    /// # Errors
    /// Naming the first difference.
    pub fn check(&self, source: &Path, scenario: &Scenario) -> Result<()> {
        let fault = |field: &str, value: &str, expected: String| {
            let expected =
                format!("expected {expected}, as the scenario has it; see --profile and -s");
            Err(Input::new(source.display(), expected).field(field).value(value).into())
        };
        let (own, shots) = (&scenario.tdc.profile, scenario.firmware.shots_per_frame);
        let name = |profile: &str| Path::new(profile).file_name().map(ToOwned::to_owned);
        match (&self.profile, self.shots) {
            (Some(profile), _) if name(profile) != name(own) => {
                fault("profile", profile, own.clone())
            }
            (_, Some(count)) if count != shots => {
                fault("shots_per_frame", &count.to_string(), shots.to_string())
            }
            _ => Ok(()),
        }
    }

    /// Least and largest value of what is known of the scenes, by key of the scenario.
    pub fn ranges(&self) -> Vec<(&'static str, [f64; 2])> {
        let range = |of: fn(&Scene) -> f64| {
            let values = || self.scenes.iter().map(of);
            [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
        };
        let mut ranges = vec![("target.distance_m", range(|scene| scene.distance_m))];
        if self.knows_light {
            ranges.push(("target.reflectance", range(|scene| scene.reflectance)));
            ranges.push(("ambient.irradiance_w_m2_nm", range(|scene| scene.irradiance_w_m2_nm)));
        }
        ranges
    }
}

/// The counts of a table, one row at least.
fn counts(path: &Path, columns: &ParquetColumns, size: &Params) -> Result<Vec<Histogram>> {
    let found = columns.names().iter().filter(|name| is_bin(name)).count();
    if found > size.bins {
        let expected = format!(
            "expected {}, b0 to b{}: a column for each bin of the scenario's histogram",
            size.bins,
            size.last_bin()
        );
        return Err(Input::new(path.display(), expected).field("bins").value(found).into());
    }
    let mut histograms: Vec<Histogram> = Vec::new();
    for bin in 0..size.bins {
        let name = format!("b{bin}");
        let values = columns.numbers(&name)?;
        if bin == 0 {
            histograms = vec![vec![0; size.bins]; values.len()];
        }
        for (row, (histogram, value)) in paired(path, &mut histograms, values)?.enumerate() {
            let count = value as u32;
            if f64::from(count) != value || u64::from(count) > size.most_hits() {
                let field = format!("row {row}, column {name}");
                let expected = count_range(size);
                return Err(Input::new(path.display(), expected).field(field).value(value).into());
            }
            histogram[bin] = count;
        }
    }
    if histograms.is_empty() {
        return Err(Input::new(path.display(), "no rows; expected one histogram at least").into());
    }
    for (row, histogram) in histograms.iter().enumerate() {
        let total: u64 = histogram.iter().map(|&count| u64::from(count)).sum();
        let most = size.most_hits();
        if total > most {
            let expected = format!("the estimator's bit widths allow {most} hits in all");
            let fault = Input::new(path.display(), expected);
            return Err(fault.field(format!("total of row {row}")).value(total).into());
        }
    }
    Ok(histograms)
}

/// Returns whether a column is named as that of a bin.
fn is_bin(name: &str) -> bool {
    name.strip_prefix('b').is_some_and(|number| number.parse::<u32>().is_ok())
}

/// A table with its truth.
fn parquet(path: &Path, size: &Params) -> Result<Labelled> {
    ParquetColumns::with(path, |columns| {
        let histograms = counts(path, columns, size)?;
        let names = columns.names();
        let knows_light = TRUTH[1..].iter().all(|name| names.iter().any(|known| known == name));
        let places = pixel_places::of_table(columns)?;
        let mut truth = vec![[0.0; 3]; histograms.len()];
        for (place, name) in TRUTH.iter().enumerate().take(if knows_light { 3 } else { 1 }) {
            for (numbers, value) in paired(path, &mut truth, columns.numbers(name)?)? {
                numbers[place] = value;
            }
        }
        let labelled = labelled(path, histograms, &truth, (knows_light, places))?;
        Ok(labelled.described(columns.metadata(KEY).unwrap_or_default()))
    })
}

/// Arrays of histograms, and of true distances alone or with reflectances and irradiances; `places` are the columns with
/// row and column of a pixel.
fn of_arrays(
    path: &Path,
    truth: &Path,
    places: Option<[usize; 2]>,
    size: &Params,
) -> Result<Labelled> {
    let histograms = histogram_file::open(path, *size)?.collect::<Result<Vec<_>>>()?;
    let (width, numbers) = numbers(truth)?;
    let places = places.filter(|places| places.iter().all(|&column| column < width));
    let places = places.map(|[row, column]| {
        numbers.chunks(width).map(|numbers| [numbers[row], numbers[column]]).collect()
    });
    let rows: Vec<[f64; 3]> = numbers
        .chunks(width)
        .map(|row| std::array::from_fn(|k| if width > 2 { row[k] } else { [row[0], 0.0, 0.0][k] }))
        .collect();
    if rows.len() != histograms.len() {
        let expected =
            format!("{} rows, expected {} as in {}", rows.len(), histograms.len(), path.display());
        return Err(Input::new(truth.display(), expected).into());
    }
    labelled(truth, histograms, &rows, (width > 2, places))
}

/// Histograms with a truth that makes sense, and with the places of pixels, whose distance may be unknown.
fn labelled(
    path: &Path,
    histograms: Vec<Histogram>,
    truth: &[[f64; 3]],
    (knows_light, places): (bool, Option<Vec<[f64; 2]>>),
) -> Result<Labelled> {
    let is_wrong = |k: usize, value: f64| {
        let may_be_unknown = k == 0 && places.is_some();
        !((0.0..=f64::MAX).contains(&value) || may_be_unknown && value.is_nan())
    };
    for (row, numbers) in truth.iter().enumerate() {
        let mut named = TRUTH.iter().zip(numbers).enumerate();
        if let Some((_, (name, value))) = named.find(|(k, (_, value))| is_wrong(*k, **value)) {
            let field = format!("row {row}, column {name}");
            return Err(Input::new(path.display(), "expected a number from 0")
                .field(field)
                .value(value)
                .into());
        }
    }
    let scene = |&[distance_m, reflectance, irradiance_w_m2_nm]: &[f64; 3]| Scene {
        distance_m,
        reflectance,
        irradiance_w_m2_nm,
        ..Scene::default()
    };
    let mut scenes: Vec<_> = truth.iter().map(scene).collect();
    let assign = |places: Vec<_>| pixel_places::assign(path, &mut scenes, &places);
    let array = places.map(assign).transpose()?;
    Ok(Labelled { histograms, scenes, array, knows_light, ..Labelled::default() })
}

/// Each row with its number of a column.
fn paired<'a, R>(
    path: &Path,
    rows: &'a mut [R],
    column: Vec<f64>,
) -> Result<impl Iterator<Item = (&'a mut R, f64)> + use<'a, R>> {
    if rows.len() != column.len() {
        let expected = "unreadable Parquet: columns of different lengths";
        return Err(Input::new(path.display(), expected).into());
    }
    Ok(rows.iter_mut().zip(column))
}
