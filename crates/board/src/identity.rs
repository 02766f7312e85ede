//! What a board says of itself.

use std::time::Duration;

use tofsim::error::{Input, Result};
use tofsim::firmware::registers::map::{
    IDENTITY, IDENTITY_VALUE, MAP_VERSION, MAP_VERSION_VALUE, PARAMETERS_HASH,
};
use tofsim::sim::setup::Setup;
use tofsim_rtl::golden::parameters::hash::parameters_hash;

/// Registers by which a board identifies itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// `tofs` in ASCII.
    pub identity: u32,
    /// Version of the register map.
    pub map_version: u32,
    /// Hash of the parameters that the firmware was built with.
    pub parameters_hash: u64,
    /// Frequency of clk_sys [Hz].
    pub system_hz: u32,
    /// Silence of the host after which the laser goes off [cycles of clk_sys].
    pub host_timeout: u32,
}

impl Identity {
    /// From the words at the addresses from `identity` to `host_timeout`.
    pub(crate) fn of_words(words: [u32; 6]) -> Self {
        let [identity, map_version, upper, lower, system_hz, host_timeout] = words;
        let parameters_hash = u64::from(upper) << 32 | u64::from(lower);
        Identity { identity, map_version, parameters_hash, system_hz, host_timeout }
    }

    /// Whether the board has tofsim's firmware.
    pub(crate) fn is_ours(&self) -> bool {
        self.identity == IDENTITY_VALUE
    }

    /// Checks that the board has tofsim's firmware, with this version of the register map.
    pub(crate) fn check(&self, port: &str) -> Result<()> {
        if !self.is_ours() {
            let expected =
                format!("expected {IDENTITY_VALUE:#010x}, a board with tofsim's firmware");
            let fault = Input::new(port, expected).field(IDENTITY.name);
            return Err(fault.value(format!("{:#010x}", self.identity)).into());
        }
        if self.map_version != MAP_VERSION_VALUE {
            let expected = format!(
                "expected {MAP_VERSION_VALUE}: build firmware and tofsim from the same version"
            );
            let fault = Input::new(port, expected).field(MAP_VERSION.name);
            return Err(fault.value(self.map_version).into());
        }
        Ok(())
    }

    /// Returns whether the board was built with the parameters of a setup.
    pub fn has_parameters_of(&self, setup: &Setup) -> bool {
        self.parameters_hash == parameters_hash(setup)
    }

    /// Checks that the board was built with the parameters of a setup.
    pub(crate) fn check_parameters(&self, port: &str, setup: &Setup) -> Result<()> {
        let own = parameters_hash(setup);
        if self.parameters_hash == own {
            return Ok(());
        }
        let expected = format!(
            "expected {own:#018x}, that of scenario {}: name the scenario and the keys that the firmware was built \
             with, or use --any-parameters",
            named(setup)
        );
        let fault = Input::new(port, expected).field(PARAMETERS_HASH.name);
        Err(fault.value(format!("{:#018x}", self.parameters_hash)).into())
    }

    /// Silence of the host after which the laser goes off.
    pub fn host_timeout(&self) -> Duration {
        let seconds = f64::from(self.host_timeout) / f64::from(self.system_hz.max(1));
        Duration::from_secs_f64(seconds)
    }
}

/// Returns a setup's name, with the keys that are set.
fn named(setup: &Setup) -> String {
    match &setup.set[..] {
        [] => setup.name.clone(),
        set => format!("{} with {}", setup.name, set.join(", ")),
    }
}
