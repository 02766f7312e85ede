//! The Verilog between our bench and a user's module, from what the map says.

use std::path::{Path, PathBuf};

use tofsim::error::Result;
use tofsim::files::output::write_bytes;
use tofsim::kernel::sizes::Sizes;

use crate::golden::bench::Bench;
use crate::golden::bench::allowances::Allowances;
use crate::golden::ports::Port;
use crate::golden::spec::Spec;
use crate::golden::verilog::{parameter_list, range};

use super::interface::{Interface, PortShape};
use super::map::BlockMap;

impl BlockMap {
    /// Their name of our port.
    fn theirs<'a>(&'a self, ours: &'a str) -> &'a str {
        self.ports.get(ours).map_or(ours, String::as_str)
    }

    /// Their name of our parameter; none if it is a constant inside.
    pub(super) fn parameter<'a>(&'a self, ours: &'a str) -> Option<&'a str> {
        let theirs = self.parameters.get(ours).map_or(ours, String::as_str);
        (self.design.parameters && !theirs.is_empty()).then_some(theirs)
    }

    /// Returns whether an adapter stands in for a port of ours.
    fn is_made(&self, name: &str) -> bool {
        let adapted = self.counts.is_some() || self.vector.is_some();
        adapted && ["read_en", "read_addr", "count"].contains(&name)
    }

    /// Words of their histogram.
    fn bins(&self, sizes: &Sizes) -> usize {
        self.design.bins.unwrap_or(sizes.bins as usize)
    }

    /// Width of our port in a design of that size.
    fn width(&self, spec: &Spec, port: &Port) -> u32 {
        let bins = ["histogram_builder", "histogram_preload", "code_preload"];
        match port.name.as_str() {
            "taps" | "hit_taps" => self.design.taps.map_or(port.width, |taps| taps as u32),
            "clear_addr" | "read_addr" | "tdc_code" if bins.contains(&spec.name) => {
                let width = |bins: usize| usize::BITS - (bins - 1).leading_zeros();
                self.design.bins.map_or(port.width, width)
            }
            _ => port.width,
        }
    }

    /// The ports that their module has to have.
    pub(super) fn wanted(&self, spec: &Spec, sizes: &Sizes, found: &Interface) -> Vec<Port> {
        let mut wanted = Vec::new();
        for port in spec.ports(sizes) {
            let theirs = self.theirs(&port.name);
            let optional = self.ignore.contains(&port.name) && !found.ports.contains_key(theirs);
            if !optional && !self.is_made(&port.name) {
                let width = self.width(spec, &port);
                wanted.push(Port { name: theirs.to_owned(), width, ..port });
            }
        }
        let whole = sizes.count_bits * self.bins(sizes) as u32;
        for (name, output) in [(&self.counts, true), (&self.vector, false)] {
            let meaning = "all counts";
            wanted.extend(name.clone().map(|name| Port { name, width: whole, output, meaning }));
        }
        wanted
    }

    /// Lets the bench allow what the map says, and writes the adapter into `folder`.
    ///
    /// # Errors
    /// When it cannot be written, or a latency is impossible.
    pub(super) fn apply(
        &self,
        bench: &mut Bench,
        spec: &Spec,
        found: &Interface,
        folder: &Path,
    ) -> Result<PathBuf> {
        bench.allowed = Allowances {
            delays: self.latency.clone(),
            ignored: self.ignore.iter().cloned().collect(),
            valid: self.valid.clone(),
            settle: self.settle,
            ..Allowances::default()
        };
        self.check_latencies(bench.vectors, &bench.allowed)?;
        for port in spec.ports(&bench.vectors.sizes) {
            let is_there = found.ports.contains_key(self.theirs(&port.name));
            if port.output && !is_there && !self.is_made(&port.name) {
                bench.allowed.absent.insert(port.name.clone());
            }
            let width = self.width(spec, &port);
            if width < port.width {
                bench.allowed.bits.insert(port.name, width as usize);
            }
        }
        let parameters = bench.vectors.parameters.iter().map(|(ours, _)| *ours);
        bench.constants = parameters.filter(|ours| self.parameter(ours).is_none()).collect();
        bench.module = format!("{}_adapter", spec.name);
        let path = folder.join(format!("{}.v", bench.module));
        let past: Vec<_> = bench.past.drain(..).filter(|port| !port.output).collect();
        let text = self.text(bench, spec, found, &past);
        write_bytes(&path, text)?;
        Ok(path)
    }

