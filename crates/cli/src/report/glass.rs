//! The calibration of a cover window's light: a table, the template as a file, and a picture.

use plotters::prelude::*;
use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::scenario::glass::HEADER;
use tofsim_learn::calibration::glass::GlassCalibration;

use crate::text::svg::{chart, legend, picture};
use crate::text::table;

use super::sheet::Digits::{Fixed, Scientific};
use super::sheet::{NamedText, Sheet};
use super::writer::Findings;

/// Key of the scenario that takes the template.
const KEY: &str = "estimator.glass_file=glass.csv";

/// A calibration, and the shots of each histogram that it is from.
pub struct GlassFindings {
    /// The template and its figures.
    pub calibration: GlassCalibration,
    /// Shots of each histogram.
    pub shots: u64,
}

impl Findings for GlassFindings {
    const SCHEMA: &'static str = "tofsim.glass_calibration/1";
    const FILE: Option<&'static str> = Some("calibration.json");

    fn json(&self) -> Value {
        let found = &self.calibration;
        let bin = |(code, bin): (usize, &tofsim::scenario::glass::GlassBin)| {
            json!({
                "code": code,
                "from_ps": bin.from_ps,
                "until_ps": bin.until_ps,
                "hazard": bin.hazard,
                "hazard_se": bin.hazard_se,
            })
        };
        json!({
            "shots": self.shots,
            "histograms": found.histograms,
            "hits": found.hits,
            "photons_per_shot": found.photons[0],
            "photons_per_shot_se": found.photons[1],
            "relative_se": found.relative_se(),
            "mean_delay_ps": found.delay_ps[0],
            "width_ps": found.delay_ps[1],
            "from_ps": found.support_ps[0],
            "until_ps": found.support_ps[1],
            "ambient_per_ps": found.ambient_per_ps[0],
            "ambient_per_ps_se": found.ambient_per_ps[1],
            "change": found.change.map(|[change, _]| change),
            "change_se": found.change.map(|[_, se]| se),
            "keys": [KEY],
            "template": found.template.bins().iter().enumerate().map(bin).collect::<Vec<_>>(),
        })
    }

    /// The table, and the key to set.
    fn text(&self) -> String {
        let found = &self.calibration;
        let [photons, se] = found.photons;
        let [rate, rate_se] = found.ambient_per_ps.map(|per_ps| 1e12 * per_ps);
        let change = found.change.map_or("-".to_owned(), |[change, se]| {
            format!("{:+.2} +- {:.2} %", 100.0 * change, 100.0 * se)
        });
        let row = |name: &str, value: String| [name.to_owned(), value];
        let rows = [
            row("hits", found.hits.to_string()),
            row("pedestal photons per shot", format!("{photons:.5} +- {se:.5}")),
            row("relative standard error", format!("{:.2} %", 100.0 * found.relative_se())),
            row("mean delay from the laser edge", format!("{:.1} ps", found.delay_ps[0])),
            row("width (standard deviation)", format!("{:.1} ps", found.delay_ps[1])),
            row("pedestal", format!("{:.0} to {:.0} ps", found.support_ps[0], found.support_ps[1])),
            row("ambient light and dark counts", format!("{rate:.4e} +- {rate_se:.1e} /s")),
            row("change over the histograms", change),
        ];
        format!(
            "{} of {} shots\n\n{}\n\nTo take:\n  {KEY}\n",
            table::counted(found.histograms as u64, "histograms"),
            self.shots,
            table::plain(&rows)
        )
    }

    /// The template, as `estimator.glass_file` reads it.
    fn sheets(&self) -> Vec<NamedText> {
        let rows: Vec<_> = self.calibration.template.bins().iter().enumerate().collect();
        let [code, from, until, hazard, hazard_se] = HEADER;
        let glass = Sheet::of(&rows)
            .column(code, Fixed(0), |(code, _)| *code as f64)
            .column(from, Fixed(3), |(_, bin)| bin.from_ps)
            .column(until, Fixed(3), |(_, bin)| bin.until_ps)
            .column(hazard, Scientific(6), |(_, bin)| bin.hazard)
            .column(hazard_se, Scientific(3), |(_, bin)| bin.hazard_se);
        vec![glass.file("glass.csv")]
    }

    fn plots(&self) -> Result<Vec<NamedText>> {
        Ok(vec![("glass.svg".to_owned(), svg(&self.calibration)?)])
    }
}

/// Draws the hazard of each bin with its standard error, and the template.
fn svg(found: &GlassCalibration) -> Result<String> {
    let [from_ps, until_ps] = found.support_ps;
    let (from_ps, until_ps) = (from_ps - 100.0, until_ps + 0.5 * (until_ps - from_ps));
    let points: Vec<_> =
        found.measured.iter().filter(|bin| bin.middle_ps() < until_ps).copied().collect();
    let most = points.iter().map(|bin| bin.hazard + bin.hazard_se).fold(0.0, f64::max);
    let template: Vec<_> = found
        .template
        .bins()
        .iter()
        .filter(|bin| bin.until_ps > bin.from_ps && bin.middle_ps() < until_ps)
        .flat_map(|bin| [(bin.from_ps, bin.hazard), (bin.until_ps, bin.hazard)])
        .collect();
    let title = format!("Light of the cover window, from {} histograms", found.histograms);
    let blue = RGBColor(43, 108, 176);
    picture(|canvas| {
        let mut chart = chart(canvas, &title)
            .build_cartesian_2d(from_ps..until_ps, -0.05 * most..1.2 * most)?;
        chart
            .configure_mesh()
            .x_desc("time from the laser edge [ps]")
            .y_desc("photons per shot in the bin, without ambient light")
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .draw()?;
        let bars = points.iter().map(|bin| {
            let ends = [bin.hazard - bin.hazard_se, bin.hazard + bin.hazard_se];
            PathElement::new(ends.map(|end| (bin.middle_ps(), end)), BLACK.mix(0.5))
        });
        chart.draw_series(bars)?;
        let dots = points.iter().map(|bin| (bin.middle_ps(), bin.hazard));
        chart
            .draw_series(dots.map(|at| Circle::new(at, 2, BLACK.mix(0.6).filled())))?
            .label("bins, and one standard error")
            .legend(|(x, y)| Circle::new((x + 6, y), 2, BLACK.mix(0.6).filled()));
        chart
            .draw_series(LineSeries::new(template, blue.stroke_width(2)))?
            .label("template")
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 12, y)], blue));
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    })
}
