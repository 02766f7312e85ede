//! An evaluation as tables, beside the thesis's, and as files: JSON, figures as CSV, and box plots.

use serde_json::Value;

use tofsim::error::Result;
use tofsim_learn::dataset::Grid;
use tofsim_learn::evaluation::thesis::{self, Published};
use tofsim_learn::evaluation::{Figures, Group, KeyGroups, SceneImages, Spread};

use crate::text::table::{fitted, number_or_dash, width};

use super::evaluation_files as files;
use super::sheet::NamedText;
use super::writer::Findings;

/// References that figures are compared with.
pub struct Beside<'a> {
    /// Distances to show; the thesis's own where its rows are shown too [m].
    pub distances_m: &'a [f64],
    /// The Cramer-Rao bound there [mm].
    pub bound_mm: &'a [Option<f64>],
    /// Whether the grid is the thesis's, so that its figures and its line are shown.
    pub thesis: bool,
}

/// Returns the figures of each estimator over all scenes, a row each.
pub fn overview(figures: &[Figures]) -> String {
    let row = |one: &Figures| {
        let Spread { mean_mm, two_sd_mm, quartiles_mm, .. } = one.all;
        let largest =
            quartiles_mm.map(|[least, .., most]| if -least > most { least } else { most });
        let all = one.all.estimates + one.all.failures;
        let [two_sd, mean, largest] = [two_sd_mm, mean_mm, largest].map(|mm| number_or_dash(mm, 2));
        let counts = [one.all.outliers, one.all.failures, all].map(|count| count.to_string());
        named(one.name, [two_sd, mean, largest].into_iter().chain(counts))
    };
    let header = ["2σ [mm]", "mean error", "largest error", "outliers", "failures", "of"];
    let rows: Vec<_> = figures.iter().map(row).collect();
    fitted(&named("all scenes", header.map(str::to_owned)), &rows, width()) + "\n"
}

/// Twice the standard deviation, the mean, the outliers and the failures at some distances, with the thesis's rows.
pub fn tables(figures: &[Figures], beside: &Beside) -> String {
    let Beside { distances_m, bound_mm, thesis } = beside;
    let published = |of: fn(&Published) -> [f64; 6]| {
        let row = |row: &Published| named(row.name, of(row).map(|mm| format!("{mm:.1}")));
        let rows = [&thesis::FLOAT, &thesis::FIXED, &thesis::PEAK].map(row).to_vec();
        if *thesis { rows } else { Vec::new() }
    };
    let measured = |cell: fn(&Spread) -> String| -> Vec<_> {
        let at = |one: &Figures, m: &f64| one.at(*m).map_or("-".to_owned(), cell);
        figures.iter().map(|one| named(one.name, distances_m.iter().map(|m| at(one, m)))).collect()
    };
    let two_sd = measured(|spread| with_error(spread.two_sd_mm, spread.two_sd_se_mm));
    let bound = named("Cramer-Rao bound", bound_mm.iter().map(|mm| number_or_dash(*mm, 2)));
    let bound = if bound_mm.is_empty() { Vec::new() } else { vec![bound] };
    let mean = measured(|spread| with_error(spread.mean_mm, spread.mean_se_mm));
    let failed =
        measured(|spread| format!("{} of {}", spread.failures, spread.estimates + spread.failures));
    let far = measured(|spread| format!("{} of {}", spread.outliers, spread.estimates));
    let trials = thesis::PEAK_TRIALS;
    let peak = thesis::PEAK_FAILURES.map(|failures| format!("{failures} of {trials}"));
    let peak = thesis.then(|| named("thesis, peak detection (Table 4.3)", peak));
    let tables = [
        ("2σ [mm]", [published(|row| row.two_sd_mm), two_sd, bound]),
        ("mean error [mm]", [published(|row| row.mean_mm), mean, Vec::new()]),
        ("outliers", [far, Vec::new(), Vec::new()]),
        ("failures", [failed, peak.into_iter().collect(), Vec::new()]),
    ];
    let text = |(title, rows): (&str, [Vec<Vec<String>>; 3])| {
        let header = named(title, distances_m.iter().map(|distance_m| format!("{distance_m} m")));
        fitted(&header, &rows.concat(), width()) + "\n"
    };
    tables.map(text).join("\n")
}

