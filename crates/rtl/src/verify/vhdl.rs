//! VHDL, converted to Verilog by GHDL's synthesis.
//!
//! The result has no parameters, so that generics are passed to GHDL. Names are the user's, but VHDL is not
//! case-sensitive: names that the bench connects are spelled as in the bench.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::iter;
use std::path::{Path, PathBuf};

use tofsim::error::{Input, Result, read_text};
use tofsim::files::output::{create_directory, write_bytes};

use crate::golden::parameters::Parameter;

use super::process::{GHDL, Limits, SHELL};
use super::rtl::mirror::Mirror;
use super::rtl::{Rtl, Source};

/// Options of GHDL's analysis: VHDL-2008, with the packages of Synopsys (`std_logic_unsigned` and the like) in `ieee`.
const OPTIONS: [&str; 2] = ["--std=08", "-fsynopsys"];

/// A generic and its value.
pub type Generic<'a> = (&'a str, &'a Parameter);

/// The design with Verilog in place of the VHDL that `module` is or names. Generics are those of `module`;
/// what is instantiated in Verilog keeps its defaults. `names` are spelt so, whatever the VHDL has.
///
/// # Errors
/// When GHDL is missing or does not take a file, or there is no such generic.
pub fn as_verilog<'a>(
    rtl: &'a Rtl,
    module: &str,
    generics: &[Generic],
    names: &[String],
    folder: &Path,
    limits: &Limits,
) -> Result<Cow<'a, Rtl>> {
    let entities = entities(rtl, module)?;
    if entities.is_empty() {
        return Ok(Cow::Borrowed(rtl));
    }
    let folder = folder.join("ghdl");
    create_directory(&folder)?;
    for (_, parameter) in generics {
        if let Parameter::Memory(memory) = parameter {
            write_bytes(&folder.join(&*memory.name), &memory.text)?;
        }
    }
    let refused = import(rtl, &folder, limits)?;
    let mut modules = BTreeMap::new();
    for entity in &entities {
        let generics = if entity == module { generics } else { &[] };
        let text = synthesise(rtl, entity, generics, &refused, &folder, limits)?;
        let text = respelt(&with_binary_literals(&text), names.iter().chain([entity]));
        for module in text.split_inclusive("endmodule\n") {
            let name = module
                .trim_start()
                .strip_prefix("module ")
                .and_then(|rest| rest.split_whitespace().next());
            modules.insert(name.unwrap_or_default().to_owned(), module.to_owned());
        }
    }
    let path = folder.join("vhdl.v");
    write_bytes(&path, modules.into_values().collect::<String>())?;
    let mut made = rtl.clone();
    made.files.push(Source::read(&path, false)?);
    Ok(Cow::Owned(made))
}

/// The module if it is an entity, or else the entities that the Verilog names which it needs.
fn entities(rtl: &Rtl, module: &str) -> Result<Vec<String>> {
    if rtl.has_entity(module) {
        return Ok(vec![module.to_owned()]);
    }
    if rtl.vhdl.is_empty() {
        return Ok(Vec::new());
    }
    let needed = rtl.needed(module)?;
    let words = needed.iter().flat_map(|source| &source.scan.words);
    let mut entities: Vec<_> = words.filter(|word| rtl.has_entity(word)).cloned().collect();
    entities.sort_unstable();
    entities.dedup();
    Ok(entities)
}

/// Tells GHDL of all files, which it then analyses in an order of its own; what it says of those that it
/// does not take, which need not matter.
fn import(rtl: &Rtl, folder: &Path, limits: &Limits) -> Result<String> {
    let paths = rtl.vhdl.iter().map(|file| file.path.clone()).collect();
    let mirror = Mirror::of(&paths, &unmarked(folder))?;
    let place = |file: &Source| match &mirror {
        Some(mirror) => OsString::from(mirror.path(&file.path)),
        None => OsString::from(&file.path),
    };
    let run = |files: &[Source]| {
        let options = iter::once("-i").chain(OPTIONS).map(OsString::from);
        GHDL.run(folder, options.chain(files.iter().map(place)), limits)
    };
    if run(&rtl.vhdl)?.success() {
        return Ok(String::new());
    }
    // One that it does not take keeps it from taking any.
    let mut refused = String::new();
    for file in &rtl.vhdl {
        let finished = run(std::slice::from_ref(file))?;
        if !finished.success() {
            refused += &finished.output;
        }
    }
    Ok(refused)
}

