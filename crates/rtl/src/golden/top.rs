//! The whole firmware as a scenario runs it, sampled where the bench looks.

use tofsim::error::{Input, Result};
use tofsim::firmware::tof_top::{CodeSource, Estimator, HistogramSource, Params, Pins, TofTop};
use tofsim::hierarchy::{self, Entry, IDS, Part};
use tofsim::kernel::signals::Signals;
use tofsim::kernel::{Time, U};
use tofsim::signals;
use tofsim::sim::device::{Off, SignalProbe};
use tofsim::sim::frames::Frames;
use tofsim::sim::setup::Setup;

use super::block::{Parameter, Setting, Spec, neurons};
use super::blocks::centroid_estimator;
use super::record::{Watched, inputs};
use super::roms;
use super::table::{Fill, Table};
use super::vectors::Vectors;

signals! {
    /// The pins of a line: all but `tdc_stop`, which changes at any time.
    struct Stimulus {
        /// Reset button, until the middle of the cycle.
        rst: bool,
        /// Reset button, from then on.
        rst_late: bool,
        /// SPAD quench mode.
        mode: bool,
        /// Laser repetition rate.
        laser_freq: U<2>,
        /// Lets the laser fire.
        laser_en: bool,
        /// Lets the estimator start.
        dsp_en: bool,
        /// Abandons the frame.
        dsp_rst: bool,
    }
}

/// Sees the firmware just before the edge that takes a line.
pub(super) type Watch<'a> = &'a mut dyn FnMut(&TofTop);

/// The vectors of a run: its frames, or so many cycles. `watch` sees every cycle.
pub(super) fn record(
    spec: &'static Spec,
    setup: &Setup,
    setting: &Setting,
    watch: Watch,
) -> Result<Vectors> {
    check(setup)?;
    let params = &setup.params;
    let entries = hierarchy::entries(params);
    // Runs that may be long compare what a logic analyser on the board would see.
    let is_own = |entry: &Entry| entry.scope == hierarchy::TOP;
    let wanted = |entry: &Entry| !setting.as_told || is_own(entry) || entry.signal.view.probe;
    let mut device = setup.device();
    let (begin, first_edge) = (setup.pll().locked_at, device.next_edge());
    let look = Look::new(spec, begin, params, Watched::new(spec, &entries, wanted), watch);
    let look = run(setup, setting, &mut device, look)?;
    Ok(Vectors {
        spec,
        seed: setting.seed,
        source: setup.name.clone(),
        neurons: params.depth_estimator.neurons(),
        parameters: parameters(setup),
        stimulus: look.stimulus,
        expected: look.expected,
        first_edge_ps: first_edge.ps(),
        stops: look.stops,
        roms: roms::tof_top(params),
        coverage: Vec::new(),
    })
}

fn run<'a>(
    setup: &'a Setup,
    setting: &Setting,
    device: &mut tofsim::sim::Device,
    mut look: Look<'a>,
) -> Result<Look<'a>> {
    let (params, mut frames) = (&setup.params, Frames::default());
    let whole_frames = setting.as_told && setting.cycles.is_none();
    let limit = match whole_frames {
        true => setup.longest_run(setting.frames),
        false => setting.cycles() as u64,
    };
    device.power_up(&mut look, &mut Off);
    while device.cycle() < limit {
        device.step(params, &mut look, &mut Off);
        frames.edge(device.cycle() - 1, &device.top, params);
        if whole_frames && frames.done() == setting.frames && device.top.frame_ctrl.frame_done {
            device.step(params, &mut look, &mut Off);
            return Ok(look);
        }
    }
    match whole_frames {
        true => Err(Input::new(format!("scenario {}", setup.name), "the frame never ends").into()),
        false => Ok(look),
    }
}

/// What the Verilog's PLL and the bench's clocks cannot do.
fn check(setup: &Setup) -> Result<()> {
    let (pll, source) = (&setup.scenario.pll, format!("scenario {}", setup.name));
    let fault = |field: &str, value: String, expected: &str| {
        Err(Input::new(&source, expected).field(field).value(value).into())
    };
    if pll.jitter_rms_ps > 0.0 {
        let expected = "expected 0: a Verilog bench has clocks without jitter";
        return fault("pll.jitter_rms_ps", pll.jitter_rms_ps.to_string(), expected);
    }
    let board = (200_000_000, 5, 1, 8);
    if (pll.input_hz, pll.multiply, pll.divide, pll.output_divide) != board {
        let expected = "expected the board's 200 MHz, M 5, D 1, O 8, as pll.v has them";
        return fault("pll.input_hz", pll.input_hz.to_string(), expected);
    }
    if !setup.pll().locked_at.fs().is_multiple_of(1000) {
        let expected = "expected whole picoseconds, as pll.v counts them";
        return fault("pll.lock_time_us", pll.lock_time_us.to_string(), expected);
    }
    Ok(())
}