    /// The adapter, which drives inputs for neurons past the last as the bench does without a map.
    fn text(&self, bench: &Bench, spec: &Spec, found: &Interface, past: &[Port]) -> String {
        let ports = spec.ports(&bench.vectors.sizes);
        let declare = |port: &Port| format!("    {}", port.declaration());
        let parameter = |name| format!("    parameter {name} = 0");
        let set = |ours| Some(format!("        .{}({ours})", self.parameter(ours)?));
        let (mut lines, mut connected) = (String::new(), Vec::new());
        for port in ports.iter().filter(|port| !self.is_made(&port.name)) {
            let theirs = self.theirs(&port.name);
            if port.output && !found.ports.contains_key(theirs) {
                lines += &format!("    assign {} = {}'d0;\n", port.name, port.width);
            } else {
                let (declared, signal) = self.connection(spec, port);
                lines += &declared;
                connected.push(format!("        .{theirs}({signal})"));
            }
        }
        connected.extend(self.ties(found));
        connected.extend(past.iter().map(|port| format!("        {}", port.ones())));
        let sizes = &bench.vectors.sizes;
        let (bins, bits) = (self.bins(sizes), sizes.count_bits);
        let whole = bits * bins as u32;
        let (range, last, address) = (range(whole), bins - 1, bins.next_power_of_two().ilog2());
        if let Some(counts) = &self.counts {
            // All counts side by side, read as if they were a RAM.
            lines += &format!(include_str!("adapter/counts.v"), range = range, bits = bits);
            let (declared, signal) = words("counts", bits, found.ports.get(counts));
            lines += &declared;
            connected.push(format!("        .{counts}({signal})"));
        }
        if let Some(vector) = &self.vector {
            // Collects the histogram word by word, then starts the estimator.
            lines += &format!(
                include_str!("adapter/vector.v"),
                range = range,
                whole = whole,
                bits = bits,
                address = address,
                last = last,
                high = address - 1,
            );
            let (declared, signal) = words("vector", bits, found.ports.get(vector));
            lines += &declared;
            connected.push(format!("        .{vector}({signal})"));
        }
        format!(
            "`timescale 1ps/1fs\n`default_nettype none\n\nmodule {} {}(\n{}\n);\n{lines}\n    \
             {} {}dut (\n{}\n    );\nendmodule\n\n`default_nettype wire\n",
            bench.module,
            parameter_list(&bench.parameters().map(parameter).collect::<Vec<_>>(), ""),
            ports.iter().map(declare).collect::<Vec<_>>().join(",\n"),
            self.module(spec.name),
            parameter_list(&bench.parameters().filter_map(set).collect::<Vec<_>>(), "    "),
            connected.join(",\n"),
        )
    }

    /// Returns the declaration for a port of theirs, and its connection.
    fn connection(&self, spec: &Spec, port: &Port) -> (String, String) {
        let inverted = if self.invert.contains(&port.name) { "~" } else { "" };
        let (name, width) = (port.name.as_str(), self.width(spec, port));
        if !port.output {
            let starts = name == "algo_start" && self.vector.is_some();
            let value = fit(if starts { "go" } else { name }, port.width, width);
            return (String::new(), format!("{inverted}{value}"));
        }
        let theirs = format!("their_{name}");
        let value = fit(&theirs, width, port.width);
        let range = range(width);
        let declared =
            format!("    wire {range}{theirs};\n    assign {name} = {inverted}{value};\n");
        (declared, theirs)
    }
}

/// Returns the declaration for a port with all counts, and its connection: the vector of the adapter, or the
/// words of an unpacked array, of which the one with the lowest index is bin 0.
fn words(vector: &str, bits: u32, port: Option<&PortShape>) -> (String, String) {
    let Some(PortShape { output, words: Some((first, last)), .. }) = port else {
        return (String::new(), vector.to_owned());
    };
    let (lowest, bins) = (first.min(last), first.abs_diff(*last) + 1);
    let [word, part] =
        [format!("{vector}_words[k + {lowest}]"), format!("{vector}[{bits} * k +: {bits}]")];
    let [to, from] = if *output { [part, word] } else { [word, part] };
    let declared = format!(
        include_str!("adapter/words.v"),
        vector = vector,
        first = first,
        last = last,
        bins = bins,
        high = bits - 1,
        to = to,
        from = from,
    );
    (declared, format!("{vector}_words"))
}

/// A value of `from` bits as one of `to`.
fn fit(name: &str, from: u32, to: u32) -> String {
    match from.cmp(&to) {
        std::cmp::Ordering::Less => format!("{{{}'d0, {name}}}", to - from),
        std::cmp::Ordering::Equal => name.to_owned(),
        std::cmp::Ordering::Greater => format!("{name}[{}:0]", to - 1),
    }
}