/// Returns the ratio of each estimator's spread to the line between those of the thesis's float network, over
/// all distances; nothing where scenes are not the thesis's.
pub fn beside_the_line(figures: &[Figures]) -> String {
    let row = |one: &Figures| {
        let above = format!("{} of {}", one.distances_above_the_line(), one.by_distance_m.len());
        let (ratio, distance_m) = (one.worst_ratio_to_thesis?, one.worst_distance_m?);
        Some(named(one.name, [format!("{ratio:.2}"), format!("{distance_m} m"), above]))
    };
    let rows: Vec<_> = figures.iter().filter_map(row).collect();
    let header = ["largest", "at", "above it at"].map(str::to_owned);
    let text = || fitted(&named("2σ over the thesis's line", header), &rows, width());
    if rows.is_empty() { String::new() } else { format!("\n{}\n", text()) }
}

/// The cells of a row that begins with a name.
fn named(name: &str, cells: impl IntoIterator<Item = String>) -> Vec<String> {
    [name.to_owned()].into_iter().chain(cells).collect()
}

fn with_error(value_mm: Option<f64>, error_mm: Option<f64>) -> String {
    let error = error_mm.filter(|_| value_mm.is_some());
    number_or_dash(value_mm, 2) + &error.map_or(String::new(), |error| format!(" +-{error:.2}"))
}

/// An evaluation, as it is printed and written.
pub struct EvaluationFindings<'a> {
    /// Contents of the JSON object.
    pub json: Value,
    /// The tables.
    pub text: String,
    /// Figures of each estimator.
    pub figures: &'a [Figures],
    /// The Cramer-Rao bound by distance, if the light is known [m, mm].
    pub bound: &'a [(f64, f64)],
    /// The grid, if histograms were drawn over one; over the thesis's its line is drawn.
    pub grid: Option<&'a Grid>,
}

impl Findings for EvaluationFindings<'_> {
    const SCHEMA: &'static str = "tofsim.evaluate/1";
    const FILE: Option<&'static str> = Some("evaluation.json");

    fn json(&self) -> Value {
        self.json.clone()
    }

    fn text(&self) -> String {
        self.text.clone()
    }

    fn sheets(&self) -> Vec<NamedText> {
        let mut sheets = vec![("evaluation.csv".to_owned(), files::groups(self.figures))];
        if self.figures.iter().any(|one| !one.by_pixel.is_empty()) {
            sheets.push(("pixels.csv".to_owned(), files::pixels(self.figures)));
        }
        if self.figures.iter().any(|one| !one.by_scene.is_empty()) {
            let scenes = files::scenes(self.figures, self.grid);
            sheets.push(("scenes.csv".to_owned(), scenes));
        }
        sheets
    }

    fn plots(&self) -> Result<Vec<NamedText>> {
        let is_thesis = self.grid.is_some_and(Grid::is_thesis);
        let mut plots = files::plots(self.figures, is_thesis)?;
        plots.extend(files::spread(self.figures, self.bound)?);
        Ok(plots)
    }
}

/// Errors by the grid's other keys, a table each.
pub fn setting_tables(figures: &[Figures]) -> String {
    let first = figures.first().map_or(&[][..], |one| &one.by_key);
    let text = |(k, KeyGroups { key, .. }): (usize, &KeyGroups)| {
        let rows = figures.iter().flat_map(|one| {
            one.by_key[k].groups.iter().map(move |Group { value, spread }| {
                vec![
                    one.name.to_owned(),
                    value.to_string(),
                    with_error(spread.two_sd_mm, spread.two_sd_se_mm),
                    with_error(spread.mean_mm, spread.mean_se_mm),
                    format!("{} of {}", spread.failures, spread.estimates + spread.failures),
                ]
            })
        });
        let header = ["estimator", key, "2σ [mm]", "mean error [mm]", "failures"];
        let rows: Vec<_> = rows.collect();
        format!("\n{}\n", fitted(&header.map(str::to_owned), &rows, width()))
    };
    first.iter().enumerate().map(text).collect()
}

/// Most scenes of an array that are printed.
const SHOWN_SCENES: usize = 20;

