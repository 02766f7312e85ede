//! The budget as a table.

use tofsim::optics::Budget;
use tofsim::optics::eye_safety::Exposure;

use crate::text::table::{grouped, number_or_dash, plain};

use super::findings::Findings;

type BudgetRow = [String; 3];

/// Returns the table.
pub fn table(findings: &Findings) -> String {
    plain(rows(findings))
}

/// Rows of what is found: light, shot, laser, verdicts; what, how much, and what that means.
pub fn rows(findings: &Findings) -> Vec<BudgetRow> {
    let setup = &findings.setup;
    let (budget, target) = (&setup.budget, &setup.scenario.target);
    let mut light = vec![
        row("distance", format!("{} m", target.distance_m), flight(findings)),
        row("signal", format!("{:.4}", budget.signal_per_shot), "detected photons per shot"),
    ];
    light.extend(retro(budget));
    light.extend(air(budget));
    light.push(row("ambient", format!("{:.4e} /s", budget.ambient_rate_hz), "avalanches"));
    if budget.airlight_rate_hz > 0.0 {
        let rate = format!("{:.4e} /s", budget.airlight_rate_hz);
        light.push(row("airlight", rate, "avalanches, of ambient light that the air scatters"));
    }
    light.push(row("dark", format!("{:.4e} /s", budget.dark_rate_hz), "avalanches"));
    let average = format!("{:.2} mW", findings.a_frame.average_w * 1e3);
    let rate_mhz = 1e-6 / setup.laser_period_s();
    let laser = [
        row("pulse energy", format!("{:.1} pJ", budget.pulse_energy_j * 1e12), ""),
        row("average power", average, format!("at {rate_mhz:.3} MHz")),
    ];
    let light = light.into_iter().chain(shot(findings));
    light.chain(laser).chain(eye_safety(findings)).collect()
}

fn row(name: &str, value: impl Into<String>, meaning: impl Into<String>) -> BudgetRow {
    [name.to_owned(), value.into(), meaning.into()]
}

/// Returns the row of a retroreflecting patch, if there is one.
fn retro(budget: &Budget) -> Option<BudgetRow> {
    let photons = budget.retro_per_shot;
    (photons > 0.0).then(|| row("patch", format!("{photons:.4}"), "the same of the patch"))
}

/// Returns the rows of the air, if it scatters.
fn air(budget: &Budget) -> Vec<BudgetRow> {
    if budget.backscatter_per_shot == 0.0 && budget.transmission == 1.0 {
        return vec![];
    }
    let scattered = format!("{:.4}", budget.backscatter_per_shot);
    let passes = format!("{:.4}", budget.transmission);
    vec![
        row("backscatter", scattered, "the same of the air"),
        row("transmission", passes, "of the target's light, on both ways together"),
    ]
}

fn flight(findings: &Findings) -> String {
    let budget = &findings.setup.budget;
    let flight = format!("{:.1} ps of flight", budget.flight().fs() as f64 / 1e3);
    match findings.setup.scenario.laser.delay_ps {
        0.0 => flight,
        delay_ps => format!("{flight}, {delay_ps:.1} ps after the laser edge"),
    }
}

/// Returns the probabilities of a shot.
fn shot(findings: &Findings) -> Vec<BudgetRow> {
    let Some(chances) = &findings.chances else {
        return vec![row("any hit", "-", "known only where the first avalanche of a shot decides")];
    };
    let shots = f64::from(findings.setup.params.frame_ctrl.shots_per_frame);
    let counted = grouped((chances.counted * shots).round() as u64);
    let ratio = number_or_dash(chances.signal_to_noise(), 4);
    let four = |chance: f64| format!("{chance:.4}");
    vec![
        row("any hit", four(chances.hit), "probability that the TDC keeps one in a shot"),
        row("signal first", four(chances.signal_first), "probability that it is a laser photon's"),
        row(
            "counted",
            four(chances.counted),
            format!("hits per shot with a code, {counted} a frame"),
        ),
        row("signal-to-background", ratio, "counted laser hits per background hit"),
    ]
}

/// The verdict for one frame, for frames that repeat, and by eq. 3.3.
fn eye_safety(findings: &Findings) -> Vec<BudgetRow> {
    let verdict = |name: &str, exposure: &Exposure, what: String| {
        let verdict = match exposure.is_within() {
            Some(true) => "within",
            Some(false) => "above",
            None => "no limit",
        };
        let (average, limit) =
            (exposure.average_w * 1e3, exposure.limit_w.map(|limit| limit * 1e3));
        let limit = number_or_dash(limit, 2);
        row(name, verdict, format!("{average:.2} of {limit} mW, Class 1 {what}"))
    };
    let (design, a_frame, frames) =
        (&findings.at_the_optics_rate, &findings.a_frame, &findings.frames);
    let ms = |seconds: f64| format!("{:.3} ms", seconds * 1e3);
    let mut rows = vec![
        verdict("eye safety", a_frame, format!("for one frame, {}", ms(a_frame.exposure_s))),
        verdict("", frames, format!("for {} s of frames", frames.exposure_s)),
    ];
    if let (Some(false), Some(longest_s)) = (frames.is_within(), findings.longest_s()) {
        rows.push(row("", "within", format!("for {} of frames", ms(longest_s))));
    }
    let by_the_thesis = format!("for {} (eq. 3.3)", ms(design.exposure_s));
    rows.push(verdict("", design, by_the_thesis));
    rows
}
