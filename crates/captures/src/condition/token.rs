//! Lexer of conditions.

use tofsim::error::{Input, Result};

/// A token with its column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Token<'a> {
    pub(super) kind: TokenKind,
    /// Text as written; of a quoted name, the text between the quotes.
    pub(super) text: &'a str,
    pub(super) column: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    Sign,
    Word,
    /// A quoted name.
    Quoted,
    End,
}

const SIGNS: &[&str] = &["&&", "||", "==", "!=", "<=", ">=", "(", ")", "!", "<", ">"];

fn belongs_to_word(character: char) -> bool {
    character.is_alphanumeric() || "_./[]:$-".contains(character)
}

/// Returns the tokens of `text`, followed by an empty one.
pub(super) fn tokens<'a>(source: &str, text: &'a str) -> Result<Vec<Token<'a>>> {
    let (mut tokens, mut rest, mut column) = (Vec::new(), text, 1);
    loop {
        let trimmed = rest.trim_start();
        column += rest[..rest.len() - trimmed.len()].chars().count();
        rest = trimmed;
        if rest.is_empty() {
            tokens.push(Token { kind: TokenKind::End, text: "", column });
            return Ok(tokens);
        }
        let (kind, token, taken) = token(rest)
            .map_err(|(value, expected)| Input::new(source, expected).at(1, column).value(value))?;
        tokens.push(Token { kind, text: token, column });
        column += rest[..taken].chars().count();
        rest = &rest[taken..];
    }
}

/// Returns the first token of `rest` and its length in bytes, or an error.
fn token(rest: &str) -> std::result::Result<(TokenKind, &str, usize), (&str, &str)> {
    if let Some(inside) = rest.strip_prefix('"') {
        let end = inside.find('"').ok_or((rest, "expected a closing quote"))?;
        return Ok((TokenKind::Quoted, &inside[..end], end + 2));
    }
    if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
        return Ok((TokenKind::Sign, &rest[..sign.len()], sign.len()));
    }
    let end = rest.find(|character| !belongs_to_word(character)).unwrap_or(rest.len());
    match end {
        0 if rest.starts_with('=') => Err(("=", "expected `==`")),
        0 => {
            let length = rest.chars().next().map_or(0, char::len_utf8);
            Err((&rest[..length], "expected a name, a value or an operator"))
        }
        end => Ok((TokenKind::Word, &rest[..end], end)),
    }
}
