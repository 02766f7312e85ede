//! How exactly the instrument finds the distance, beside the Cramer-Rao bound.

use serde_json::Value;

use tofsim_learn::dataset::axis::thinned;

use crate::report::curves::{Curve, curves};

use crate::page::html::{escaped, table, wide_figure};

/// Most distances of the table.
const SHOWN: usize = 21;

fn mm(value: &Value) -> String {
    value.as_f64().map_or("-".to_owned(), |mm| format!("{mm:.2}"))
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

/// Tables and pictures; an error only if the plotting library fails.
pub fn section(evaluation: &Value) -> Result<String, String> {
    let bound = bound(evaluation);
    let at = |m: f64| bound.iter().find(|(known, _)| *known == m).map(|(_, mm)| *mm);
    let groups = |k: usize| {
        evaluation["estimators"][k]["by_distance_m"].as_array().cloned().unwrap_or_default()
    };
    let own = groups(0);
    let of = |groups: &[Value], key: &str| -> Vec<(f64, f64)> {
        let pair = |group: &Value| Some((group["value"].as_f64()?, group[key].as_f64()?));
        groups.iter().filter_map(pair).collect()
    };
    let distances: Vec<_> = own.iter().filter_map(|group| group["value"].as_f64()).collect();
    let shown = if bound.len() < distances.len() {
        bound.iter().map(|(m, _)| *m).collect()
    } else {
        thinned(&distances, SHOWN)
    };
    let row = |m: &f64| {
        let group = own.iter().find(|group| group["value"].as_f64() == Some(*m))?;
        let (two_sd, least) = (group["two_sd_mm"].as_f64(), at(*m));
        let times =
            two_sd.zip(least).map_or("-".to_owned(), |(own, least)| format!("{:.2}", own / least));
        let least = least.map_or("-".to_owned(), |mm| format!("{mm:.2}"));
        let far = format!("{} of {}", group["outliers"], group["estimates"]);
        Some([
            m.to_string(),
            mm(&group["two_sd_mm"]),
            least,
            times,
            mm(&group["mean_mm"]),
            far,
            group["failures"].to_string(),
        ])
    };
    let header = [
        "distance [m]",
        "2 sd [mm]",
        "Cramer-Rao bound [mm]",
        "times the bound",
        "mean error [mm]",
        "outliers",
        "failures",
    ];
    let rows: Vec<_> = shown.iter().filter_map(row).collect();
    let mut ratios: Vec<_> =
        of(&own, "two_sd_mm").iter().filter_map(|(m, mm)| Some(mm / at(*m)?)).collect();
    ratios.sort_by(f64::total_cmp);
    let median = ratios.get(ratios.len() / 2);
    let median = median.map_or(String::new(), |ratio| {
        format!(" In the median over the distances, 2 sd is {ratio:.2} times the Cramer-Rao bound.")
    });
    let all = &evaluation["estimators"][0]["all"];
    let words = format!(
        "<p>{} histograms, drawn afresh over {}. Over all: 2 sd {} mm, mean error {} mm, {} of {} estimates \
         further than {} mm from the truth, {} histograms without an estimate.{median}</p>\n",
        evaluation["rows"],
        grid(evaluation),
        mm(&all["two_sd_mm"]),
        mm(&all["mean_mm"]),
        all["outliers"],
        all["estimates"],
        evaluation["outlier_limit_mm"],
        all["failures"],
    );
    let named =
        |k: usize| evaluation["estimators"][k]["name"].as_str().unwrap_or("estimator").to_owned();
    let spread = of(&own, "two_sd_mm");
    let picture = curves(
        "2 sd by distance",
        "2 sd [mm]",
        true,
        &[
            Curve::new(&format!("{}, as the firmware computes it", named(0)), &spread),
            Curve::bound(&bound),
        ],
    )?;
    let mean = of(&own, "mean_mm");
    let means = curves(
        "Mean error by distance",
        "mean error [mm]",
        false,
        &[Curve::new(&named(0), &mean)],
    )?;
    Ok(words
        + &wide_figure(
            &picture,
            "Twice the standard deviation over all light and reflectances of the grid. The bound takes the light as unknown.",
        )
        + &wide_figure(&means, "The mean error, over the same.")
        + &table(&header, rows))
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
