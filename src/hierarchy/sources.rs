//! Places of the modules in the Verilog, to which waveforms point. The lines are found at compile time.

use super::channels::CHANNEL;

/// A module, and where its file declares it.
#[derive(Debug)]
pub struct ModuleSource {
    /// Name.
    pub name: &'static str,
    /// Path of its file in the repository.
    pub file: &'static str,
    /// Line of the declaration.
    pub line: u32,
    /// Scopes inside.
    instances: &'static [Instance],
}

/// A scope inside a module.
#[derive(Debug)]
struct Instance {
    scope: &'static str,
    module: &'static str,
    /// Line at which the file of the module around it instantiates it.
    line: u32,
}

impl ModuleSource {
    /// Returns the module of an outermost scope, if it is one of the firmware's.
    pub fn outermost(scope: &str) -> Option<&'static ModuleSource> {
        MODULES.iter().find(|module| module.name == scope)
    }

    /// Returns its name, which is empty for a block within a module.
    pub fn component(&self) -> &'static str {
        if self.name == CHANNEL { "" } else { self.name }
    }

    /// Returns the module of a scope inside this one, and the line of this one's file that instantiates it.
    pub fn inside(&self, scope: &str) -> Option<(&'static ModuleSource, u32)> {
        let scope = if scope.starts_with(CHANNEL) { CHANNEL } else { scope };
        let instance = self.instances.iter().find(|instance| instance.scope == scope)?;
        let module = MODULES.iter().find(|module| module.name == instance.module)?;
        Some((module, instance.line))
    }
}

/// Lists modules: their name, their file, the text that declares them, and for each scope inside its module and the text
/// that instantiates it.
macro_rules! modules {
    ($($name:literal, $file:literal, $declared:literal {
        $($scope:literal: $module:literal, $instantiated:literal;)*
    })*) => {
        &[$(ModuleSource {
            name: $name,
            file: concat!("rtl_ref/", $file, ".v"),
            line: modules!(@line $file, $declared),
            instances: &[$(Instance {
                scope: $scope,
                module: $module,
                line: modules!(@line $file, $instantiated),
            }),*],
        }),*]
    };
    (@line $file:literal, $text:expr) => {
        const { line_of(include_bytes!(concat!("../../rtl_ref/", $file, ".v")), $text) }
    };
}

const MODULES: &[ModuleSource] = modules! {
    "tof_top", "tof_top", "module tof_top #(" {
        "pll": "pll", ") pll (";
        "reset_sync_sys": "reset_sync", "reset_sync reset_sync_sys (";
        "reset_sync_laser": "reset_sync", "reset_sync reset_sync_laser (";
        "control_sync": "control_sync", ") control_sync (";
        "frame_ctrl": "frame_ctrl", ") frame_ctrl (";
        "vcsel_driver": "vcsel_driver", ") vcsel_driver (";
        "lvds_output": "lvds_output", "lvds_output lvds_output (";
        "spad_control": "spad_control", ") spad_control (";
        "tdc": "tdc", ") tdc (";
        "tdc_calibration": "tdc_calibration", ") tdc_calibration (";
        "code_preload": "code_preload", ") code_preload (";
        "histogram_builder": "histogram_builder", ") histogram_builder (";
        "second_bank": "histogram_builder", ") second_bank (";
        "channel_": "channel_", ": channel";
        "histogram_preload": "histogram_preload", ") histogram_preload (";
        "depth_estimator": "depth_estimator", ") depth_estimator (";
        "centroid_estimator": "centroid_estimator", ") centroid_estimator (";
        "likelihood_estimator": "likelihood_estimator", ") likelihood_estimator (";
        "uart_bridge": "uart_bridge", ") uart_bridge (";
        "registers": "registers", ") registers (";
        "laser_guard": "laser_guard", ") laser_guard (";
    }
    "channel_", "tof_top", ": channel" {
        "tdc": "tdc", "            ) tdc (";
        "bank_0": "histogram_builder", "                ) histogram_builder (";
        "bank_1": "histogram_builder", "                ) histogram_builder (";
    }
    "tdc", "tdc", "module tdc #(" {
        "carry_chain": "carry_chain", ") carry_chain (";
        "coarse_counter": "coarse_counter", ") coarse_counter (";
        "tdc_latch": "tdc_latch", ") tdc_latch (";
        "tdc_decoder": "tdc_decoder", ") tdc_decoder (";
    }
    "vcsel_driver", "vcsel_driver", "module vcsel_driver #(" {
        "ddr_output": "ddr_output", ") ddr_output (";
    }
    "depth_estimator", "depth_estimator", "module depth_estimator #(" {
        "estimator_ctrl": "estimator_ctrl", ") estimator_ctrl (";
        "forward1": "forward1", ") forward1 (";
        "tansig": "tansig", ") tansig (";
        "forward2": "forward2", ") forward2 (";
    }
    "likelihood_estimator", "likelihood_estimator", "module likelihood_estimator #(" {
        "likelihood_memory": "likelihood_memory", ") likelihood_memory (";
        "likelihood_terms": "likelihood_terms", ") likelihood_terms (";
        "likelihood_sums": "likelihood_sums", ") likelihood_sums (";
        "likelihood_glass": "likelihood_glass", ") likelihood_glass (";
        "likelihood_pair": "likelihood_pair", ") likelihood_pair (";
        "likelihood_scan": "likelihood_scan", ") likelihood_scan (";
        "likelihood_solver": "likelihood_solver", ") likelihood_solver (";
    }
    "pll", "pll", "module pll #(" {}
    "reset_sync", "reset_sync", "module reset_sync (" {}
    "control_sync", "control_sync", "module control_sync #(" {}
    "frame_ctrl", "frame_ctrl", "module frame_ctrl #(" {}
    "lvds_output", "lvds_output", "module lvds_output (" {}
    "ddr_output", "ddr_output", "module ddr_output #(" {}
    "spad_control", "spad_control", "module spad_control #(" {}
    "carry_chain", "carry_chain", "module carry_chain #(" {}
    "coarse_counter", "coarse_counter", "module coarse_counter #(" {}
    "tdc_latch", "tdc_latch", "module tdc_latch #(" {}
    "tdc_decoder", "tdc_decoder", "module tdc_decoder #(" {}
    "tdc_calibration", "tdc_calibration", "module tdc_calibration #(" {}
    "code_preload", "code_preload", "module code_preload #(" {}
    "histogram_builder", "histogram_builder", "module histogram_builder #(" {}
    "histogram_preload", "histogram_preload", "module histogram_preload #(" {}
    "estimator_ctrl", "estimator_ctrl", "module estimator_ctrl #(" {}
    "forward1", "forward1", "module forward1 #(" {}
    "tansig", "tansig", "module tansig #(" {}
    "forward2", "forward2", "module forward2 #(" {}
    "centroid_estimator", "centroid_estimator", "module centroid_estimator #(" {}
    "likelihood_memory", "likelihood_memory", "module likelihood_memory #(" {}
    "likelihood_terms", "likelihood_terms", "module likelihood_terms #(" {}
    "likelihood_sums", "likelihood_sums", "module likelihood_sums #(" {}
    "likelihood_glass", "likelihood_glass", "module likelihood_glass #(" {}
    "likelihood_pair", "likelihood_pair", "module likelihood_pair #(" {}
    "likelihood_scan", "likelihood_scan", "module likelihood_scan #(" {}
    "likelihood_solver", "likelihood_solver", "module likelihood_solver #(" {}
    "uart_bridge", "uart_bridge", "module uart_bridge #(" {}
    "registers", "registers", "module registers #(" {}
    "laser_guard", "laser_guard", "module laser_guard #(" {}
};