fn parameters(setup: &Setup) -> Vec<(&'static str, Parameter)> {
    use Parameter::{File, Number};
    let params = &setup.params;
    let mut list = vec![
        ("ShotsPerFrame", Number(params.frame_ctrl.shots_per_frame.into())),
        ("LockTime", Number(setup.pll().locked_at.ps())),
        ("W1File", File("w1.mem")),
        ("B1File", File("b1.mem")),
        ("W2File", File("w2.mem")),
        ("B2File", File("b2.mem")),
        ("TansigFile", File("tansig.mem")),
        ("CalFile", File("tdc_cal.mem")),
        ("DelaysFile", File("tap_delays.mem")),
    ];
    let (preloads_codes, codes) = match &params.code_source {
        CodeSource::Tdc => (0, 1),
        CodeSource::Preload(rom) => (1, rom.len() as u64),
    };
    list.extend(neurons(params.depth_estimator.neurons()));
    let preloads_histogram = matches!(params.histogram_source, HistogramSource::Preload(_));
    list.extend([
        ("CodeSource", Number(preloads_codes)),
        ("Codes", Number(codes)),
        ("CodeFile", File("codes.mem")),
        ("HistogramSource", Number(preloads_histogram.into())),
        ("HistogramFile", File("histogram.mem")),
    ]);
    if params.estimator == Estimator::Centroid {
        list.push(("Estimator", Number(1)));
        list.extend(centroid_estimator::parameters(&params.centroid_estimator));
    }
    list
}

/// Keeps what the bench would see.
struct Look<'a> {
    stimulus: Table,
    expected: Table,
    places: Vec<Vec<Vec<usize>>>,
    order: &'a [u16],
    /// The firmware since the last instant at which something changed.
    current: TofTop,
    /// What the samples of each kind have shown.
    sampled: Vec<Part>,
    /// Next sample: its instant, and which of the cycle it is.
    next: Time,
    sample: usize,
    spacing: Time,
    /// The reset at the edge in the middle of the cycle.
    early_rst: bool,
    stops: Vec<Time>,
    watch: Watch<'a>,
}

impl<'a> Look<'a> {
    fn new(
        spec: &'static Spec,
        begin: Time,
        params: &'a Params,
        watched: Watched,
        watch: Watch<'a>,
    ) -> Self {
        let samples = spec.timing.samples();
        let spacing = Time::from_fs(1000 * spec.timing.period_ps() / samples as u64);
        Look {
            stimulus: Table::new(inputs(&Stimulus::list())),
            expected: Table::new(watched.columns),
            places: watched.places,
            order: params.tdc.delays.order(),
            current: TofTop::new(Pins::default()),
            sampled: vec![Part::of(0..IDS); samples],
            next: begin + spacing,
            sample: 0,
            spacing,
            early_rst: false,
            stops: Vec::new(),
            watch,
        }
    }

    /// Takes the sample that falls due.
    fn take(&mut self, pins: &Pins) {
        let places = &self.places[self.sample];
        let mut fill = Fill { table: &mut self.expected, places, order: self.order };
        self.sampled[self.sample].follow(&self.current, &mut fill);
        self.sample += 1;
        self.next += self.spacing;
        if 2 * self.sample == self.places.len() {
            self.early_rst = pins.rst;
        }
        if self.sample == self.places.len() {
            self.sample = 0;
            self.line(pins);
        }
    }

    /// Ends the line of a cycle.
    fn line(&mut self, pins: &Pins) {
        (self.watch)(&self.current);
        let rst = self.early_rst;
        let Pins { rst: rst_late, mode, laser_freq, laser_en, dsp_en, dsp_rst, .. } = *pins;
        let line = Stimulus { rst, rst_late, mode, laser_freq, laser_en, dsp_en, dsp_rst };
        let places: Vec<_> = (0..Stimulus::COUNT).map(|column| vec![column]).collect();
        let mut fill = Fill { table: &mut self.stimulus, places: &places, order: &[] };
        line.changes(None, 0, &mut fill);
        self.stimulus.push();
        self.expected.push();
    }
}

impl SignalProbe for Look<'_> {
    const ON: bool = true;

    fn sample(&mut self, now: Time, top: &TofTop) {
        while self.next <= now {
            self.take(&top.pins);
        }
        if top.pins.tdc_stop != self.current.pins.tdc_stop {
            self.stops.push(now);
        }
        hierarchy::copy(top, &mut self.current);
    }
}
