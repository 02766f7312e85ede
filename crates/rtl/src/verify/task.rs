//! Checks to be made, and their order.

use tofsim::error::Result;
use tofsim::hierarchy;

use crate::golden::configuration::Configuration;
use crate::golden::setting::Setting;
use crate::golden::spec::Spec;

use super::map::RtlMap;
use super::report::BlockReport;
use super::verdict::Verdict;

/// One thing to check.
#[derive(Clone, Debug)]
pub struct Task {
    /// The block, and what of it if that is not its own bench as the scenario has it.
    pub name: String,
    /// The block.
    pub spec: &'static Spec,
    /// Settings of its vectors.
    pub setting: Setting,
    /// Configuration beside the one that the scenario sets.
    pub configuration: Option<&'static Configuration>,
}

/// Name of the configuration that is a block as the scenario has it.
pub const DEFAULT: &str = "default";

impl Task {
    /// Returns a block's configurations: the one of that name, or all.
    ///
    /// # Errors
    /// When a scenario cannot be loaded.
    pub fn every(
        spec: &'static Spec,
        configuration: Option<&str>,
        setting: &Setting,
        map: Option<&RtlMap>,
    ) -> Result<Vec<Self>> {
        let own = Task::new(spec, setting, map);
        let mut tasks = own.others(configuration)?;
        if configuration.is_none_or(|name| name == DEFAULT) {
            tasks.insert(0, own);
        }
        Ok(tasks)
    }

    /// A block as the scenario has it, fitted to the design that a map describes.
    pub fn new(spec: &'static Spec, setting: &Setting, map: Option<&RtlMap>) -> Self {
        let setting = map.map_or(setting.clone(), |map| map.fit(spec, setting));
        Task { name: spec.name.to_owned(), spec, setting, configuration: None }
    }

    /// Returns what the block can be besides, or only what has that name: nothing if the scenario is one of the
    /// user's, who then says what the block is.
    fn others(&self, only: Option<&str>) -> Result<Vec<Self>> {
        let configurations =
            if self.setting.as_configured { &[] } else { self.spec.configurations };
        let chosen = configurations.iter().filter(|it| only.is_none_or(|name| name == it.name));
        let other = |configuration: &'static Configuration| {
            Ok(Task {
                name: format!("{}.{}", self.spec.name, configuration.name),
                setting: configuration.setting(&self.setting)?,
                configuration: Some(configuration),
                spec: self.spec,
            })
        };
        chosen.map(other).collect()
    }

    /// Returns how far its block is below the top.
    fn depth(&self) -> usize {
        self.spec.path().matches('.').count()
    }

    /// Returns whether its block contains that of another.
    fn contains(&self, other: &Task) -> bool {
        let (outer, inner) = (self.spec.path(), other.spec.path());
        outer != inner && hierarchy::within(&inner, &outer)
    }
}

/// Checks all, those on the inside first: a block in which something hangs is not run.
///
/// `each` runs the check of every task that it is given, in parallel if it likes.
///
/// # Errors
/// The first task's of those furthest inside, whichever fails first in time.
pub fn run_all(
    tasks: &[Task],
    each: impl Fn(&[&Task]) -> Vec<Result<BlockReport>>,
) -> Result<Vec<BlockReport>> {
    let mut reports: Vec<Option<BlockReport>> = vec![None; tasks.len()];
    let deepest = tasks.iter().map(Task::depth).max().unwrap_or(0);
    for depth in (0..=deepest).rev() {
        let mut level: Vec<usize> = Vec::new();
        for (n, task) in tasks.iter().enumerate().filter(|(_, task)| task.depth() == depth) {
            let hangs = |(inner, report): (&Task, &Option<BlockReport>)| {
                let hangs = report.as_ref().is_some_and(BlockReport::hangs);
                (hangs && task.contains(inner)).then(|| inner.name.clone())
            };
            match tasks.iter().zip(&reports).find_map(hangs) {
                Some(inner) => {
                    let reason = format!("{inner}, which is in it, does not come to an end");
                    let verdict = Verdict::NotRun { reason };
                    reports[n] = Some(BlockReport::without_run(&task.name, verdict));
                }
                None => level.push(n),
            }
        }
        let tasks: Vec<_> = level.iter().map(|n| &tasks[*n]).collect();
        for (n, report) in level.into_iter().zip(each(&tasks)) {
            reports[n] = Some(report?);
        }
    }
    Ok(reports.into_iter().flatten().collect())
}
