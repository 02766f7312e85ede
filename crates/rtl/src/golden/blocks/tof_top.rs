//! The whole firmware: a scenario as it is, or short frames under control signals that change at
//! random, also in the middle of a frame, and abandon some.

use tofsim::firmware::tof_top::{CodeSource, Pins};
use tofsim::scenario::Control;

use crate::golden::configuration;
use crate::golden::prelude::*;
use crate::golden::top;

mod control;

use control::{PLANTED, RANDOM, control, judges_mode};

pub(super) const SPEC: Spec = Spec {
    timing: timing::OWN_WITH_RESET,
    fast: &[
        "laser_on_lvds_p",
        "laser_on_lvds_n",
        "laser_on",
        "rst_laser",
        "reset_sync_laser.rst_sync",
        "reset_sync_laser.meta",
        "vcsel_driver.fire_last",
        "vcsel_driver.pulse_0",
        "vcsel_driver.pulse_1",
        "vcsel_driver.laser_pulse",
        "vcsel_driver.stretch",
        "vcsel_driver.laser_on",
        "vcsel_driver.ddr_output.q",
        "vcsel_driver.ddr_output.second",
        "lvds_output.o",
        "lvds_output.ob",
    ],
    configurations: &[NEURONS_16, COUNT_STAGES_2, REORDERED, CALIBRATED, CLOCKS, CENTROID, LIKELIHOOD, GLASS, TWO, CODES, HISTOGRAM, TWO_BANKS, ONE_BANK, OWN_EDGES, OWN_CHAINS],
    model: Some(Model {
        // It is looked at once its clocks run.
        settle: |at| at.top.pll.locked = true,
        ..Model::new::<Pins>(|at| {
            at.top.pins = Pins { tdc_stop: at.top.pins.tdc_stop, ..at.input() };
            match at.edge {
                Edge::Rise => {
                    let taps = at.taps();
                    at.top.rise(at.params, taps)
                },
                Edge::Middle => at.top.rise_laser(at.params),
                Edge::Fall => at.top.fall_laser(),
            }
        })
    }),
    ..Spec::new("tof_top", "", record)
};

/// The other estimator, with values of its own.
const CENTROID: Configuration = Configuration {
    name: "centroid",
    set: super::centroid_estimator::LEVEL.set,
    parameters: &["Estimator", "HalfWidth", "Background", "Slope", "Offset"],
    module: Some(super::CENTROID),
    ..configuration::DEFAULTS
};

/// The one without training.
const LIKELIHOOD: Configuration = Configuration {
    name: "likelihood",
    set: &["estimator.kind=likelihood", "laser.pulse_sigma_ps=100"],
    parameters: &["Estimator", "BoxBins", "BinsBefore", "Kappa", "EdgesFile", "PulseFile"],
    module: Some(super::LIKELIHOOD),
    ..configuration::DEFAULTS
};

/// The same where it knows of a cover glass.
const GLASS: Configuration = Configuration {
    name: "glass",
    parameters: &["Estimator", "GlassBins", "GlassLight", "GlassFile"],
    module: Some("likelihood_glass"),
    has_glass: true,
    ..LIKELIHOOD
};

/// The same where it finds two targets.
const TWO: Configuration = Configuration {
    name: "two",
    set: &["estimator.kind=likelihood", "laser.pulse_sigma_ps=100", "estimator.targets=2"],
    parameters: &["Estimator", "Targets", "ProgramFile"],
    module: Some("likelihood_pair"),
    ..LIKELIHOOD
};

/// Codes from the ROM.
const CODES: Configuration = Configuration {
    name: "codes",
    scenario: "histogram_validation",
    parameters: &["CodeSource", "Codes", "CodeFile"],
    ..configuration::DEFAULTS
};

/// A histogram from the ROM.
const HISTOGRAM: Configuration = Configuration {
    name: "histogram",
    scenario: "estimator_validation",
    parameters: &["HistogramSource", "HistogramFile"],
    ..configuration::DEFAULTS
};

/// An array with two banks and the centroid estimator.
const TWO_BANKS: Configuration = Configuration {
    set: &["array.rows=4", "array.columns=3", "estimator.kind=centroid"],
    module: Some(super::CENTROID),
    ..ARRAY
};

