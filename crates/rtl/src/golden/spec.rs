//! Specification of a block, and its golden vectors.

use tofsim::error::Result;
use tofsim::firmware::pll::Pll;
use tofsim::hierarchy;
use tofsim::kernel::Time;
use tofsim::kernel::sizes::Sizes;
use tofsim::network::mem::Mem;

use super::configuration::Configuration;
use super::cover::Cover;
use super::glue::Glue;
use super::model::Model;
use super::parameters::{self, Parameters, memories};
use super::setting::Setting;
use super::table::Table;
use super::timing::{ASIDE, CLK_SYS, Timing};

/// Latency of an effect: clocks that it takes at least, from the edge that takes the input to the one that
/// changes the output; 0 for a plain register. A combinational path has none.
#[derive(Clone, Copy, Debug)]
pub struct Latency {
    /// Input port.
    pub from: &'static str,
    /// Output port.
    pub to: &'static str,
    /// Clock cycles in the design of these vectors.
    pub cycles: fn(&Vectors) -> u64,
}

/// The line that resets a block: those before it show how its registers begin.
pub const FIRST_RESET: usize = 16;

/// Makes a block's vectors.
pub type Record = fn(&'static Spec, &Setting) -> Result<Vectors>;

/// Blocks whose random streams have numbers, in the order of these; all others have streams that belong to
/// their names. This list stays as it is.
const NUMBERED: &str = "carry_chain coarse_counter code_preload control_sync ddr_output depth_estimator \
    estimator_ctrl forward1 forward2 frame_ctrl histogram_builder histogram_preload lvds_output pll \
    reset_sync spad_control tansig tdc tdc_decoder tdc_latch tof_top vcsel_driver centroid_estimator";

/// Specification of a block, beside its ports.
#[derive(Debug)]
pub struct Spec {
    /// Its module.
    pub name: &'static str,
    /// Its Verilog.
    pub verilog: &'static str,
    /// One place of it in the hierarchy, below the top.
    pub scope: &'static str,
    /// When its clocks move and when it is looked at.
    pub timing: Timing,
    /// Its synchronous reset, active high. Line [`FIRST_RESET`] has it, at the latest.
    pub reset: Option<&'static str>,
    /// Outputs and registers that change within a cycle of the clock that counts.
    pub fast: &'static [&'static str],
    /// Latencies of its effects.
    pub latency: &'static [Latency],
    /// Configurations beside the one that the scenario sets.
    pub configurations: &'static [Configuration],
    /// A loop around the block, if it needs one.
    pub glue: Option<Glue>,
    /// Steps the Rust model with input of its own.
    pub record: Record,
    /// Steps it with somebody else's; none of a block that has no checker.
    pub model: Option<Model>,
}

impl Spec {
    /// A block of that name and place which `record` steps: what it is unless its file says otherwise.
    /// Plain registers of `clk_sys`, no reset.
    pub const fn new(name: &'static str, scope: &'static str, record: Record) -> Self {
        Spec {
            name,
            verilog: "",
            scope,
            timing: CLK_SYS,
            reset: None,
            fast: &[],
            latency: &[],
            configurations: &[],
            glue: None,
            record,
            model: None,
        }
    }

    /// Number of the random stream of its stimulus: whatever other blocks there are, it stays.
    pub fn stream(&self) -> u64 {
        // FNV-1a of the name, above all numbers.
        let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        let of_name = || self.name.bytes().fold(0xcbf2_9ce4_8422_2325, step) | 1 << 63;
        let number = NUMBERED.split_whitespace().position(|name| name == self.name);
        number.map_or_else(of_name, |number| number as u64)
    }

    /// Parameters of its Verilog that say what a design has and how large things are, where they are not the default.
    pub fn parameters(&self, setting: &Setting) -> Parameters {
        let params = &setting.setup.params;
        [parameters::options(params, self.verilog), parameters::sized(params, self.verilog)]
            .concat()
    }

    /// Returns whether the bench drives a port from a memory, and not from a line.
    pub fn is_glued(&self, port: &str) -> bool {
        self.glue.is_some() && port == Glue::DRIVES
    }

    /// Dotted path of the block in the hierarchy.
    pub fn path(&self) -> String {
        match self.scope {
            "" => hierarchy::TOP.to_owned(),
            scope => format!("{}.{scope}", hierarchy::TOP),
        }
    }
}

/// Inputs and outputs of a block, line by line.
#[derive(Debug)]
pub struct Vectors {
    /// The block.
    pub spec: &'static Spec,
    /// Seed of the stimulus.
    pub seed: u64,
    /// Name of the scenario.
    pub source: String,
    /// Widths and numbers of signals of the design.
    pub sizes: Sizes,
    /// Verilog parameters.
    pub parameters: Parameters,
    /// Inputs: line k is taken by edge k.
    pub stimulus: Table,
    /// Outputs and registers: line k is seen just before edge k.
    pub expected: Table,
    /// The clocks.
    pub pll: Pll,
    /// Edge 0.
    pub first_edge: Time,
    /// When `tdc_stop` changes; it starts low.
    pub stops: Vec<Time>,
    /// When which bit of `column_stop` changes; all start low.
    pub column_stops: Vec<(Time, u32)>,
    /// A memory that the bench reads.
    pub bench_memory: Option<Mem>,
    /// Of a block without reset: lines from power-up until its registers have all taken a value.
    pub settles: usize,
    /// Coverage of the stimulus.
    pub coverage: Vec<Cover>,
}

impl Vectors {
    /// With parameters of the block's own before those that any block may have.
    pub fn with(self, own: Parameters) -> Self {
        Vectors { parameters: [own, self.parameters].concat(), ..self }
    }

    /// Module of their bench, and the stem of its file.
    pub fn bench_module(&self) -> String {
        format!("tb_{}", self.spec.name)
    }

    /// Period of the clock that is counted.
    pub fn period(&self) -> Time {
        self.spec.timing.period(self.pll.cycle)
    }

    /// Returns how long before the end of a cycle that sample of it is taken.
    pub fn before_edge(&self, sample: usize) -> Time {
        self.spec.timing.before_edge(sample, self.pll.cycle) + ASIDE
    }

    /// Half a period of the board's oscillator.
    pub fn half_of_oscillator(&self) -> Time {
        self.pll.clk_in.fall(0) - self.pll.clk_in.rise(0)
    }

    /// The edge that ends that cycle.
    pub fn edge(&self, cycle: usize) -> Time {
        self.first_edge + Time::from_fs(cycle as u64 * self.period().fs())
    }

    /// Memories that the Verilog or the bench loads.
    pub fn memories(&self) -> impl Iterator<Item = &Mem> {
        memories(&self.parameters).chain(&self.bench_memory)
    }
}
