use std::sync::Arc;

use bitvec::prelude::*;

use tofsim::Setup;

use super::*;
use crate::golden::setting::{Constants, Setting};
use crate::golden::spec::Vectors;
use crate::golden::table::{Column, Table};
use crate::golden::timing::{self, Timing};

/// Vectors of a block whose constants are those of the scenario.
fn vectors(name: &str, setup: &Setup) -> Vectors {
    let spec = blocks::find(name).unwrap();
    let cycles = (name != "tof_top").then_some(8000);
    let setting = Setting { constants: Constants::All, cycles, ..Setting::new(setup.clone()) };
    (spec.record)(spec, &setting).unwrap()
}

/// The edge after each sample of a cycle.
fn edges(timing: &Timing) -> Vec<Option<Edge>> {
    match *timing {
        timing::CLK | timing::CLK_SYS => vec![Some(Edge::Rise)],
        timing::CLK_LASER => vec![Some(Edge::Fall), Some(Edge::Rise)],
        timing::BOTH | timing::OWN_WITH_RESET => {
            [Edge::Fall, Edge::Middle, Edge::Fall, Edge::Rise].map(Some).into()
        }
        _ => vec![None; timing.samples()],
    }
}

/// Puts a column of a row of vectors into the place of its port.
fn copy(words: &mut [u32], place: &PortBits, row: &BitSlice<u64, Lsb0>, column: &Column) {
    for (step, bits) in row[column.low..column.low + column.width].chunks(64).enumerate() {
        layout::put(words, place.low + 64 * step, bits.len(), bits.load_le());
    }
}

/// A line of a block's inputs from one of its stimulus; a port that has changed within the cycle is in another column.
fn inputs(
    block: &Block,
    vectors: &Vectors,
    row: usize,
    late: Option<(&str, &str)>,
    count: u64,
) -> Vec<u32> {
    let [layout, _] = block.layouts();
    let mut words = vec![0; layout.words()];
    for place in layout.places() {
        let name = late.filter(|(port, _)| place.name == *port).map_or(&*place.name, |late| late.1);
        let columns = vectors.stimulus.columns();
        let Some(column) = columns.iter().find(|column| column.name == *name) else {
            if name == "count" {
                layout::put(&mut words, place.low, place.width, count);
            }
            continue;
        };
        copy(&mut words, place, vectors.stimulus.row(row), column);
    }
    words
}

/// The count that the bench's memory has for what an estimator reads.
fn count(vectors: &Vectors, row: usize) -> u64 {
    let value = |table: &Table, name: &str| {
        let column = table.columns().iter().position(|column| column.name == name)?;
        u64::from_str_radix(&table.hex(row, column), 16).ok()
    };
    let Some(memory) = &vectors.bench_memory else { return 0 };
    let histogram = value(&vectors.stimulus, "histogram").unwrap();
    let [reads, address] =
        ["read_en", "read_addr"].map(|name| value(&vectors.expected, name).unwrap());
    let bins = u64::from(vectors.sizes.bins);
    let word = memory.text.split_whitespace().filter(|word| !word.starts_with("//"));
    match reads {
        0 => 0,
        _ => u64::from_str_radix(
            word.clone().nth((histogram * bins + address) as usize).unwrap(),
            16,
        )
        .unwrap(),
    }
}

/// Takes a block through its own vectors, but for `fault`; the first mismatch.
fn first_mismatch(
    name: &str,
    (scenario, set): (&str, &[&str]),
    fault: Option<usize>,
) -> Option<String> {
    let setup = Arc::new(Setup::load(scenario, set).unwrap());
    let vectors = vectors(name, &setup);
    let mut block = Block::new(setup, name).unwrap();
    let (timing, mut stops) = (vectors.spec.timing, vectors.stops.iter().peekable());
    let edges = edges(&timing);
    for row in 0..vectors.stimulus.rows() {
        let count = count(&vectors, row);
        for (sample, edge) in edges.iter().enumerate() {
            let now = vectors.edge(row) - timing.before_edge(sample, vectors.pll.cycle);
            while let Some(&at) = stops.next_if(|at| **at <= now) {
                let level = !block.top.pins.tdc_stop;
                block.stop(at, level);
            }
            let late = timing.steps[..=sample].iter().find_map(|step| step.late);
            let inputs = inputs(&block, &vectors, row, late, count);
            let look = if edge.is_some() { now } else { now - timing::ASIDE };
            block.outputs(look, &inputs).unwrap();
            let mut got = block.outputs.words.clone();
            let columns = vectors.expected.columns().iter();
            for column in columns.filter(|column| !column.internal && column.sample == sample) {
                let place = block.outputs.layout.find(&column.name).unwrap();
                copy(&mut got, place, vectors.expected.row(row), column);
            }
            if fault == Some(row) {
                got[0] ^= 1;
            }
            if let Some(Mismatch { port, expected, got }) = block.mismatches(&got, &[]).first() {
                return Some(format!("{name}, {row}.{sample}: {port}: {expected}, {got}"));
            }
            if let Some(edge) = edge
                && (row > 0 || sample + 1 == edges.len())
            {
                block.edge(*edge, now, &inputs).unwrap();
            }
        }
    }
    None
}

#[test]
fn a_block_by_itself_does_what_its_vectors_say() {
    let mut wrong = Vec::new();
    // Those of a host are in no run.
    for spec in BLOCKS.iter().filter(|spec| spec.model.is_some()) {
        let set: (_, &[&str]) = match spec.name {
            "frame_ctrl" => ("kc705", &["firmware.shots_per_frame=3"]),
            "code_preload" => ("histogram_validation", &[]),
            "histogram_preload" => ("estimator_validation", &[]),
            "tdc_calibration" => ("kc705", &["tdc.recalibrate_frames=1"]),
            _ => ("kc705", &[]),
        };
        wrong.extend(first_mismatch(spec.name, set, None));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_difference_is_seen_where_it_is() {
    let found = first_mismatch("spad_control", ("kc705", &[]), Some(100)).unwrap();
    assert_eq!(found, "spad_control, 100.0: spad_sel: 0000000001, 0000000000");
}
