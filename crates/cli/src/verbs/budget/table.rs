//! The budget as a table.

use tofsim::optics::eye_safety::Exposure;

use crate::text::table::{grouped, number_or_dash, plain};

use super::Findings;

type Row = [String; 3];

pub(super) fn table(findings: &Findings) -> String {
    let setup = &findings.setup;
    let (budget, target) = (&setup.budget, &setup.scenario.target);
    let light = [
        row("distance", format!("{} m", target.distance_m), flight(findings)),
        row("signal", format!("{:.4}", budget.signal_per_shot), "detected photons per shot"),
        row("ambient", format!("{:.4e} /s", budget.ambient_rate_hz), "avalanches"),
        row("dark", format!("{:.4e} /s", budget.dark_rate_hz), "avalanches"),
    ];
    let rate_mhz = 1e-6 / setup.laser_period_s();
    let laser = [
        row("pulse energy", format!("{:.1} pJ", budget.pulse_energy_j * 1e12), ""),
        row(
            "average power",
            milliwatts(findings.a_frame.average_w),
            format!("at {rate_mhz:.3} MHz"),
        ),
    ];
    let rows = light.into_iter().chain(shot(findings)).chain(laser).chain(eye_safety(findings));
    plain(rows)
}

fn row(name: &str, value: impl Into<String>, meaning: impl Into<String>) -> Row {
    [name.to_owned(), value.into(), meaning.into()]
}

fn flight(findings: &Findings) -> String {
    format!("{:.1} ps of flight", findings.setup.budget.mean_arrival.fs() as f64 / 1e3)
}

/// What a shot can expect.
fn shot(findings: &Findings) -> Vec<Row> {
    let Some(chances) = &findings.chances else {
        return vec![row("any hit", "-", "shots depend on each other, or not on light: see `run`")];
    };
    let shots = f64::from(findings.setup.params.frame_ctrl.shots_per_frame);
    let counted = grouped((chances.counted * shots).round() as u64);
    let ratio = number_or_dash(chances.signal_to_noise(), 4);
    let four = |chance: f64| format!("{chance:.4}");
    vec![
        row("any hit", four(chances.hit), "chance that the TDC keeps one in a shot"),
        row("signal first", four(chances.signal_first), "chance that it is a laser photon's"),
        row(
            "counted",
            four(chances.counted),
            format!("hits per shot with a code, {counted} a frame"),
        ),
        row("signal to noise", ratio, "of these, laser photons' hits to one of the others"),
    ]
}

/// The verdict for one frame, for frames that repeat, and by eq. 3.3.
fn eye_safety(findings: &Findings) -> [Row; 3] {
    let verdict = |name: &str, exposure: &Exposure, what: String| {
        let verdict = match exposure.is_within() {
            Some(true) => "within Class 1",
            Some(false) => "above Class 1",
            None => "not in Table 3.1",
        };
        let (average, limit) = (milliwatts(exposure.average_w), exposure.limit_w.map(milliwatts));
        row(name, verdict, format!("{average} of {}, {what}", limit.unwrap_or("-".into())))
    };
    let (design, a_frame, frames) =
        (&findings.at_the_optics_rate, &findings.a_frame, &findings.frames);
    let ms = |exposure: &Exposure| format!("{:.3} ms", exposure.exposure_s * 1e3);
    let longest = match (frames.is_within(), findings.longest_s()) {
        (Some(false), Some(longest_s)) => format!(" (within for {:.1} ms)", longest_s * 1e3),
        _ => String::new(),
    };
    [
        verdict("eye safety", a_frame, format!("one frame, {}", ms(a_frame))),
        verdict("", frames, format!("frames repeated for {} s{longest}", frames.exposure_s)),
        verdict("", design, format!("eq. 3.3, {} at the optics' rate", ms(design))),
    ]
}

fn milliwatts(watts: f64) -> String {
    format!("{:.2} mW", watts * 1e3)
}
