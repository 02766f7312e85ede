//! The files of an evaluation: its JSON, its figures as CSV, and box plots.

use std::path::Path;

use tofsim::error::{Input, Result};
use tofsim::files::output::{create_directory, write_bytes};
use tofsim_learn::evaluation::{Figures, Group, thesis};

use super::box_plot;

const HEADER: &str = "estimator,by,value,estimates,failures,mean_mm,mean_error_mm,two_sd_mm,two_sd_error_mm,\
    least_mm,lower_quartile_mm,median_mm,upper_quartile_mm,largest_mm";

/// Puts them in a folder, which is made.
pub fn write(folder: &Path, json: &str, figures: &[Figures]) -> Result<()> {
    create_directory(folder)?;
    write_bytes(&folder.join("evaluation.json"), json)?;
    let csv = csv(figures).map_err(|error| Input::new("evaluation.csv", error.to_string()))?;
    write_bytes(&folder.join("evaluation.csv"), csv)?;
    for one in figures {
        for grouping in one.groupings() {
            let beside_mm: Option<fn(f64) -> f64> =
                (grouping.key == "distance_m").then_some(thesis::line_two_sd_mm);
            let line = beside_mm.map_or("", |_| "; red: 2 sd of the thesis's float network");
            let title = format!("{}: errors by {}{line}", one.name, grouping.quantity);
            let path = folder.join(format!("{}_by_{}.svg", one.name, grouping.key));
            let svg = box_plot::svg(&title, grouping.quantity, grouping.groups, beside_mm);
            let svg = svg.map_err(|why| Input::new(path.display(), why))?;
            write_bytes(&path, svg)?;
        }
    }
    Ok(())
}

/// A row for each estimator and group.
fn csv(figures: &[Figures]) -> csv::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(HEADER.split(','))?;
    for one in figures {
        for grouping in one.groupings() {
            for group in grouping.groups {
                table.write_record(record(one.name, grouping.key, group))?;
            }
        }
    }
    table.into_inner().map_err(|error| error.into_error().into())
}

fn record(estimator: &str, by: &str, group: &Group) -> Vec<String> {
    let spread = &group.spread;
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let mut record = vec![estimator.to_owned(), by.to_owned(), group.value.to_string()];
    record.extend([spread.estimates.to_string(), spread.failures.to_string()]);
    let moments = [spread.mean_mm, spread.mean_error_mm, spread.two_sd_mm, spread.two_sd_error_mm];
    record.extend(moments.map(number));
    record.extend((0..5).map(|k| number(spread.quartiles_mm.map(|five| five[k]))));
    record
}
