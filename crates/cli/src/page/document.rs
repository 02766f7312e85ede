//! The page around its sections.

use crate::record::Record;

use super::html::escaped;

/// Style sheet: on a screen by day and night, in a narrow window, and on paper.
const STYLE: &str = include_str!("style.css");

/// A page.
pub struct Document<'a> {
    /// Title in the browser's tab.
    pub title: &'a str,
    /// The large words at the top.
    pub heading: &'a str,
    /// Paragraph below the heading.
    pub lead: &'a str,
    /// The rest, as HTML.
    pub body: String,
    /// Version, scenario and command that made the page.
    pub record: &'a Record,
}

impl Document<'_> {
    /// The whole file.
    pub fn html(&self) -> String {
        let lead = match self.lead {
            "" => String::new(),
            lead => format!("<p class=\"lead\">{}</p>\n", escaped(lead)),
        };
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
             <title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n<header>\n<h1>{}</h1>\n{lead}</header>\n\
             {}</main>\n<!-- {} -->\n</body>\n</html>\n",
            escaped(self.title),
            escaped(self.heading),
            self.body,
            self.record.line(),
        )
    }
}

/// A part of the page with a heading; nothing without anything inside.
pub fn section(title: &str, inside: &str) -> String {
    match inside {
        "" => String::new(),
        inside => format!("<section>\n<h2>{title}</h2>\n{inside}</section>\n"),
    }
}

/// Numbers that a reader looks for first: what each is, and its value.
pub fn tiles<'a>(tiles: impl IntoIterator<Item = (&'a str, String)>) -> String {
    let tile = |(what, value): (&str, String)| {
        format!("<div><b>{}</b><span>{}</span></div>\n", escaped(&value), escaped(what))
    };
    let tiles: String = tiles.into_iter().map(tile).collect();
    format!("<div class=\"tiles\">\n{tiles}</div>\n")
}

/// Lines that are typed.
pub fn commands(lines: &[String]) -> String {
    let lines: String = lines.iter().map(|line| escaped(line) + "\n").collect();
    format!("<pre>{lines}</pre>\n")
}