/// An array with one bank and the network.
const ONE_BANK: Configuration = Configuration {
    name: "one_bank",
    set: &["array.rows=2", "array.columns=3", "array.banks=1", "estimator.kind=network"],
    parameters: &["Columns"],
    ..ARRAY
};

/// An array whose columns have chains of their own.
const OWN_CHAINS: Configuration = Configuration {
    name: "own_chains",
    set: &[
        "array.rows=2",
        "array.columns=3",
        "array.chains_file=../chains/columns.csv",
        "tdc.profile=kintex7",
        "estimator.kind=centroid",
    ],
    parameters: &["Columns", "OwnChains"],
    module: Some(super::CENTROID),
    ..ARRAY
};

/// The same with the estimator that knows their bins.
const OWN_EDGES: Configuration = Configuration {
    name: "own_edges",
    set: &[
        "array.rows=1",
        "array.columns=2",
        "array.chains_file=../chains/columns.csv",
        "tdc.profile=kintex7",
        "estimator.kind=likelihood",
    ],
    parameters: &["Columns", "OwnChains", "EdgesFile"],
    module: Some(super::LIKELIHOOD),
    ..ARRAY
};

/// Shots of a frame under random control.
const SHOTS: u32 = 8;

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    if setting.as_configured {
        return top::record(spec, setting, &mut |_| ());
    }
    if setting.setup.params.tdc_calibration.is_some() {
        return calibrated(spec, setting);
    }
    if setting.array.is_some() {
        return images(spec, setting);
    }
    let mut setting = setting.clone();
    setting.cycles = setting.cycles.or(Some(RANDOM + PLANTED));
    let shots = setting.shots(SHOTS);
    setting.setup.params.frame_ctrl.shots_per_frame = shots;
    setting.setup.scenario.control = control(&setting, shots.into());
    let params = &setting.setup.params;
    // Without Acquire, or without the TDC, there is less to reach.
    let (transitions, in_states, hits): (&[_], &[_], _) = if params.frame_ctrl.preloaded {
        (&[(0, 3), (3, 0)], &[0, 3], false)
    } else {
        let all = &[(0, 1), (1, 2), (2, 3), (3, 0), (1, 0)];
        (all, &[0, 1, 3], matches!(params.code_source, CodeSource::Tdc))
    };
    let transitions = transitions.iter().map(|(from, to)| from * 4 + to);
    let mut states = Cover::new("states, from x 4 + to", transitions);
    let (laser, window) = (&params.vcsel_driver, params.tdc.coarse_counter.window());
    let rates = 0..laser.periods.len() as u64;
    let pairs = rates.clone().flat_map(|from| rates.clone().map(move |to| from * 8 + to));
    let mut rates = Cover::new("laser_freq in force, from x 8 + to", pairs);
    let last = window.min(laser.longest_period() - 1).min(8);
    let mut coarse = Cover::new("coarse", 0..if hits { last } else { 0 });
    let mut resets = Cover::new("dsp_rst in state", in_states.iter().copied());
    let mut modes = Cover::new("mode of a hit", 0..if hits { 2 } else { 0 });
    let judges = judges_mode(params);
    let mut starts = Cover::new("mode steady, changing as an estimation begins", 0..if judges { 2 } else { 0 });
    let mut before = None;
    let vectors = top::record(spec, &setting, &mut |top| {
        let state = top.frame_ctrl.state();
        let changing = (top.pins.mode as u64) != (top.control_sync.mode_sync as u64);
        starts.see_if(top.frame_ctrl.algo_start, changing.into());
        let rate = top.vcsel_driver.registers.place(laser).map_or(0, |place| place.0);
        if let Some((last, last_rate)) = before {
            states.see_if(last != state, last as u64 * 4 + state as u64);
            rates.see(last_rate * 8 + rate);
        }
        let counter = &top.tdc.coarse_counter;
        coarse.see_if(counter.window, counter.coarse.get());
        resets.see_if(top.control_sync.dsp_rst_sync, state as u64);
        modes.see_if(top.tdc.tdc_latch.hit, top.control_sync.mode_sync as u64);
        before = Some((state, rate));
    })?;
    Ok(Vectors { coverage: vec![states, rates, coarse, resets, modes, starts], ..vectors })
}