/// Folder for copies of files without a byte order mark.
fn unmarked(folder: &Path) -> PathBuf {
    folder.join("unmarked")
}

fn synthesise(
    rtl: &Rtl,
    entity: &str,
    generics: &[Generic],
    refused: &str,
    folder: &Path,
    limits: &Limits,
) -> Result<String> {
    const OUTPUT: &str = "synthesised.v";
    // Without it, GHDL 2.0 takes the body of a package for older than the package.
    let made = GHDL.run(folder, iter::once("-m").chain(OPTIONS).chain([entity]), limits)?;
    // What GHDL says must not come between the Verilog.
    let script = format!("exec \"$@\" > {OUTPUT}");
    let set = generics.iter().map(|(name, value)| format!("-g{name}={}", value.vhdl()));
    let args = ["-c", &script, "sh", GHDL.program, "synth", "--latches", "--out=verilog"];
    let args = args.into_iter().chain(OPTIONS).map(str::to_owned);
    let args = args.chain(set).chain([entity.to_owned()]);
    let finished = SHELL.run(folder, args, limits)?;
    if finished.success() {
        return read_text(&folder.join(OUTPUT));
    }
    let unknown = |line: &str| {
        let name = line.split_once("no generic \"")?.1.split('"').next()?;
        generics.iter().map(|(theirs, _)| *theirs).find(|theirs| theirs.eq_ignore_ascii_case(name))
    };
    if let Some(name) = finished.output.lines().find_map(unknown) {
        let field = format!("entity {entity}, generic {name}");
        return Err(Input::new(&rtl.source, "no such generic").field(field).into());
    }
    let what = match finished.end.killed() {
        None => "GHDL does not synthesise it".to_owned(),
        Some(why) => format!("GHDL {why}"),
    };
    let message: Vec<_> = (refused.lines())
        .chain(made.output.lines().filter(|_| !made.success()))
        .chain(finished.output.lines())
        .take(12)
        .collect();
    let message = message.join("\n").replace(&unmarked(folder).display().to_string(), "");
    let expected = format!("{what}:\n{message}");
    Err(Input::new(&rtl.source, expected).field("entity").value(entity).into())
}

/// GHDL 2.0 writes a constant that was a memory as the text of its bits, which Verilog takes for characters.
fn with_binary_literals(text: &str) -> String {
    let mut parts = text.split('"');
    let mut fixed = parts.next().unwrap_or_default().to_owned();
    let mut is_text = true;
    for part in parts {
        let is_bits = !part.is_empty() && part.bytes().all(|byte| b"01xzXZ".contains(&byte));
        match (is_text, is_bits) {
            (true, true) => fixed += &format!("{}'b{part}", part.len()),
            (true, false) => fixed += &format!("\"{part}\""),
            (false, _) => fixed += part,
        }
        is_text = !is_text;
    }
    fixed
}

/// Each word that is one of the names in other letters, as that name.
fn respelt<'a>(text: &str, names: impl Iterator<Item = &'a String>) -> String {
    let names: BTreeMap<_, _> = names.map(|name| (name.to_lowercase(), name.as_str())).collect();
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut result = String::with_capacity(text.len());
    for piece in text.split_inclusive(|c| !is_word(c)) {
        let word = piece.trim_end_matches(|c| !is_word(c));
        result += names.get(&word.to_lowercase()).copied().unwrap_or(word);
        result += &piece[word.len()..];
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_get_the_bench_s_letters_and_other_words_stay() {
        let names = ["count".to_owned(), "Histogram".to_owned()];
        let text = "module HISTOGRAM (output [3:0] Count);\n wire Counts = n1_count; // COUNT";
        let expected = "module Histogram (output [3:0] count);\n wire Counts = n1_count; // count";
        assert_eq!(respelt(text, names.iter()), expected);
    }

    #[test]
    fn texts_of_bits_are_numbers_and_other_texts_stay() {
        let text = "a <= \"0011x\"; $display(\"ok\"); b = \"1\"; c";
        assert_eq!(with_binary_literals(text), "a <= 5'b0011x; $display(\"ok\"); b = 1'b1; c");
    }
}
