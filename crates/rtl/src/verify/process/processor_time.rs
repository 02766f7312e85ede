//! Processor time of other programs, where the system tells it (Linux).

use std::fs;
use std::time::Duration;

/// Fields of `/proc/PID/stat` after the name in brackets: the group of processes.
const GROUP: usize = 2;
/// User and system time of the process, and of the children that it has waited for [1/100 s].
const TIMES: std::ops::Range<usize> = 11..15;

/// Processor time that a process has had, with the children that it has waited for.
pub fn of_process(id: u32) -> Option<Duration> {
    time(&fields(id)?)
}

/// Processor time that the processes of a group have had, whose leader still runs.
pub fn of_group(leader: u32) -> Option<Duration> {
    let leader = leader.to_string();
    let processes = fs::read_dir("/proc").ok()?.flatten();
    let numbers = processes.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    let members = numbers.filter_map(fields).filter(|fields| fields.get(GROUP) == Some(&leader));
    // One that ends in between has its time in its parent's.
    let times: Vec<_> = members.filter_map(|fields| time(&fields)).collect();
    (!times.is_empty()).then(|| times.into_iter().sum())
}

fn fields(id: u32) -> Option<Vec<String>> {
    let stat = fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    Some(stat.rsplit_once(')')?.1.split_whitespace().map(str::to_owned).collect())
}

fn time(fields: &[String]) -> Option<Duration> {
    let ticks = fields.get(TIMES)?.iter().map(|field| field.parse::<u64>().ok());
    Some(Duration::from_millis(10 * ticks.sum::<Option<u64>>()?))
}
