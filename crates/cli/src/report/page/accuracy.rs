//! Accuracy of the instrument, with the Cramer-Rao bound for comparison.

use serde_json::Value;

use tofsim::error::Result;
use tofsim_learn::dataset::axis::thinned;

use crate::report::curves::{Curve, curves};

use crate::page::html::{escaped, table, wide_figure};
use crate::text::table::number_or_dash;

/// Most distances of the table.
const SHOWN: usize = 21;

fn mm(value: &Value) -> String {
    number_or_dash(value.as_f64(), 2)
}

/// The bound at each distance [mm]: at those of the thesis, or at all.
fn bound(evaluation: &Value) -> Vec<(f64, f64)> {
    let distances = match &evaluation["distances_m"] {
        Value::Null => &evaluation["thesis"]["distances_m"],
        own => own,
    };
    let bounds = evaluation["cramer_rao_two_sd_mm"].as_array();
    let pairs = distances.as_array().into_iter().flatten().zip(bounds.into_iter().flatten());
    pairs.filter_map(|(m, mm)| Some((m.as_f64()?, mm.as_f64()?))).collect()
}

/// Returns tables and pictures; an error only if the plotting library fails.
pub fn section(evaluation: &Value) -> Result<String> {
    let own = evaluation["estimators"][0]["by_distance_m"].as_array();
    let accuracy =
        Accuracy { evaluation, groups: own.map_or(&[], Vec::as_slice), bound: bound(evaluation) };
    Ok(accuracy.words() + &accuracy.pictures()? + &accuracy.table())
}

/// The errors of the first estimator by distance, and the bound.
struct Accuracy<'a> {
    evaluation: &'a Value,
    groups: &'a [Value],
    /// Distance, and the bound there [m, mm].
    bound: Vec<(f64, f64)>,
}

impl Accuracy<'_> {
    /// A figure at each distance [m, mm].
    fn figure(&self, key: &str) -> Vec<(f64, f64)> {
        let pair = |group: &Value| Some((group["value"].as_f64()?, group[key].as_f64()?));
        self.groups.iter().filter_map(pair).collect()
    }

    /// The bound at a distance [mm].
    fn bound_at(&self, m: f64) -> Option<f64> {
        self.bound.iter().find(|(known, _)| *known == m).map(|(_, mm)| *mm)
    }

    fn words(&self) -> String {
        let evaluation = self.evaluation;
        let spread = self.figure("two_sd_mm");
        let ratio = |(m, mm): &(f64, f64)| Some(mm / self.bound_at(*m)?);
        let mut ratios: Vec<_> = spread.iter().filter_map(ratio).collect();
        ratios.sort_by(f64::total_cmp);
        let median = ratios.get(ratios.len() / 2).map_or(String::new(), |ratio| {
            format!(
                " In the median over the distances, 2σ is {ratio:.2} times the Cramer-Rao bound."
            )
        });
        let all = &evaluation["estimators"][0]["all"];
        format!(
            "<p>{} histograms, drawn afresh over {}. Over all: 2σ {} mm, mean error {} mm, {} of {} estimates \
             further than {} mm from the truth, {} histograms without an estimate.{median}</p>\n",
            evaluation["rows"],
            grid(evaluation),
            mm(&all["two_sd_mm"]),
            mm(&all["mean_mm"]),
            all["outliers"],
            all["estimates"],
            evaluation["outlier_limit_mm"],
            all["failures"],
        )
    }

    fn pictures(&self) -> Result<String> {
        let name = self.evaluation["estimators"][0]["name"].as_str().unwrap_or("estimator");
        let (spread, mean) = (self.figure("two_sd_mm"), self.figure("mean_mm"));
        let in_firmware = format!("{name}, as the firmware computes it");
        let lines = [Curve::new(&in_firmware, &spread), Curve::bound(&self.bound)];
        let picture = curves("2σ by distance", "2σ [mm]", true, &lines)?;
        let lines = [Curve::new(name, &mean)];
        let means = curves("Mean error by distance", "mean error [mm]", false, &lines)?;
        Ok(wide_figure(
            &picture,
            "Twice the standard deviation over all light and reflectances of the grid. The bound takes the light as unknown.",
        ) + &wide_figure(&means, "The mean error, over the same."))
    }

    fn table(&self) -> String {
        let values = || self.groups.iter().filter_map(|group| group["value"].as_f64());
        let shown = match values().collect::<Vec<_>>() {
            all if self.bound.len() < all.len() => self.bound.iter().map(|(m, _)| *m).collect(),
            all => thinned(&all, SHOWN),
        };
        let row = |m: &f64| {
            let group = self.groups.iter().find(|group| group["value"].as_f64() == Some(*m))?;
            let (two_sd, least) = (group["two_sd_mm"].as_f64(), self.bound_at(*m));
            let times = two_sd.zip(least).map(|(own, least)| own / least);
            let [least, times] = [least, times].map(|number| number_or_dash(number, 2));
            let far = format!("{} of {}", group["outliers"], group["estimates"]);
            let [two_sd, mean] = ["two_sd_mm", "mean_mm"].map(|key| mm(&group[key]));
            Some([m.to_string(), two_sd, least, times, mean, far, group["failures"].to_string()])
        };
        let header = [
            "distance [m]",
            "2σ [mm]",
            "Cramer-Rao bound [mm]",
            "times the bound",
            "mean error [mm]",
            "outliers",
            "failures",
        ];
        table(&header, shown.iter().filter_map(row).collect::<Vec<_>>())
    }
}

/// The scenes in words.
fn grid(evaluation: &Value) -> String {
    let axes = evaluation["grid"]["axes"].as_array();
    let axis = |axis: &Value| {
        let text = |key: &str| axis[key].as_str().unwrap_or_default().to_owned();
        format!("{} {}", text("key"), text("values"))
    };
    match axes {
        None => {
            "the thesis's test grid: 0.1 to 0.6 m, reflectances from 8 to 60 %, 0 to 0.4 W/m^2/nm"
                .to_owned()
        }
        Some(axes) => escaped(&axes.iter().map(axis).collect::<Vec<_>>().join(", ")),
    }
}
