//! `tofsim board set`: control signals and registers by name.

use serde_json::{Value, json};

use tofsim::error::{Input, Result};
use tofsim::firmware::registers::map::ARM;
use tofsim_board::names::Setting;

use crate::report::writer::{Findings, Report};
use crate::text::table::facts;
use crate::verbs::terminal::Console;

use super::connection::PortArgs;

/// What is wrong with an assignment stands behind this name.
const SOURCE: &str = "board set";

/// Set control signals and registers of a board by name
///
/// The laser cannot be armed here, because the firmware disarms it when the command has ended: use `board run --laser`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim board set laser_freq=2 mode=1 --port /dev/ttyUSB0\n  \
    tofsim board set scratch=0x12345678 --port /dev/ttyUSB0\n  \
    tofsim board set arm=0 --port /dev/ttyUSB0          disarm")]
pub struct Args {
    /// Bit or field of `control` (laser_en, dsp_en, dsp_rst, mode, laser_freq, ring_on, free_running), or writable
    /// register; decimal, or hexadecimal after 0x
    #[arg(required = true, value_name = "KEY=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    port: PortArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// A value before and after.
struct Change {
    setting: Setting,
    before: u32,
    after: u32,
}

struct Changes {
    port: String,
    changes: Vec<Change>,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let wanted: Vec<_> = args.set.iter().map(|text| parse(text)).collect::<Result<_>>()?;
    let mut board = args.port.connect()?;
    let change = |(setting, value)| {
        let before = board.setting(setting)?;
        board.set(setting, value)?;
        Ok(Change { setting, before, after: board.setting(setting)? })
    };
    let changes = wanted.into_iter().map(change).collect::<Result<_>>()?;
    let changes = Changes { port: board.port().to_owned(), changes };
    Report::without_record(changes).deliver(None, args.json, console)
}

fn parse(text: &str) -> Result<(Setting, u32)> {
    let Some((name, value)) = text.split_once('=') else {
        return Err(Input::new(SOURCE, "expected KEY=VALUE").value(text).into());
    };
    let setting = Setting::named(SOURCE, name)?;
    let value = setting.value(SOURCE, value)?;
    if setting == Setting::Register(ARM) && value != 0 {
        let expected = "expected 0: the firmware disarms the laser when this command has ended; use \
            `tofsim board run --laser`";
        return Err(Input::new(SOURCE, expected).field(name).value(value).into());
    }
    Ok((setting, value))
}

impl Findings for Changes {
    const SCHEMA: &'static str = "tofsim.board_set/1";

    fn json(&self) -> Value {
        let change = |change: &Change| json!({ "name": change.setting.name(), "before": change.before, "after": change.after });
        json!({ "port": self.port, "set": self.changes.iter().map(change).collect::<Value>() })
    }

    fn text(&self) -> String {
        let row = |change: &Change| {
            let (name, before, after) = (change.setting.name(), change.before, change.after);
            (name, format!("{before} -> {after}"))
        };
        format!("{}\n", facts(self.changes.iter().map(row)))
    }
}
