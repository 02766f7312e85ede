//! The longest way from register to register through a netlist.

use std::collections::{BTreeSet, HashMap};

use serde::{Deserialize, Serialize};

use super::delays::Delays;
use super::netlist::{Bit, Netlist};

/// A critical path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TimedPath {
    /// The register that it begins at.
    pub from: String,
    /// The register that it ends at.
    pub to: String,
    /// Its length [ns].
    pub ns: f64,
    /// Part of it that is routing [ns].
    pub routing_ns: f64,
    /// Cells between the two, each with the net at its output.
    pub hops: Vec<Hop>,
}

/// A cell on a path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Hop {
    /// Its type, such as `LUT6`, or its name where that says more.
    pub cell: String,
    /// The net behind it.
    pub net: String,
    /// Delay of the cell [ns].
    pub cell_ns: f64,
    /// Delay of the net [ns].
    pub net_ns: f64,
}

/// A way through a cell, from net to net.
struct Arc {
    cell: usize,
    to: Bit,
    ps: u32,
    routed: bool,
}

/// An input that a register samples.
struct End {
    cell: usize,
    port: &'static str,
    bit: Bit,
    ps: u32,
    routed: bool,
}

/// A netlist, as its longest path is looked for.
pub struct TimingGraph<'a> {
    cells: Vec<(&'a str, &'a str)>,
    names: HashMap<Bit, String>,
    starts: HashMap<Bit, (u32, usize)>,
    arcs: HashMap<Bit, Vec<Arc>>,
    ends: Vec<End>,
    /// Types of cells without delays.
    pub unknown: BTreeSet<&'a str>,
}

impl<'a> TimingGraph<'a> {
    /// Prepares a netlist.
    pub fn new(netlist: &'a Netlist) -> Self {
        let mut graph = TimingGraph {
            cells: Vec::new(),
            names: netlist.names(),
            starts: HashMap::new(),
            arcs: HashMap::new(),
            ends: Vec::new(),
            unknown: BTreeSet::new(),
        };
        for (number, (name, cell)) in netlist.cells.iter().enumerate() {
            graph.cells.push((name, &cell.kind));
            let Some(delays) = Delays::of(cell) else {
                graph.unknown.insert(&cell.kind);
                continue;
            };
            let bit = |(port, index): (&str, usize)| cell.bits(port).nth(index).flatten();
            let routed = |port: &str| !delays.direct.contains(&port);
            for (port, ps) in &delays.starts {
                let bits = cell.bits(port).flatten();
                graph.starts.extend(bits.map(|bit| (bit, (*ps, number))));
            }
            for (port, ps) in &delays.ends {
                let end = |bit| End { cell: number, port, bit, ps: *ps, routed: routed(port) };
                graph.ends.extend(cell.bits(port).flatten().map(end));
            }
            let mut arc = |from: Option<Bit>, to: Option<Bit>, ps, routed| {
                if let (Some(from), Some(to)) = (from, to) {
                    let arc = Arc { cell: number, to, ps, routed };
                    graph.arcs.entry(from).or_default().push(arc);
                }
            };
            for (from, to, ps) in &delays.between {
                arc(bit(*from), bit(*to), *ps, routed(from.0));
            }
            for (from, to, ps) in &delays.through {
                for from_bit in cell.bits(from) {
                    cell.bits(to).for_each(|to_bit| arc(from_bit, to_bit, *ps, routed(from)));
                }
            }
        }
        graph
    }

    /// The longest path if each routed net takes so long [ps]; none where no register follows another. Nets of
    /// a loop without a register are left out.
    pub fn longest(&self, net_ps: u32) -> Option<TimedPath> {
        let mut missing: HashMap<Bit, usize> = HashMap::new();
        for arc in self.arcs.values().flatten() {
            *missing.entry(arc.to).or_default() += 1;
        }
        let mut arrival: HashMap<Bit, u32> =
            self.starts.iter().map(|(bit, at)| (*bit, at.0)).collect();
        let mut before: HashMap<Bit, (Bit, &Arc)> = HashMap::new();
        let sources = self.arcs.keys().chain(self.starts.keys());
        let mut open: Vec<Bit> =
            sources.filter(|bit| !missing.contains_key(*bit)).copied().collect();
        open.sort_unstable();
        open.dedup();
        while let Some(from) = open.pop() {
            for arc in self.arcs.get(&from).into_iter().flatten() {
                if let Some(at) = arrival.get(&from) {
                    let at = at + arc.ps + if arc.routed { net_ps } else { 0 };
                    if arrival.get(&arc.to).is_none_or(|known| at > *known) {
                        arrival.insert(arc.to, at);
                        before.insert(arc.to, (from, arc));
                    }
                }
                let left = missing.entry(arc.to).or_default();
                *left -= 1;
                if *left == 0 {
                    open.push(arc.to);
                }
            }
        }
        let length = |end: &&End| {
            let at = arrival.get(&end.bit)? + end.ps + if end.routed { net_ps } else { 0 };
            Some((at, end.bit))
        };
        let end = self.ends.iter().filter(|end| length(end).is_some()).max_by_key(length)?;
        Some(self.path(end, length(&end)?.0, net_ps, &before))
    }

