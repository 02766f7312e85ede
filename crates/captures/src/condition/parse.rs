//! Recursive descent parser of conditions.

use tofsim::error::{Input, Result};

use super::literal::Literal;
use super::token::{Token, TokenKind, tokens};
use super::tree::{Leaf, Node, Relation, Test};

/// Largest nesting depth of parentheses.
const DEEPEST: usize = 64;

/// Keyword for a condition that is always true.
const ALWAYS: &str = "always";

/// Keywords, which are names only in quotes.
const KEYWORDS: &[&str] = &["and", "or", "rising", "falling", "changed"];

const RELATIONS: &[(&str, Relation)] = &[
    ("==", Relation::Equal(true)),
    ("!=", Relation::Equal(false)),
    ("<", Relation::Order(u128::lt)),
    ("<=", Relation::Order(u128::le)),
    (">", Relation::Order(u128::gt)),
    (">=", Relation::Order(u128::ge)),
];

/// Parses the tests of a condition and their combination.
pub(super) fn parse(source: &str, text: &str) -> Result<(Node, Vec<Leaf>)> {
    let tokens = tokens(source, text)?;
    let mut parser = Parser { source, tokens: &tokens, leaves: Vec::new(), depth: 0 };
    let node = parser.any()?;
    match parser.first() {
        Token { kind: TokenKind::End, .. } => Ok((node, parser.leaves)),
        token => Err(parser.fault(token, "expected `&&`, `||` or the end of the condition")),
    }
}

struct Parser<'a> {
    source: &'a str,
    tokens: &'a [Token<'a>],
    leaves: Vec<Leaf>,
    depth: usize,
}

impl<'a> Parser<'a> {
    fn any(&mut self) -> Result<Node> {
        self.joined(&["||", "or"], Self::all, Node::Any)
    }

    fn all(&mut self) -> Result<Node> {
        self.joined(&["&&", "and"], Self::test, Node::All)
    }

    /// Parses operands separated by one of the given operators.
    fn joined(
        &mut self,
        words: &[&str],
        part: fn(&mut Self) -> Result<Node>,
        join: fn(Vec<Node>) -> Node,
    ) -> Result<Node> {
        let mut nodes = vec![part(self)?];
        while self.take(words) {
            nodes.push(part(self)?);
        }
        Ok(if nodes.len() == 1 { nodes.remove(0) } else { join(nodes) })
    }

    fn test(&mut self) -> Result<Node> {
        let mut inverted = false;
        while self.take(&["!"]) {
            inverted = !inverted;
        }
        let node = if self.take(&["("]) { self.inside()? } else { self.leaf()? };
        Ok(if inverted { Node::Not(Box::new(node)) } else { node })
    }

    /// Parses an expression in parentheses, from the opening one on.
    fn inside(&mut self) -> Result<Node> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.fault(self.first(), "expected at most 64 parentheses in each other"));
        }
        let node = self.any()?;
        if !self.take(&[")"]) {
            return Err(self.fault(self.first(), "expected `)`"));
        }
        self.depth -= 1;
        Ok(node)
    }

    fn leaf(&mut self) -> Result<Node> {
        let token = self.first();
        let is_name = match token.kind {
            TokenKind::Word => !KEYWORDS.contains(&token.text),
            TokenKind::Quoted => !token.text.is_empty(),
            TokenKind::Sign | TokenKind::End => false,
        };
        if !is_name {
            return Err(self.fault(token, "expected the name of a signal"));
        }
        self.tokens = &self.tokens[1..];
        if token.kind == TokenKind::Word && token.text == ALWAYS {
            return Ok(Node::All(Vec::new()));
        }
        let name = token.text.to_owned() + self.slice(token);
        let test = self.what()?;
        self.leaves.push(Leaf { name, column: token.column, test });
        Ok(Node::Leaf(self.leaves.len() - 1))
    }

    /// Parses the slice immediately after a quoted name.
    fn slice(&mut self, name: Token) -> &'a str {
        let next = self.first();
        let behind = name.column + name.text.chars().count() + 2 == next.column;
        if name.kind == TokenKind::Quoted && behind && next.text.starts_with('[') {
            self.tokens = &self.tokens[1..];
            next.text
        } else {
            ""
        }
    }

    /// Parses the test after a name.
    fn what(&mut self) -> Result<Test> {
        let words = [("rising", Test::Rising), ("falling", Test::Falling)];
        for (word, test) in words.into_iter().chain([("changed", Test::Changed)]) {
            if self.take(&[word]) {
                return Ok(test);
            }
        }
        let Some(&(_, relation)) = RELATIONS.iter().find(|(sign, _)| self.take(&[sign])) else {
            return Ok(Test::High);
        };
        let token = self.first();
        let fault = |expected| Err(self.fault(token, expected));
        match Literal::parse(token.text) {
            _ if token.kind != TokenKind::Word => fault("expected a value"),
            Err(expected) => fault(expected),
            Ok(literal) => {
                if literal.has_any() && !matches!(relation, Relation::Equal(_)) {
                    return fault("expected all digits: x is for == and != only");
                }
                self.tokens = &self.tokens[1..];
                Ok(Test::Compare(relation, literal, token.column))
            }
        }
    }

    /// Returns the next token; the last token is never consumed.
    fn first(&self) -> Token<'a> {
        self.tokens[0]
    }

    /// Consumes the next token if it is one of `words`.
    fn take(&mut self, words: &[&str]) -> bool {
        let token = self.first();
        let taken =
            matches!(token.kind, TokenKind::Sign | TokenKind::Word) && words.contains(&token.text);
        if taken {
            self.tokens = &self.tokens[1..];
        }
        taken
    }

    fn fault(&self, token: Token, expected: &str) -> tofsim::error::Error {
        let value = if token.kind == TokenKind::End { "the end" } else { token.text };
        Input::new(self.source, expected).at(1, token.column).value(value).into()
    }
}
