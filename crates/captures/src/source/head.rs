//! Header of a VCD, rewritten to what the waveform library understands.
//!
//! wellen 0.25.7 makes a tab or a line break before a range part of the name, ignores what follows
//! `$enddefinitions $end` on its line, prints attributes on standard output, and panics on a second `$timescale`, on
//! words of a signal that is not declared as a string, and on an enumeration without a table.

mod declaration;
mod words;

use std::collections::HashSet;
use std::io::BufRead;
use std::path::Path;

use tofsim::error::{Error, Input, Result};
use tofsim::waves::dump::UNITS;

use super::spliced::Piece;
use super::tick::Tick;

use declaration::Wrong;
pub(super) use declaration::{Values, Variable};
pub(super) use words::HeadWords;

/// Commands that are passed on, in the order of the standard.
const COMMANDS: [&str; 5] = ["$version", "$timescale", "$scope", "$upscope", "$var"];
/// Commands that are left out.
const LEFT_OUT: [&str; 4] = ["$date", "$comment", "$attrbegin", "$attrend"];
const END: &[u8] = b"$end";

/// Attribute with the type of the next signal, and the number of one that is none of VHDL's, some of which the library
/// prints.
const VALUE_TYPE: [&[u8]; 2] = [b"misc", b"02"];
const PLAIN: &[u8] = b"0";
/// Attribute with the names of an enumeration's values, or with the number of such a table.
const ENUMERATION: [&[u8]; 2] = [b"misc", b"07"];

/// Header of a VCD.
#[derive(Debug, Default)]
pub(super) struct Head {
    /// Text for the library.
    text: Vec<u8>,
    /// Number of bytes of the file that it replaces.
    length: u64,
    /// Line of the time scale.
    scale: Option<usize>,
    /// Numbers of the tables of names.
    tables: HashSet<Vec<u8>>,
    /// Type of the next signal.
    value_type: Vec<u8>,
}

impl Head {
    /// Reads the header of the file at `path`, and calls `declared` with the code of each signal and its declaration;
    /// the signals with the codes `texts` have words.
    ///
    /// # Errors
    /// If it is invalid; with the line.
    pub(super) fn read<R: BufRead>(
        path: &Path,
        words: &mut HeadWords<R>,
        texts: &HashSet<Vec<u8>>,
        mut declared: impl FnMut(&[u8], Variable),
    ) -> Result<Head> {
        let io = |error| Error::io(path, "read")(error);
        let mut head = Head::default();
        loop {
            let Some(command) = words.next().map_err(io)? else {
                let expected = "ends before $enddefinitions";
                return Err(Input::new(path.display(), expected).at(words.line, 1).into());
            };
            let (line, name) = (words.line, String::from_utf8_lossy(&command));
            let fault = |expected: String| Input::new(path.display(), expected).at(line, 1);
            let is_end = name == "$enddefinitions";
            if !is_end && !COMMANDS.iter().chain(&LEFT_OUT).any(|known| *known == name) {
                let expected = format!("expected {} or $enddefinitions", COMMANDS.join(", "));
                return Err(fault(expected).value(name).into());
            }
            let mut body = Vec::new();
            loop {
                match words.next().map_err(io)? {
                    Some(word) if word == END => break,
                    // The library ends a command there, and would read others from its text.
                    Some(word) if word.windows(END.len()).any(|part| part == END) => {
                        let word = String::from_utf8_lossy(&word).into_owned();
                        return Err(fault("expected blanks around $end".into()).value(word).into());
                    }
                    Some(word) => body.push(word),
                    None => return Err(fault("expected $end".into()).field(name).into()),
                }
            }
            match &name[..] {
                "$var" => {
                    let variable = Variable::parse(&mut body, texts);
                    let variable = variable.map_err(|found| found.of(&fault))?;
                    declared(&body[2], variable);
                    head.text.append(&mut head.value_type);
                }
                "$timescale" => head.scale(line, &body).map_err(|found| found.of(&fault))?,
                "$scope" | "$upscope" => head.value_type.clear(),
                "$attrbegin" if is_plain_type(&body) => {
                    let words = body.join(&b' ');
                    head.value_type = [b"$attrbegin ", &words[..], b" $end\n"].concat();
                }
                _ => {}
            }
            if !LEFT_OUT.contains(&&name[..]) || (name == "$attrbegin" && head.is_table(&body)) {
                head.text.extend_from_slice(&command);
                for word in body.iter().map(Vec::as_slice).chain([END]) {
                    head.text.push(b' ');
                    head.text.extend_from_slice(word);
                }
                head.text.push(b'\n');
            }
            if is_end {
                head.length = words.place;
                return Ok(head);
            }
        }
    }

    /// Returns the file with this header in place of its own.
    pub(super) fn pieces(self) -> [Piece; 2] {
        [Piece::New(self.text), Piece::Kept(self.length..u64::MAX)]
    }

    /// Returns whether an attribute is a table of names, or the number of one, as the library understands it.
    fn is_table(&mut self, body: &[Vec<u8>]) -> bool {
        let [kind, subtype, name, rest @ ..] = body else { return false };
        if [&kind[..], &subtype[..]] != ENUMERATION {
            return false;
        }
        match rest {
            [number] if name == b"\"\"" => self.tables.contains(number),
            [count, names @ .., number] if name != b"\"\"" => {
                let parse = |word: &[u8]| std::str::from_utf8(word).ok()?.parse::<u64>().ok();
                let is_whole = parse(count).and_then(|count| count.checked_mul(2))
                    == Some(names.len() as u64)
                    && names.iter().all(|name| std::str::from_utf8(name).is_ok());
                let is_it =
                    is_whole && parse(number).is_some() && std::str::from_utf8(name).is_ok();
                if is_it {
                    self.tables.insert(number.clone());
                }
                is_it
            }
            _ => false,
        }
    }

