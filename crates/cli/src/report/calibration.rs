//! The calibration of the pulse: a table, keys to set, a file and a picture.

use plotters::prelude::*;
use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::kernel::pulse::Pulse;
use tofsim_learn::calibration::candidates::{Calibration, Candidate, Kind};

use crate::text::svg::{chart, legend, picture};
use crate::text::table;

use super::sheet::Digits::{Fixed, Scientific};
use super::sheet::{NamedText, Sheet};
use super::writer::Findings;

/// Interval between rows of the file, of a pulse with a formula [ps].
const FILE_STEP_PS: f64 = 5.0;
/// Points of a line in the picture.
const POINTS: usize = 600;

fn name(kind: Kind) -> &'static str {
    match kind {
        Kind::Scenario => "scenario",
        Kind::Gaussian => "gaussian",
        Kind::Tail => "tail",
        Kind::Samples => "samples",
    }
}

/// Keys of the scenario that make a pulse its own; a measured one is in a file.
fn keys(candidate: &Candidate) -> Vec<String> {
    match &candidate.pulse {
        Pulse::Gaussian { sigma_ps } => {
            vec![format!("laser.pulse_sigma_ps={sigma_ps:.2}"), "laser.pulse_tail_ps=0".to_owned()]
        }
        Pulse::Tailed { sigma_ps, tail_ps } => vec![
            format!("laser.pulse_sigma_ps={sigma_ps:.2}"),
            format!("laser.pulse_tail_ps={tail_ps:.2}"),
        ],
        Pulse::Sampled(_) => vec!["laser.pulse_file=pulse.csv".to_owned()],
    }
}

/// A calibration, and the shots of each histogram that it is from.
pub struct PulseFindings {
    /// The pulses that were fitted.
    pub calibration: Calibration,
    /// Shots of each histogram.
    pub shots: u64,
}

impl Findings for PulseFindings {
    const SCHEMA: &'static str = "tofsim.calibration/1";
    const FILE: Option<&'static str> = Some("calibration.json");

    fn json(&self) -> Value {
        let calibration = &self.calibration;
        let candidate = |candidate: &Candidate| {
            let (width, goodness) = (candidate.width, candidate.goodness);
            json!({
                "shape": name(candidate.kind),
                "deviation_ps": candidate.pulse.sigma_ps(),
                "sigma_ps": width.map(|width| width.sigma_ps),
                "sigma_se_ps": width.map(|width| width.sigma_se_ps),
                "tail_ps": width.map(|width| width.tail_ps),
                "tail_se_ps": width.map(|width| width.tail_se_ps),
                "is_tail_seen": width.map(|width| width.is_tail_seen),
                "most_tail_ps": width.map(|width| width.most_tail_ps),
                "log_likelihood": candidate.log_likelihood,
                "chi_square": goodness.chi_square,
                "degrees_of_freedom": goodness.degrees_of_freedom,
                "chance": goodness.chance,
            })
        };
        let taken = calibration.taken();
        let samples = taken.sampled.as_ref().map(|sampled| {
            let rows = sampled.times_ps.iter().zip(&sampled.density).zip(&sampled.density_se);
            let row = |((time_ps, density), se): ((&f64, &f64), &f64)| {
                json!({ "time_ps": time_ps, "density_per_ps": density, "density_se_per_ps": se })
            };
            rows.map(row).collect::<Vec<_>>()
        });
        json!({
            "shots": self.shots,
            "histograms": calibration.used,
            "without_echo": calibration.left_out,
            "pulses": calibration.candidates.iter().map(candidate).collect::<Vec<_>>(),
            "taken": name(taken.kind),
            "keys": keys(taken),
            "samples": samples,
        })
    }

    /// The table, and the keys to set.
    fn text(&self) -> String {
        let PulseFindings { calibration, shots } = self;
        let best = calibration.candidates.iter().map(|candidate| candidate.log_likelihood);
        let best = best.fold(f64::NEG_INFINITY, f64::max);
        let table = Sheet::of(&calibration.candidates)
            .words("pulse", |one| name(one.kind))
            .words("sigma [ps]", |one| parts(one)[0].clone())
            .words("tail [ps]", |one| parts(one)[1].clone())
            .words("log L", |one| table::fixed(one.log_likelihood - best, 1))
            .words("chi2 / dof", |Candidate { goodness, .. }| {
                format!("{:.3}", goodness.chi_square / goodness.degrees_of_freedom)
            })
            .words("probability", |one| match one.goodness.chance {
                chance if chance < 1e-4 => "< 0.0001".to_owned(),
                chance => format!("{chance:.4}"),
            })
            .table();
        let taken = calibration.taken();
        let whole_ps = taken.pulse.sigma_ps();
        let left_out = match calibration.left_out {
            0 => String::new(),
            more => format!(", {more} more have no echo"),
        };
        format!(
            "{} of {shots} shots{left_out}\n\n{table}\n\nTo take: {}, standard deviation of the whole \
             {whole_ps:.1} ps\n  {}\n",
            table::counted(calibration.used as u64, "histograms"),
            name(taken.kind),
            keys(taken).join("\n  ")
        )
    }

