//! A waveform as other programs read it.

use std::collections::BTreeMap;
use std::path::Path;

use wellen::VarRef;
use wellen::simple::{Waveform, read};

/// Changes of a signal: time [ps] and value as bits, most significant first.
pub type Changes = Vec<(u64, String)>;

/// A waveform and its signals by path.
pub struct Wave {
    pub waveform: Waveform,
    pub vars: BTreeMap<String, VarRef>,
}

impl Wave {
    pub fn open(path: &Path) -> Self {
        let mut waveform = read(path).unwrap();
        let hierarchy = waveform.hierarchy();
        let named = hierarchy.all_vars().map(|var| (hierarchy[var].full_name(hierarchy), var));
        let vars: BTreeMap<_, _> = named.collect();
        let signals: Vec<_> =
            vars.values().map(|&var| waveform.hierarchy()[var].signal_ref()).collect();
        waveform.load_signals(&signals);
        Wave { waveform, vars }
    }

    pub fn changes(&self, name: &str) -> Changes {
        let var = self.vars.get(&format!("tof_top.{name}")).or_else(|| self.vars.get(name));
        let var = *var.unwrap_or_else(|| panic!("no signal {name}"));
        let signal = self.waveform.get_signal(self.waveform.hierarchy()[var].signal_ref()).unwrap();
        let times = self.waveform.time_table();
        let changes = signal.iter_changes();
        changes.map(|(k, value)| (times[k as usize], value.to_bit_string().unwrap())).collect()
    }

    pub fn rises(&self, name: &str) -> Vec<u64> {
        self.edges(name, "0", "1")
    }

    pub fn falls(&self, name: &str) -> Vec<u64> {
        self.edges(name, "1", "0")
    }

    fn edges(&self, name: &str, from: &str, to: &str) -> Vec<u64> {
        let changes = self.changes(name);
        let pairs = changes.windows(2).filter(|pair| pair[0].1 == from && pair[1].1 == to);
        pairs.map(|pair| pair[1].0).collect()
    }
}