    /// Checks the time scale.
    fn scale(&mut self, line: usize, body: &[Vec<u8>]) -> std::result::Result<(), Wrong> {
        let text = String::from_utf8_lossy(&body.concat()).into_owned();
        if let Some(first) = self.scale {
            let expected = format!("expected one time scale, and line {first} has it");
            return Err(Wrong::new("$timescale", text, expected));
        }
        self.scale = Some(line);
        let unit = text.trim_start_matches(|digit: char| digit.is_ascii_digit());
        let factor = text[..text.len() - unit.len()].parse().ok();
        let exponent =
            UNITS.iter().find(|(_, known)| *known == unit).map(|(exponent, _)| *exponent);
        let tick = factor.zip(exponent).and_then(|(factor, exponent)| Tick::new(factor, exponent));
        if tick.is_none() {
            let expected = "expected a number and one of zs, as, fs, ps, ns, us, ms, s";
            return Err(Wrong::new("$timescale", text, expected));
        }
        Ok(())
    }
}

/// Returns whether an attribute is a type that is none of VHDL's, as the library understands it.
fn is_plain_type(body: &[Vec<u8>]) -> bool {
    match body {
        [kind, subtype, name, number] => {
            [&kind[..], &subtype[..]] == VALUE_TYPE
                && std::str::from_utf8(name).is_ok()
                && number == PLAIN
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(text: &str, texts: &[&str]) -> std::result::Result<(String, String), String> {
        let texts = texts.iter().map(|code| code.as_bytes().to_vec()).collect();
        let mut words = HeadWords::new(text.as_bytes());
        let head = Head::read(Path::new("a.vcd"), &mut words, &texts, |_, _| ());
        let head = head.map_err(|error| error.to_string())?;
        let body = text[head.length as usize..].to_owned();
        let head = String::from_utf8(head.text).unwrap();
        Ok((head.strip_suffix("$enddefinitions $end\n").unwrap().to_owned(), body))
    }

    #[test]
    fn blanks_within_a_declaration_are_one_and_the_body_begins_behind_the_header() {
        let text = "$timescale\n\t1 ns $end $date today $end\n$var\twire 2 !\ttwo\n[1:0]\r\n$end\n\
            $attrbegin misc 02 CHARACTER 1039 $end\n$enddefinitions\t$end #0 b01 !\n#6 b10 !\n";
        let head = head(text, &[]).unwrap();
        assert_eq!(head.0, "$timescale 1 ns $end\n$var wire 2 ! two [1:0] $end\n");
        assert_eq!(head.1, "#0 b01 !\n#6 b10 !\n");
    }

    #[test]
    fn a_type_that_is_none_of_vhdl_s_is_that_of_the_next_signal() {
        let text = "$attrbegin misc 02 lost 0 $end\n$scope module a $end\n$attrbegin misc 02 unsigned[m] 0 $end\n\
            $comment of b $end\n$var wire 2 ! b $end\n$attrbegin misc 02 SIGNED 1033 $end\n$var wire 2 # c $end\n\
            $upscope $end\n$enddefinitions $end\n";
        let expected = "$scope module a $end\n$attrbegin misc 02 unsigned[m] 0 $end\n$var wire 2 ! b $end\n\
            $var wire 2 # c $end\n$upscope $end\n";
        assert_eq!(head(text, &[]).unwrap().0, expected);
    }

    #[test]
    fn a_signal_with_words_is_a_string() {
        let text = "$var real 1 ! a $end $var real 1 # b $end $enddefinitions $end ";
        let head = head(text, &["#"]).unwrap().0;
        assert_eq!(head, "$var real 1 ! a $end\n$var string 1 # b $end\n");
    }

    #[test]
    fn a_fault_has_its_line_and_signal() {
        let told = |text: &str| head(text, &[]).unwrap_err();
        let ends = "$enddefinitions $end\n";
        let twice = told(&format!("$timescale 1ns $end\n\n$timescale 1ps $end\n{ends}"));
        let expected = "expected one time scale, and line 1 has it";
        assert_eq!(twice, format!("a.vcd:3:1: $timescale = 1ps: {expected}"));
        let port = told(&format!("$scope module a $end\n$var port 2 <0 p $end\n{ends}"));
        assert!(port.starts_with("a.vcd:2:1: p = port: is of an extended VCD"), "{port}");
        let width = told("$var\n wire x ! a $end\n");
        assert_eq!(width, "a.vcd:1:1: a = x: expected a width in bits");
        let short = told("$var wire 1 $end\n");
        assert_eq!(short, "a.vcd:1:1: $var = wire 1: expected a type, a width, a code and a name");
        assert!(told("$var wire 1 ! a\n").ends_with("$var: expected $end"));
        assert!(told("$date $end\n$fall $end").starts_with("a.vcd:2:1: $fall: expected $version"));
        let joined = told("$date $end $scope module a$end\n$attrbegin misc 02 A 1039 $end\n");
        assert_eq!(joined, "a.vcd:1:1: a$end: expected blanks around $end");
        assert!(told("$date $end\n").ends_with("ends before $enddefinitions"));
    }
}