    /// The pulse to take, as `laser.pulse_file` reads it.
    fn sheets(&self) -> Vec<NamedText> {
        let taken = self.calibration.taken();
        let rows: Vec<_> = match &taken.sampled {
            Some(sampled) => {
                sampled.times_ps.iter().copied().zip(sampled.density.clone()).collect()
            }
            None => {
                let ends_ps = taken.pulse.ends_ps().map(|ps| (ps / FILE_STEP_PS).round() as i64);
                let times = (ends_ps[0] - 1..=ends_ps[1] + 1).map(|k| k as f64 * FILE_STEP_PS);
                times.map(|t_ps| (t_ps, taken.pulse.density(t_ps))).collect()
            }
        };
        let pulse = Sheet::of(&rows).column("time_ps", Fixed(4), |(time_ps, _)| *time_ps).column(
            "density",
            Scientific(6),
            |(_, density)| *density,
        );
        vec![pulse.file("pulse.csv")]
    }

    fn plots(&self) -> Result<Vec<NamedText>> {
        Ok(vec![("pulse.svg".to_owned(), svg(&self.calibration)?)])
    }
}

/// Sigma and tail, with standard errors where they are fitted.
fn parts(candidate: &Candidate) -> [String; 2] {
    let Some(width) = candidate.width else {
        return match &candidate.pulse {
            Pulse::Gaussian { sigma_ps } => [format!("{sigma_ps:.2}"), "-".to_owned()],
            Pulse::Tailed { sigma_ps, tail_ps } => {
                [format!("{sigma_ps:.2}"), format!("{tail_ps:.2}")]
            }
            Pulse::Sampled(_) => ["-".to_owned(), "-".to_owned()],
        };
    };
    let sigma = format!("{:.2} +- {:.2}", width.sigma_ps, width.sigma_se_ps);
    let tail = match candidate.kind {
        Kind::Tail if !width.is_tail_seen => {
            format!("below {:.0} (95 %)", width.most_tail_ps)
        }
        Kind::Tail => format!("{:.2} +- {:.2}", width.tail_ps, width.tail_se_ps),
        _ => "-".to_owned(),
    };
    [sigma, tail]
}

/// Draws the pulse in the bins, the pulse to take and the scenario's.
fn svg(calibration: &Calibration) -> Result<String> {
    let (taken, assumed) = (calibration.taken(), &calibration.candidates[0].pulse);
    let [from_ps, until_ps] = taken.pulse.ends_ps().map(|ps| 1.15 * ps);
    let line = |pulse: &Pulse| -> Vec<(f64, f64)> {
        let at = |k: usize| from_ps + (until_ps - from_ps) * k as f64 / POINTS as f64;
        (0..=POINTS).map(|k| (at(k), 1e3 * pulse.density(at(k)))).collect()
    };
    let lines = [line(&taken.pulse), line(assumed)];
    let most = lines.iter().flatten().map(|point| point.1).fold(0.0, f64::max);
    let within = |point: &&[f64; 3]| {
        let [t_ps, density, se] = **point;
        (from_ps..=until_ps).contains(&t_ps) && 1e3 * (density.abs() + se) < 1.3 * most
    };
    let points: Vec<_> = calibration.shown.iter().filter(within).copied().collect();
    let title = format!("The pulse, from {} histograms", calibration.used);
    let blue = RGBColor(43, 108, 176);
    picture(|canvas| {
        let mut chart = chart(canvas, &title)
            .build_cartesian_2d(from_ps..until_ps, -0.05 * most..1.2 * most)?;
        chart
            .configure_mesh()
            .x_desc("time from the mean arrival [ps]")
            .y_desc("density [1/ns]")
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .draw()?;
        let bars = points.iter().map(|[t_ps, density, se]| {
            let ends = [(*t_ps, 1e3 * (density - se)), (*t_ps, 1e3 * (density + se))];
            PathElement::new(ends, BLACK.mix(0.5))
        });
        chart.draw_series(bars)?;
        let dots = points.iter().map(|[t_ps, density, _]| (*t_ps, 1e3 * density));
        chart
            .draw_series(dots.map(|at| Circle::new(at, 2, BLACK.mix(0.6).filled())))?
            .label("bins, and one standard error")
            .legend(|(x, y)| Circle::new((x + 6, y), 2, BLACK.mix(0.6).filled()));
        let [fitted, assumed] = lines;
        chart
            .draw_series(DashedLineSeries::new(assumed, 6, 4, RED.mix(0.7).stroke_width(2)))?
            .label("the scenario's pulse")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 12, y)], RED.mix(0.7)));
        chart
            .draw_series(LineSeries::new(fitted, blue.stroke_width(2)))?
            .label(format!("to take: {}", name(taken.kind)))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 12, y)], blue));
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    })
}
