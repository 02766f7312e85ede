//! `tofsim completions`: what a shell needs to complete our command lines.

use clap::builder::PossibleValuesParser;
use clap::{Arg, Command};
use clap_complete::{Shell, generate};

use tofsim::error::Result;
use tofsim::network::Network;
use tofsim::scenario::{builtin, keys};
use tofsim_captures::ila::builtin::SET_UPS;
use tofsim_learn::training::recipe::Recipe;
use tofsim_rtl::golden::BLOCKS;
use tofsim_studies::plan::builtin::PLANS;

use crate::reproduce::table;

use super::terminal::print;

/// Leaves out the space after a scenario key, whose value comes next.
const NO_SPACE_AFTER_KEY: &str = r#"
_tofsim_with_keys() {
    _tofsim "$@"
    if [[ "${COMPREPLY[0]-}" == *= ]]; then compopt -o nospace 2>/dev/null; fi
}
complete -F _tofsim_with_keys -o bashdefault -o default tofsim
"#;

/// Print a completion script for a shell
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Prints the script for the whole of `command`.
pub fn run(args: &Args, command: Command) -> Result<()> {
    let items = table::items()?.into_iter().map(|item| item.id).collect();
    let mut script = Vec::new();
    generate(args.shell, &mut with_names(command, &Names::new(items)), "tofsim", &mut script);
    if args.shell == Shell::Bash {
        script.extend_from_slice(NO_SPACE_AFTER_KEY.as_bytes());
    }
    print(&String::from_utf8_lossy(&script))
}

/// Names that the program knows, by the identifiers of the arguments that take them.
struct Names(Vec<(&'static [&'static str], Vec<String>)>);

impl Names {
    fn new(items: Vec<String>) -> Self {
        fn owned<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
            names.map(str::to_owned).collect()
        }
        let of_files = |files: &[(&str, &str)]| owned(files.iter().map(|(name, _)| *name));
        Names(vec![
            (&["scenario", "instrument"], owned(builtin::scenarios().map(|(name, _)| name))),
            (&["set"], keys::keys().iter().map(|(key, _)| format!("{key}=")).collect()),
            (&["plan"], of_files(PLANS)),
            (&["block", "blocks", "without"], owned(BLOCKS.iter().map(|spec| spec.name))),
            (&["network"], owned(Network::builtin_names())),
            (&["profile"], of_files(builtin::CHAINS)),
            (&["probes"], of_files(SET_UPS)),
            (&["recipe"], owned(Recipe::builtin_names())),
            (&["items"], items),
        ])
    }

    /// Adds the names that an argument takes to those that are completed.
    fn add_to(&self, arg: Arg) -> Arg {
        let found = self.0.iter().find(|(ids, _)| ids.contains(&arg.get_id().as_str()));
        match found {
            Some((_, names)) => arg.value_parser(PossibleValuesParser::new(names)),
            None => arg,
        }
    }
}

/// Adds the names to all arguments of a command and its subcommands, for completion only.
fn with_names(command: Command, names: &Names) -> Command {
    command.mut_args(|arg| names.add_to(arg)).mut_subcommands(|command| with_names(command, names))
}
