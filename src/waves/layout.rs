//! Initial layout of the signals in a viewer, along the data flow.

use std::collections::BTreeSet;

use crate::hierarchy::Entry;

/// Signals below one heading.
pub(super) struct Group<'a> {
    /// Text of the heading.
    pub(super) name: &'static str,
    /// Whether the group is collapsed at first.
    pub(super) closed: bool,
    pub(super) rows: Vec<ShownSignal<'a>>,
}

/// A signal as a viewer shows it.
pub(super) struct ShownSignal<'a> {
    pub(super) entry: &'a Entry,
    /// Path below the top.
    pub(super) name: String,
    /// Whether to show the signal as a curve as well.
    pub(super) curve: bool,
}

/// Headings and their signals, in the order of the modules: paths below the top, where a final `*` matches any
/// suffix, or all signals whose [`View`](crate::kernel::signals::View) has the heading.
const FLOW: &[(&str, &[&str])] = &[
    ("Clocks and reset", &["clk_sys", "clk_laser", "rst_dsp"]),
    ("Control", &["mode", "laser_freq", "laser_en", VIEWED]),
    (
        "Laser",
        &["vcsel_driver.count", "pre_start", "vcsel_driver.laser_pulse", "laser_on", "start"],
    ),
    ("SPAD", &["spad_rst", "tdc_stop", VIEWED]),
    ("Row of SPADs", &["spad_row.spad_out_*"]),
    ("TDC", &[VIEWED, "tdc_valid", "tdc_code"]),
    ("Histogram", &["hist_valid", "hist_bin", "hist_count", VIEWED]),
    ("Estimator", &["algo_start", VIEWED]),
    ("Outputs", &["depth", "algo_done", "frame_done"]),
    (
        "Control pins",
        &["rst", "dsp_en", "dsp_rst", "locked", "clk_in", "clear", "clear_addr", "acquire"],
    ),
    ("Hidden layer", &[VIEWED]),
    ("Likelihood", &[VIEWED]),
    ("Histogram, word by word", &["histogram_builder.ram_*"]),
];
/// Placeholder for the signals whose view has the heading.
const VIEWED: &str = "";
/// Heading of the remaining signals.
const OTHER: &str = "Other signals";
/// Signals of the top that are best shown as curves.
const CURVES: [&str; 2] = ["hist_count", "depth"];
/// Number of signals above which a group is collapsed if space is short.
const FEW: usize = 7;
/// Number of signals that fit on a screen.
const SCREEN: usize = 24;

/// Groups the written signals by heading. Each value appears once, by its first name.
pub(super) fn groups(entries: &[Entry]) -> Vec<Group<'_>> {
    let mut shown = BTreeSet::new();
    let mut groups: Vec<Group<'_>> = Vec::new();
    let flow = FLOW.iter().copied().chain([(OTHER, &["*"] as &[&str])]);
    for (name, patterns) in flow {
        let mut rows = Vec::new();
        for pattern in patterns {
            for entry in entries {
                let (below, view) = (entry.below_top(), entry.signal.view);
                let is_meant = match *pattern {
                    VIEWED => view.heading == name,
                    _ => matches(&below, pattern),
                };
                if is_meant && shown.insert(entry.id) {
                    let curve = view.curve || CURVES.contains(&&*below);
                    rows.push(ShownSignal { entry, name: below, curve });
                }
            }
        }
        groups.push(Group { name, closed: false, rows });
    }
    groups.retain(|group| !group.rows.is_empty());
    if shown.len() > SCREEN {
        for group in &mut groups {
            group.closed = group.rows.len() > FEW;
        }
    }
    groups
}

fn matches(name: &str, pattern: &str) -> bool {
    match pattern.strip_suffix('*') {
        Some(start) => name.starts_with(start),
        None => name == pattern,
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::bench::params;
    use super::*;
    use crate::hierarchy::{entries, every_entry, ram_entries, row_entries};

    #[test]
    fn every_value_is_shown_once() {
        let all = [entries(&params()), ram_entries(&Default::default())].concat();
        let ids: BTreeSet<_> = all.iter().map(|entry| entry.id).collect();
        let groups = groups(&all);
        let rows: Vec<_> = groups.iter().flat_map(|group| &group.rows).collect();
        assert_eq!(rows.len(), ids.len());
        let last = groups.last().unwrap();
        assert!(last.name == OTHER && last.closed);
    }

    #[test]
    fn every_name_in_the_flow_is_a_signal() {
        let all = [every_entry(), ram_entries(&Default::default()), row_entries(30)].concat();
        let is_name = |pattern: &&&str| **pattern != VIEWED;
        let patterns = FLOW.iter().flat_map(|(_, patterns)| *patterns).chain(&CURVES);
        for pattern in patterns.filter(is_name) {
            assert!(all.iter().any(|entry| matches(&entry.below_top(), pattern)), "{pattern}");
        }
    }

    #[test]
    fn every_heading_that_a_signal_asks_for_has_a_place_for_it() {
        for Entry { signal, .. } in every_entry() {
            let heading = signal.view.heading;
            let has_place =
                |(name, patterns): &(&str, &[&str])| *name == heading && patterns.contains(&VIEWED);
            assert!(heading.is_empty() || FLOW.iter().any(has_place), "{}", signal.name);
        }
    }

    #[test]
    fn a_few_chosen_signals_are_all_in_sight() {
        let mut all = entries(&params());
        all.retain(|entry| entry.scope.ends_with(".tansig") || entry.signal.name == "weight_3");
        all.retain(|entry| entry.kind != crate::hierarchy::Kind::Input);
        let groups = groups(&all);
        let names: Vec<_> = groups.iter().map(|group| group.name).collect();
        assert_eq!(names, ["Hidden layer", OTHER]);
        assert!(groups.iter().all(|group| !group.closed));
    }
}
