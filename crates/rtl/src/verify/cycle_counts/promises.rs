//! What is promised, and which property in which Verilog says so.

use tofsim::firmware::forward2::NEURONS;

/// A Verilog module with properties of some modules of the design.
#[derive(Debug)]
pub struct Properties {
    /// Its name, which is its file's stem.
    pub module: &'static str,
    /// The file.
    pub text: &'static str,
    /// Modules that are left open: nothing proven depends on what they do.
    pub open: &'static [&'static str],
    /// Yosys's pass that makes one step of the proof of a clock cycle.
    pub step: &'static str,
    /// Longest induction.
    pub steps: u32,
}

static ESTIMATOR: Properties = Properties {
    module: "check_estimator",
    text: include_str!("check_estimator.sv"),
    open: &["forward1", "forward2", "tansig"],
    step: "async2sync",
    steps: 4,
};

static CENTROID: Properties = Properties {
    module: "check_centroid",
    text: include_str!("check_centroid.sv"),
    open: &[],
    step: "async2sync",
    steps: 4,
};

static SHOT: Properties = Properties {
    module: "check_shot",
    text: include_str!("check_shot.sv"),
    open: &["ddr_output"],
    step: "async2sync",
    steps: 40,
};

static PULSE: Properties = Properties {
    module: "check_pulse",
    text: include_str!("check_pulse.sv"),
    open: &[],
    step: "clk2fflogic",
    steps: 40,
};

/// A promise.
#[derive(Debug)]
pub struct Promise {
    /// What is promised, for people.
    pub what: String,
    /// The number.
    pub expected: u64,
    /// Its unit.
    pub unit: &'static str,
    /// Where its property stands.
    pub properties: &'static Properties,
    /// The property: a wire in that module.
    pub property: &'static str,
    /// The parameter of that module which has the number.
    pub parameter: &'static str,
    /// The laser's code that it is about.
    pub code: Option<usize>,
    /// Macro to set.
    pub define: Option<[String; 2]>,
    /// Registers without which there is no proof, by their paths in that module's `dut`.
    pub registers: &'static [&'static str],
}

impl Promise {
    fn new(
        properties: &'static Properties,
        property: &'static str,
        expected: u64,
        what: impl Into<String>,
    ) -> Self {
        Promise {
            what: what.into(),
            expected,
            unit: "cycles of clk_125",
            properties,
            property,
            parameter: "Expected",
            code: None,
            define: None,
            registers: &[],
        }
    }

    /// Its name where things are counted.
    pub fn key(&self) -> String {
        match self.code {
            Some(code) => format!("{}_{code}", self.property),
            None => self.property.to_owned(),
        }
    }
}

/// The macro that sets the number of neurons, where it is not the default: another design need not
/// have that parameter.
pub fn define(neurons: usize) -> Option<[String; 2]> {
    (neurons != NEURONS).then(|| ["NEURONS".to_owned(), neurons.to_string()])
}

/// What is promised of the estimator that a design may leave out.
pub fn centroid() -> Promise {
    Promise {
        parameter: "Latency",
        registers: &["busy", "step"],
        ..Promise::new(
            &CENTROID,
            "centroid_latency",
            308,
            "centroid estimator: algo_start taken to algo_done",
        )
    }
}

/// Everything else that is promised of a design whose estimator has so many neurons.
pub fn promises(neurons: usize) -> Vec<Promise> {
    let estimator = |property, expected, parameter, registers, what| Promise {
        parameter,
        registers,
        define: define(neurons),
        ..Promise::new(&ESTIMATOR, property, expected, what)
    };
    let shot = |property, expected, what| Promise::new(&SHOT, property, expected, what);
    let pulse = |property, expected, what| Promise {
        unit: "ps",
        ..Promise::new(&PULSE, property, expected, what)
    };
    let forward1 = &["estimator_ctrl.busy", "estimator_ctrl.step", "estimator_ctrl.forward1_en"];
    let tansig = &["estimator_ctrl.busy", "estimator_ctrl.step", "estimator_ctrl.tansig_en"];
    let forward2 = &["estimator_ctrl.busy", "estimator_ctrl.step", "estimator_ctrl.forward2_en"];
    let mut promises = vec![
        estimator(
            "latency",
            259 + neurons as u64,
            "Latency",
            &["estimator_ctrl.busy", "estimator_ctrl.step"],
            "estimator: algo_start taken to algo_done",
        ),
        estimator("forward1_cycles", 257, "Forward1", forward1, "estimator: forward1_en high"),
        estimator("tansig_cycles", 1, "Tansig", tansig, "estimator: tansig_en high"),
        estimator(
            "forward2_cycles",
            2 + neurons as u64,
            "Forward2",
            forward2,
            "estimator: forward2_en high, to algo_done",
        ),
    ];
    for (property, span) in
        [("laser_period", "start to start"), ("first_shot", "acquire to the first start")]
    {
        for (code, period) in [25, 13, 8, 6].into_iter().enumerate() {
            let what = format!("laser_freq {code}: {span}");
            promises
                .push(Promise { code: Some(code), ..Promise::new(&SHOT, property, period, what) });
        }
    }
    promises.extend([
        shot("pre_start_lead", 2, "pre_start to start"),
        shot("spad_rst_lead", 1, "MODE 0: spad_rst to start"),
        shot("spad_rst_width", 1, "MODE 0: spad_rst high, each shot"),
        shot("spad_rst_mode_1", 0, "MODE 1: spad_rst high, each shot"),
        pulse("laser_on_lag", 0, "start to laser_on"),
        pulse("laser_on_width", 2000, "laser_on high"),
    ]);
    promises
}