    fn path(
        &self,
        end: &End,
        length: u32,
        net_ps: u32,
        before: &HashMap<Bit, (Bit, &Arc)>,
    ) -> TimedPath {
        let ns = |ps: u32| f64::from(ps) / 1000.0;
        let net = |routed: bool| ns(if routed { net_ps } else { 0 });
        let name = |bit: &Bit| self.names.get(bit).cloned().unwrap_or_default();
        let (mut hops, mut bit, mut routed) = (Vec::new(), end.bit, end.routed);
        while let Some((from, arc)) = before.get(&bit) {
            let cell = self.cells[arc.cell].1.to_owned();
            hops.push(Hop { cell, net: name(&bit), cell_ns: ns(arc.ps), net_ns: net(routed) });
            (bit, routed) = (*from, arc.routed);
        }
        let (clock, cell) = self.starts.get(&bit).copied().unwrap_or_default();
        let cell = self.cells[cell].1.to_owned();
        hops.push(Hop { cell, net: name(&bit), cell_ns: ns(clock), net_ns: net(routed) });
        hops.reverse();
        let (cell, kind) = self.cells[end.cell];
        TimedPath {
            from: name(&bit),
            to: format!("{cell}.{} ({kind})", end.port),
            ns: ns(length),
            routing_ns: hops.iter().map(|hop| hop.net_ns).sum(),
            hops,
        }
    }
}

impl TimedPath {
    /// Cells between the two registers.
    pub fn levels(&self) -> usize {
        self.hops.len().saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two flip-flops with a LUT and a carry between them; the carry has a wire of its own to the next one.
    const NETLIST: &str = r#"{
        "cells": {
            "a": {"type": "FDRE", "connections": {"C": [1], "D": [2], "Q": [3]}},
            "lut": {"type": "LUT2", "connections": {"I0": [3], "I1": [2], "O": [4]}},
            "low": {"type": "CARRY4", "connections": {
                "S": [4, "0", "0", "0"], "CI": ["0"], "CO": [5, 6, 7, 8]}},
            "high": {"type": "CARRY4", "connections": {
                "S": ["0", "0", "0", "0"], "CI": [8], "O": [9, 10, 11, 12]}},
            "b": {"type": "FDRE", "connections": {"C": [1], "D": [12], "Q": [13]}},
            "loop": {"type": "LUT1", "connections": {"I0": [14], "O": [14]}}
        },
        "netnames": {
            "start": {"bits": [3]}, "$made$up": {"bits": [4]}, "dut.sum": {"bits": [9, 10, 11, 12]}
        }
    }"#;

    #[test]
    fn the_longest_path_has_the_delays_of_its_cells_and_its_routed_nets() {
        let netlist: Netlist = serde_json::from_str(NETLIST).unwrap();
        let graph = TimingGraph::new(&netlist);
        let path = graph.longest(600).unwrap();
        // FF, LUT, S[0] to CO[3], CI to O[3]; routed: to the LUT, to S, to D, but not from carry to carry.
        let cells = 0.303 + 0.127 + 0.508 + 0.313;
        assert!((path.ns - (cells + 3.0 * 0.6)).abs() < 1e-9, "{path:#?}");
        assert!((path.routing_ns - 1.8).abs() < 1e-9, "{path:#?}");
        assert_eq!((path.from.as_str(), path.to.as_str()), ("start", "b.D (FDRE)"));
        assert_eq!(path.levels(), 3);
        assert_eq!(path.hops.last().unwrap().net, "dut.sum[3]");
    }
}
