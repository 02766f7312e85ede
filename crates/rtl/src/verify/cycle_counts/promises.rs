//! Promised numbers, and the property in Verilog that states each.

use tofsim::firmware::centroid_estimator;
use tofsim::firmware::histogram_builder;

use crate::golden::blocks::{CENTROID as CENTROID_MODULE, LIKELIHOOD as LIKELIHOOD_MODULE};
use crate::verify::rtl::Rtl;

use super::design::{CountedDesign, Define};
use super::scan::CountedScan;

/// A Verilog module with properties of some modules of the design.
#[derive(Debug)]
pub struct Properties {
    /// Its name, which is its file's stem.
    pub module: &'static str,
    /// The file.
    pub text: &'static str,
    /// The bench that counts the same in a simulation.
    pub bench: &'static str,
    /// Unit of the numbers.
    pub unit: &'static str,
    /// Modules that are left open: nothing proven depends on what they do.
    pub open: &'static [&'static str],
    /// Registers without which there is no proof, by their paths in its `dut`.
    pub registers: &'static [&'static str],
    /// Yosys's pass that makes logic of processes.
    pub logic: &'static str,
    /// Yosys's pass that makes one step of the proof of a clock cycle.
    pub step: &'static str,
    /// Longest induction.
    pub steps: u32,
}

impl Properties {
    const fn new(module: &'static str, bench: &'static str, text: &'static str) -> Self {
        let (unit, step, steps) = ("cycles of clk_sys", "async2sync", 4);
        Properties {
            module,
            text,
            bench,
            unit,
            open: &[],
            registers: &[],
            logic: "proc",
            step,
            steps,
        }
    }
}

/// Properties of an estimator: the part of its own between the head and the tail that all have.
macro_rules! of_estimator {
    ($own:literal) => {
        concat!(include_str!("check_head.sv"), include_str!($own), include_str!("check_tail.sv"))
    };
}

static ESTIMATOR: Properties = Properties {
    open: &["forward1", "forward2", "tansig"],
    registers: &["estimator_ctrl.busy", "estimator_ctrl.step"],
    ..Properties::new("check_estimator", "bench_estimator", of_estimator!("check_estimator.sv"))
};

static CENTROID: Properties = Properties {
    registers: &["busy", "step"],
    ..Properties::new("check_centroid", "bench_centroid", of_estimator!("check_centroid.sv"))
};

/// No proof reads memories, so the solver's program, a ROM or a large `case`, becomes logic. What only feeds the open
/// blocks and the solver's memory is taken away, with that memory: it is much, and what they do is anything already.
const LIKELIHOOD_OF_ONE: Properties = Properties {
    open: &[
        "likelihood_memory",
        "likelihood_terms",
        "likelihood_sums",
        "likelihood_glass",
        "likelihood_pair",
        "likelihood_scan",
    ],
    registers: &[
        "state",
        "waited",
        "steps",
        "dark",
        "run",
        "entry",
        "likelihood_solver.running",
        "likelihood_solver.ran",
        "likelihood_solver.counter",
        "likelihood_solver.pause",
    ],
    logic: "proc -norom; memory -nomap; memory_map -rom-only; delete */t:likelihood_memory */t:likelihood_terms \
            */t:likelihood_sums */t:likelihood_glass */t:likelihood_pair */t:likelihood_scan */t:$mem*",
    steps: 2,
    ..Properties::new("check_likelihood", "bench_likelihood", of_estimator!("check_likelihood.sv"))
};

static LIKELIHOOD: Properties = LIKELIHOOD_OF_ONE;

/// The same where it looks for a second target: it takes turns.
static LIKELIHOOD_OF_TWO: Properties = Properties {
    registers: &[
        "state",
        "waited",
        "steps",
        "dark",
        "wide",
        "paired",
        "turns",
        "run",
        "entry",
        "likelihood_solver.running",
        "likelihood_solver.ran",
        "likelihood_solver.counter",
        "likelihood_solver.pause",
    ],
    ..LIKELIHOOD_OF_ONE
};

static SHOT: Properties = Properties {
    open: &["ddr_output"],
    steps: 40,
    ..Properties::new(
        "check_shot",
        "bench_shot",
        concat!(include_str!("check_shot.sv"), include_str!("check_tail.sv")),
    )
};

static SCAN: Properties = Properties {
    registers: &["state", "shots", "drain", "estimating"],
    ..Properties::new(
        "check_scan",
        "bench_scan",
        concat!(include_str!("check_scan.sv"), include_str!("check_tail.sv")),
    )
};

static PULSE: Properties = Properties {
    unit: "ps",
    step: "clk2fflogic",
    steps: 40,
    ..Properties::new("check_pulse", "bench_shot", include_str!("check_pulse.sv"))
};

/// A promise.
#[derive(Debug)]
pub struct Promise {
    /// Name of the number, for people.
    pub what: String,
    /// The number.
    pub expected: u64,
    /// Verilog that has its property.
    pub properties: &'static Properties,
    /// The property: a wire in that module.
    pub property: &'static str,
    /// The parameter of that module which has the number.
    pub parameter: &'static str,
    /// The laser's code that it is about.
    pub code: Option<usize>,
    /// Macros to set.
    pub defines: Vec<Define>,
    /// Another register without which there is no proof.
    pub register: Option<String>,
}