/// Frames between calibrations, some at other rates, and a calibration abandoned: under random control there would be
/// none that comes to its end.
fn calibrated(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut setting = setting.clone();
    let cycles = setting.cycles.unwrap_or(CALIBRATED_CYCLES);
    (setting.cycles, setting.setup.params.frame_ctrl.shots_per_frame) = (Some(cycles), setting.shots(SHOTS));
    let mut draw = Draw::new(setting.seed, u64::MAX);
    let codes = setting.setup.params.vcsel_driver.periods.len() as u64;
    let (pll, mut at) = (setting.setup.pll(), 8 * 500);
    let mut change = |after: u64, change: Control| {
        at += after;
        let time = pll.locked_at + stops::of_eighths(at, pll.cycle);
        Control { at_us: time.fs() as f64 * 1e-9, ..change }
    };
    let mut changes = vec![
        change(0, Control { dsp_rst: Some(true), ..Control::default() }),
        change(8 * 20, Control { dsp_rst: Some(false), ..Control::default() }),
    ];
    for _ in 0..cycles / 1000 {
        let laser_freq = Some(draw.below(codes));
        changes.push(change(8 * 500 + draw.below(8 * 1000), Control { laser_freq, ..Control::default() }));
    }
    setting.setup.scenario.control = changes;
    let states = [(0, 1), (1, 2), (2, 3), (3, 0)].map(|(from, to)| from * 4 + to);
    let mut states = Cover::new("states, from x 4 + to", states);
    let mut calibrations = Cover::new("calibrations ended", 1..=2);
    let mut codes = Cover::new("halves of the bins with codes after that", 0..2);
    let bins = setting.setup.params.histogram.bins as u64;
    let (mut before, mut ended) = (None, 0);
    let vectors = top::record(spec, &setting, &mut |top| {
        let now = (top.frame_ctrl.state(), top.tdc_calibration.registers.calibrating);
        if let Some((state, calibrating)) = before {
            states.see_if(state != now.0, state as u64 * 4 + now.0 as u64);
            ended += u64::from(calibrating && !now.1);
        }
        calibrations.see_if(ended > 0, ended);
        codes.see_if(ended > 0 && !top.frame_ctrl.clear && top.nets.tdc_valid, 2 * top.nets.tdc_code.get() / bins);
        before = Some(now);
    })?;
    Ok(Vectors { coverage: vec![states, calibrations, codes], ..vectors })
}

/// Images of an array, with few shots.
fn images(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut setting = setting.clone();
    setting.cycles = setting.cycles.or(Some(RANDOM));
    setting.setup.params.frame_ctrl.shots_per_frame = setting.shots(SHOTS_OF_A_ROW);
    let scan = setting.setup.params.frame_ctrl.scan;
    let places = |times: u64| {
        let columns = u64::from(scan.columns);
        (0..u64::from(scan.rows) * columns).flat_map(move |place| {
            (0..times).map(move |k| (place / columns * 64 + place % columns) * 2 + k)
        })
    };
    let mut depths = Cover::new("(row x 64 + column of an estimate) x 2 + image, modulo 2", places(2));
    let mut rows = Cover::new("rows selected as a shot begins", 0..scan.rows.into());
    let mut banks = Cover::new("bank filled x 2 + the estimator works", 0..2 * u64::from(scan.banks));
    let mut lit = Cover::new("columns other than 0 whose output rises in a window", 1..scan.columns.into());
    let (mut begun, mut before) = (0, 0);
    let vectors = top::record(spec, &setting, &mut |top| {
        let (ctrl, outputs) = (&top.frame_ctrl, top.pins.column_stop.get());
        let place = ctrl.depth_row.get() * 64 + ctrl.depth_column.get();
        depths.see_if(ctrl.algo_start, place * 2 + begun / places(1).count() as u64 % 2);
        begun += u64::from(ctrl.algo_start);
        rows.see_if(top.vcsel_driver.registers.start, top.spad_control.spad_sel.get().trailing_zeros().into());
        banks.see(bits([ctrl.bank, ctrl.is_estimating()]));
        for column in 1..u64::from(scan.columns) {
            let rises = (outputs & !before) >> (column - 1) & 1 == 1;
            lit.see_if(rises && top.tdc.coarse_counter.window, column);
        }
        before = outputs;
    })?;
    Ok(Vectors { coverage: vec![depths, rows, banks, lit], ..vectors })
}

/// Shots of a row of an array.
const SHOTS_OF_A_ROW: u32 = 60;

/// Cycles between calibrations: two of some 9,000 and the frames after them.
const CALIBRATED_CYCLES: usize = 26_000;