/// Returns the statistics of an array's depth images, a row for each scene and estimator.
pub fn image_table(figures: &[Figures]) -> String {
    let scenes = figures.first().map_or(0, |one| one.images.len());
    let row = |one: &Figures, of: &SceneImages| {
        let percent = |rate: Option<f64>| number_or_dash(rate.map(|rate| 100.0 * rate), 2);
        let measured = [percent(Some(of.fill_rate)), percent(of.flying_rate)];
        let errors = [of.root_mse_mm, of.bias_by_pixel_mm, of.sd_by_pixel_mm];
        let errors = errors.map(|mm| number_or_dash(mm, 2));
        let keys = of.keys.iter().map(|(key, value)| format!(", {key} = {value}"));
        let keys = keys.collect::<String>();
        let scene = format!("{}, {} W/m^2/nm{keys}", of.reflectance, of.irradiance_w_m2_nm);
        let scene = (scenes > 1).then_some(scene);
        named(one.name, measured.into_iter().chain(errors).chain(scene))
    };
    let shown = |k: usize| figures.iter().filter_map(move |one| Some((one, one.images.get(k)?)));
    let rows = (0..scenes.min(SHOWN_SCENES)).flat_map(shown);
    let rows: Vec<_> = rows.map(|(one, of)| row(one, of)).collect();
    let header = ["fill [%]", "flying [%]", "rms error [mm]", "bias by pixel", "sd by pixel"];
    let scene = (scenes > 1).then_some("reflectance, irradiance");
    let header = named("images", header.into_iter().chain(scene).map(str::to_owned));
    let more = match scenes.saturating_sub(SHOWN_SCENES) {
        0 => String::new(),
        more => format!("... and {more} more scenes\n"),
    };
    let text = || fitted(&header, &rows, width());
    if rows.is_empty() { String::new() } else { format!("\n{}\n{more}", text()) }
}

/// The scene in which each estimator has the largest mean error.
pub fn biased_scenes(figures: &[Figures]) -> String {
    let row = |one: &Figures| {
        let worst = one.most_biased_scene.as_ref()?;
        let keys = worst.keys.iter().map(|(key, value)| format!(", {key} = {value}"));
        let pixel = worst.pixel.map(|[row, column]| format!(", pixel {row},{column}"));
        // Of a pixel, it is no number that somebody has typed.
        let distance_m = match worst.pixel {
            Some(_) => format!("{:.4}", worst.distance_m),
            None => worst.distance_m.to_string(),
        };
        let scene = format!(
            "{distance_m} m, {}, {} W/m^2/nm{}{}",
            worst.reflectance,
            worst.irradiance_w_m2_nm,
            pixel.unwrap_or_default(),
            keys.collect::<String>()
        );
        let mean = with_error(Some(worst.mean_mm), Some(worst.mean_se_mm));
        Some(named(one.name, [mean, format!("of {}", worst.estimates), scene]))
    };
    let rows: Vec<_> = figures.iter().filter_map(row).collect();
    let header = named(
        "most biased scene",
        ["mean error [mm]", "", "distance, reflectance, irradiance"].map(str::to_owned),
    );
    let text = || fitted(&header, &rows, width());
    if rows.is_empty() { String::new() } else { format!("\n{}\n", text()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim_learn::dataset::Scene;
    use tofsim_learn::evaluation::thesis::DISTANCES_M;
    use tofsim_learn::evaluation::{EstimatorErrors, Evaluation};

    #[test]
    fn a_distance_that_was_not_drawn_has_no_figure() {
        let scene = Scene { distance_m: 0.2, reflectance: 0.3, ..Scene::default() };
        let errors_m = [-1.0, 1.0].map(|sign| Some(sign / 1e3 / 2f64.sqrt())).to_vec();
        let column = EstimatorErrors { name: "network", errors_m, ..EstimatorErrors::default() };
        let evaluation = Evaluation { scenes: vec![scene; 2], columns: vec![column.clone()] };
        let figures = Figures::new(&evaluation, &column, 0.1);
        let beside = Beside { distances_m: &DISTANCES_M, bound_mm: &[Some(0.5); 6], thesis: true };
        let text = tables(std::slice::from_ref(&figures), &beside);
        let row = text.lines().find(|line| line.trim_start().starts_with("network")).unwrap();
        assert_eq!(row.split_whitespace().collect::<Vec<_>>()[1..3], ["-", "2.00"]);
        assert!(text.contains("Table 6.5") && text.contains("2584 of 30000"));
        let text = beside_the_line(std::slice::from_ref(&figures));
        let row = text.lines().last().unwrap().split_whitespace().collect::<Vec<_>>();
        assert_eq!(row, ["network", "0.71", "0.2", "m", "0", "of", "1"]);
    }
}