impl Promise {
    fn new(
        properties: &'static Properties,
        property: &'static str,
        expected: u64,
        what: impl Into<String>,
    ) -> Self {
        let (what, parameter) = (what.into(), "Expected");
        let (code, defines, register) = (None, Vec::new(), None);
        Promise { what, expected, properties, property, parameter, code, defines, register }
    }

    /// Its name where things are counted.
    pub fn key(&self) -> String {
        let code = self.code.map_or(String::new(), |code| format!("_{code}"));
        format!("{}{code}", self.property)
    }

    /// Registers without which there is no proof, by their paths in the module's `dut`.
    pub fn registers(&self) -> impl Iterator<Item = &str> {
        self.properties.registers.iter().copied().chain(self.register.as_deref())
    }
}

/// The macros of an estimator with the latency that is promised of it.
fn with_latency(mut defines: Vec<Define>, latency: u64) -> Vec<Define> {
    defines.push(("LATENCY", latency.to_string()));
    defines
}

/// Returns the promise of an estimator that a design may leave out.
pub fn centroid(design: &CountedDesign) -> Promise {
    let bins = design.estimator.bins;
    let histogram = histogram_builder::Params { bins, ..histogram_builder::Params::default() };
    let done = centroid_estimator::Params { histogram, ..Default::default() }.done();
    let what = "centroid estimator: algo_start taken to algo_done";
    Promise {
        parameter: "Latency",
        defines: with_latency(design.of_estimator(), done),
        ..Promise::new(&CENTROID, "centroid_latency", done, what)
    }
}

/// As [`centroid`], where the estimator's model holds.
pub fn likelihood(design: &CountedDesign) -> Option<Promise> {
    let params = design.likelihood.as_ref()?;
    let done = params.done();
    let properties = if params.has_second() { &LIKELIHOOD_OF_TWO } else { &LIKELIHOOD };
    let what = "likelihood estimator: algo_start taken to algo_done";
    Some(Promise {
        parameter: "Latency",
        defines: with_latency(design.of_likelihood(), done),
        ..Promise::new(properties, "likelihood_latency", done, what)
    })
}

/// Returns what is promised of an array.
pub fn of_scan(scan: &CountedScan) -> [Promise; 3] {
    let timing = scan.timing();
    [
        ("row_cycles", "RowCycles", timing.row, "row: Clear to Clear"),
        ("image_cycles", "ImageCycles", timing.image, "image: first row to first row"),
        ("depth_latency", "Latency", timing.latency, "row: acquire low to its last depth"),
    ]
    .map(|(property, parameter, cycles, what)| Promise {
        parameter,
        defines: scan.defines(),
        ..Promise::new(&SCAN, property, cycles, what)
    })
}

/// Returns what is promised of a design with those modules.
pub fn of(rtl: &Rtl, design: &CountedDesign) -> Vec<Promise> {
    let scan = design.scan.iter().flat_map(of_scan);
    let centroid = rtl.has(CENTROID_MODULE).then(|| centroid(design));
    let likelihood = rtl.has(LIKELIHOOD_MODULE).then(|| likelihood(design)).flatten();
    promises(design).into_iter().chain(centroid).chain(likelihood).chain(scan).collect()
}

/// Everything else that is promised of a design.
pub fn promises(design: &CountedDesign) -> Vec<Promise> {
    let (bins, neurons) = (design.estimator.bins as u64, design.estimator.neurons as u64);
    let pairs = neurons.div_ceil(2);
    let latency = bins + (3 + neurons).max(7 + pairs);
    let estimator = |property, parameter, expected, what| Promise {
        parameter,
        defines: with_latency(design.of_estimator(), latency),
        ..Promise::new(&ESTIMATOR, property, expected, format!("estimator: {what}"))
    };
    let layer = |property, parameter, expected, enable| Promise {
        register: Some(format!("estimator_ctrl.{enable}")),
        ..estimator(property, parameter, expected, format!("{enable} high"))
    };
    let laser = |properties, property, expected, what| Promise {
        defines: design.of_laser(),
        ..Promise::new(properties, property, expected, what)
    };
    let to_done = "algo_start taken to algo_done".to_owned();
    let mut promises = vec![
        estimator("latency", "Latency", latency, to_done),
        layer("forward1_cycles", "Forward1", bins, "forward1_en"),
        layer("tansig_cycles", "Tansig", 1, "tansig_en"),
        layer("forward2_cycles", "Forward2", pairs, "forward2_en"),
    ];
    for (property, span) in
        [("laser_period", "start to start"), ("first_shot", "acquire to the first start")]
    {
        promises.extend(design.laser.periods.iter().enumerate().map(|(code, period)| {
            let what = format!("laser_freq {code}: {span}");
            Promise { code: Some(code), ..laser(&SHOT, property, *period, what) }
        }));
    }
    let of_shot = |property, cycles, what: &str| laser(&SHOT, property, cycles, what.to_owned());
    let of_pulse = |property, ps, what: &str| laser(&PULSE, property, ps, what.to_owned());
    let width_ps = u64::from(design.laser.pulse_half_cycles) * design.half_ps;
    promises.extend([
        of_shot("pre_start_lead", 2, "pre_start to start"),
        of_shot("spad_rst_lead", 1, "MODE 0: spad_rst to start"),
        of_shot("spad_rst_width", 1, "MODE 0: spad_rst high, each shot"),
        of_shot("spad_rst_mode_1", 0, "MODE 1: spad_rst high, each shot"),
        of_pulse("laser_on_lag", 0, "start to laser_on"),
        of_pulse("laser_on_width", width_ps, "laser_on high"),
    ]);
    promises
}
