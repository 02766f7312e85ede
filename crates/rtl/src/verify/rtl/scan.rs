//! Finds what a source file declares and names, without a parser: comments and strings are passed over, and
//! so nothing in them counts.

use std::collections::BTreeSet;

/// A Verilog or VHDL file, as far as choosing and ordering files needs it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Scan {
    /// Modules, interfaces, programs and primitives, or entities in lower case.
    pub modules: Vec<Declared>,
    /// Packages.
    pub packages: Vec<String>,
    /// All identifiers in it, those of VHDL in lower case.
    pub words: BTreeSet<String>,
    /// Identifiers before `::`: packages that have to come first.
    pub scopes: BTreeSet<String>,
    /// Files that it includes, as they are written there.
    pub includes: Vec<String>,
}

/// A module that a file declares.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Declared {
    /// Its name.
    pub name: String,
    /// True if it stands under an `` `ifdef `` or the like, so that it need not be there.
    pub conditional: bool,
}

#[derive(Debug, PartialEq)]
enum Token<'a> {
    Word(&'a str),
    Directive(&'a str),
    Text(&'a str),
    Mark(char),
}

impl Scan {
    /// Of Verilog or SystemVerilog.
    pub fn verilog(text: &str) -> Self {
        let mut scan = Scan::default();
        let tokens = tokens(text, &Syntax::VERILOG);
        let mut depth = 0usize;
        for (k, token) in tokens.iter().enumerate() {
            let follows = |n: usize| tokens.get(k + n);
            match token {
                Token::Directive("ifdef" | "ifndef") => depth += 1,
                Token::Directive("endif") => depth = depth.saturating_sub(1),
                Token::Directive("include") => {
                    if let Some(Token::Text(name)) = follows(1) {
                        scan.includes.push((*name).to_owned());
                    }
                }
                Token::Word(word) => {
                    scan.words.insert((*word).to_owned());
                    if follows(1) == Some(&Token::Mark(':')) && follows(2) == follows(1) {
                        scan.scopes.insert((*word).to_owned());
                    }
                    let lifetime = matches!(follows(1), Some(Token::Word("automatic" | "static")));
                    let Some(Token::Word(name)) = follows(1 + usize::from(lifetime)) else {
                        continue;
                    };
                    match *word {
                        "package" => scan.packages.push((*name).to_owned()),
                        "module" | "macromodule" | "interface" | "program" | "primitive" => {
                            let conditional = depth > 0;
                            scan.modules.push(Declared { name: (*name).to_owned(), conditional });
                        }
                        _ => {}
                    }
                }
                _ => {}
            }
        }
        scan
    }

    /// Of VHDL.
    pub fn vhdl(text: &str) -> Self {
        let text = text.to_lowercase();
        let tokens = tokens(&text, &Syntax::VHDL);
        let entity = |three: &[Token]| match three {
            [Token::Word("entity"), Token::Word(name), Token::Word("is")] => {
                Some(Declared { name: (*name).to_owned(), conditional: false })
            }
            _ => None,
        };
        let word = |token: &Token| match token {
            Token::Word(word) => Some((*word).to_owned()),
            _ => None,
        };
        Scan {
            modules: tokens.windows(3).filter_map(entity).collect(),
            words: tokens.iter().filter_map(word).collect(),
            ..Scan::default()
        }
    }
}

/// Comment and string syntax of a language.
struct Syntax {
    line_comment: &'static str,
    /// True if a backslash in a string takes the next character with it.
    escapes: bool,
}

impl Syntax {
    const VERILOG: Syntax = Syntax { line_comment: "//", escapes: true };
    const VHDL: Syntax = Syntax { line_comment: "--", escapes: false };
}

fn tokens<'a>(text: &'a str, syntax: &Syntax) -> Vec<Token<'a>> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '$';
    let word = |text: &'a str| text.split_once(|c| !is_word(c)).map_or(text, |(word, _)| word);
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let after = &rest[first.len_utf8()..];
        if rest.starts_with(syntax.line_comment) {
            rest = rest.split_once('\n').map_or("", |(_, rest)| rest);
        } else if let Some(comment) = rest.strip_prefix("/*") {
            rest = comment.split_once("*/").map_or("", |(_, rest)| rest);
        } else if let Some(after) = rest.strip_prefix("'\"'").filter(|_| !syntax.escapes) {
            // A character of VHDL, which begins no string.
            rest = after;
        } else if first == '"' {
            let end = end_of_string(after, syntax.escapes);
            tokens.push(Token::Text(&after[..end]));
            rest = after[end..].strip_prefix('"').unwrap_or("");
        } else if first == '`' {
            let name = word(after);
            tokens.push(Token::Directive(name));
            rest = &after[name.len()..];
        } else if first == '\\' && syntax.escapes {
            let name = after.split(char::is_whitespace).next().unwrap_or("");
            tokens.push(Token::Word(name));
            rest = &after[name.len()..];
        } else if is_word(first) {
            let name = word(rest);
            tokens.push(Token::Word(name));
            rest = &rest[name.len()..];
        } else {
            if !first.is_whitespace() {
                tokens.push(Token::Mark(first));
            }
            rest = after;
        }
    }
    tokens
}

/// Returns the end of the string whose opening quote is before `text`; the end of the line if it is not
/// closed.
fn end_of_string(text: &str, escapes: bool) -> usize {
    let mut escaped = false;
    let end = text.char_indices().find(|(_, c)| {
        let ends = !escaped && (*c == '"' || *c == '\n');
        escaped = escapes && !escaped && *c == '\\';
        ends
    });
    end.map_or(text.len(), |(at, _)| at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(declared: &[Declared]) -> Vec<(&str, bool)> {
        declared.iter().map(|module| (module.name.as_str(), module.conditional)).collect()
    }

    #[test]
    fn comments_and_strings_declare_and_name_nothing() {
        let text = "// module a import p::*;\n/* module b; q::x */ module c;\n\
            initial $display(\"module d; r::y \\\" s::z\"); endmodule\n";
        let scan = Scan::verilog(text);
        assert_eq!(names(&scan.modules), [("c", false)]);
        assert!(scan.scopes.is_empty());
    }

    #[test]
    fn packages_imports_includes_and_conditions_are_found() {
        let text = "`include \"a.svh\"\npackage automatic p; endpackage\n`ifdef X\n\
            module automatic m import q::*; (input r :: t a);\nassign a = b ? c : d;\nendmodule\n\
            `endif\ninterface \\bus+ ; endinterface\n";
        let scan = Scan::verilog(text);
        assert_eq!(names(&scan.modules), [("m", true), ("bus+", false)]);
        assert_eq!(scan.packages, ["p"]);
        assert_eq!(scan.scopes.iter().collect::<Vec<_>>(), ["q", "r"]);
        assert_eq!(scan.includes, ["a.svh"]);
    }

    #[test]
    fn entities_are_declared_and_not_instantiated() {
        let text = "-- entity A is\nENTITY Histogram IS\nend entity;\n\
            u : entity work.b port map (x => '\"', y => \"entity c is\");\n";
        assert_eq!(names(&Scan::vhdl(text).modules), [("histogram", false)]);
    }

    #[test]
    fn what_ends_in_the_middle_is_no_trouble() {
        for text in ["\"", "\"\\", "/*", "//", "`", "\\", "module", "é\"é", "package"] {
            Scan::verilog(text);
            Scan::vhdl(text);
        }
    }
}