/// Returns the number of the first line of a file that has a text; a file without it does not compile.
const fn line_of(file: &[u8], text: &str) -> u32 {
    let text = text.as_bytes();
    let (mut line, mut place) = (1, 0);
    while place + text.len() <= file.len() {
        let mut same = 0;
        while same < text.len() && file[place + same] == text[same] {
            same += 1;
        }
        if same == text.len() {
            return line;
        }
        if file[place] == b'\n' {
            line += 1;
        }
        place += 1;
    }
    panic!("the text is not in the Verilog")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    use super::super::every_entry;
    use super::*;

    /// Returns a line of a file of the repository, from 1.
    fn line(source: &ModuleSource, number: u32) -> String {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(source.file);
        let text = fs::read_to_string(path).unwrap();
        text.lines().nth(number as usize - 1).unwrap().trim().to_owned()
    }

    #[test]
    fn every_scope_has_the_place_of_its_module_and_of_its_instance() {
        let scopes: BTreeSet<_> = every_entry().into_iter().map(|entry| entry.scope).collect();
        assert!(scopes.len() > 30);
        for scope in &scopes {
            let mut parts = scope.split('.');
            let mut source = ModuleSource::outermost(parts.next().unwrap()).unwrap();
            for part in parts {
                let around = source;
                let (inside, at) = around.inside(part).unwrap_or_else(|| panic!("{scope}"));
                let placed = line(around, at);
                let expected = [format!(") {part} ("), format!("{} {part} (", inside.name)];
                assert!(expected.contains(&placed), "{scope}: {placed}");
                source = inside;
            }
            let declared = line(source, source.line);
            assert!(declared.starts_with(&format!("module {} ", source.name)), "{declared}");
        }
    }

    #[test]
    fn a_channel_is_the_block_that_is_generated_for_each_column() {
        let top = ModuleSource::outermost("tof_top").unwrap();
        let (channel, at) = top.inside("channel_12").unwrap();
        assert!(line(top, at).ends_with("begin : channel"));
        let (tdc, own) = channel.inside("tdc").unwrap();
        let (_, first) = top.inside("tdc").unwrap();
        assert!(tdc.name == "tdc" && own > at && first < at);
        assert!(channel.inside("bank_1").unwrap().1 > own);
        assert!(ModuleSource::outermost("spad_row").is_none());
    }
}
