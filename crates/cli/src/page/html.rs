//! A page, and pieces of HTML, which are XML too.

use crate::record::Record;

/// A text as it may stand in an element or an attribute.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            other => escaped.push(other),
        }
    }
    escaped
}

/// A picture's text without what comes before its first element and after its last.
fn inlined(svg: &str) -> String {
    match (svg.find("<svg"), svg.rfind("</svg>")) {
        (Some(begin), Some(end)) if begin < end => svg[begin..end + "</svg>".len()].to_owned(),
        _ => String::new(),
    }
}

/// Whether a cell is a number, with or without its unit.
fn is_number(cell: &str) -> bool {
    let first = cell.split(' ').next().unwrap_or_default().trim_end_matches('%');
    first == "-" || first.replace(',', "").parse::<f64>().is_ok()
}

/// A table; columns of numbers are set to the right.
pub fn table<const N: usize>(
    header: &[&str; N],
    rows: impl IntoIterator<Item = [String; N]>,
) -> String {
    let rows: Vec<_> = rows.into_iter().collect();
    let of_numbers = |column: usize| rows.iter().all(|row| is_number(&row[column]));
    let class: [&str; N] = std::array::from_fn(|k| if of_numbers(k) { " class=\"n\"" } else { "" });
    let cells = |kind: &str, row: &[String; N]| -> String {
        let cell =
            |(k, text): (usize, &String)| format!("<{kind}{}>{}</{kind}>", class[k], escaped(text));
        format!("<tr>{}</tr>\n", row.iter().enumerate().map(cell).collect::<String>())
    };
    let head = if header.iter().all(|name| name.is_empty()) {
        String::new()
    } else {
        format!("<thead>\n{}</thead>\n", cells("th", &header.map(str::to_owned)))
    };
    let body: String = rows.iter().map(|row| cells("td", row)).collect();
    format!("<div class=\"scroll\"><table>\n{head}<tbody>\n{body}</tbody>\n</table></div>\n")
}

/// Rows of what is compared, both sides, and a verdict as HTML; a narrow page has the cells of a row below each other.
pub fn comparison(sides: [&str; 2], rows: impl IntoIterator<Item = [String; 4]>) -> String {
    let row = |[what, left, right, verdict]: [String; 4]| {
        let side = |name: &str, text: &str| {
            format!("<td data-side=\"{}\">{}</td>", escaped(name), escaped(text))
        };
        let (left, right) = (side(sides[0], &left), side(sides[1], &right));
        format!("<tr><td>{}</td>{left}{right}<td>{verdict}</td></tr>\n", escaped(&what))
    };
    let body: String = rows.into_iter().map(row).collect();
    let [left, right] = sides.map(escaped);
    format!(
        "<table class=\"comparison\">\n<thead>\n<tr><th></th><th>{left}</th><th>{right}</th><th></th></tr>\n</thead>\n\
         <tbody>\n{body}</tbody>\n</table>\n"
    )
}

/// A picture with words below it, which shrinks with the page; nothing without a picture.
pub fn figure(svg: &str, words: &str) -> String {
    in_figure("", svg, words)
}

/// Returns a figure whose picture is hard to read where it is small: a narrow page moves it within its box.
pub fn wide_figure(svg: &str, words: &str) -> String {
    in_figure(" class=\"wide\"", svg, words)
}

fn in_figure(class: &str, svg: &str, words: &str) -> String {
    match inlined(svg) {
        svg if svg.is_empty() => String::new(),
        svg => {
            format!("<figure{class}>\n{svg}\n<figcaption>{words}</figcaption>\n</figure>\n")
        }
    }
}

/// A word in the colour of its class.
pub fn badge(class: &str, word: &str) -> String {
    format!("<span class=\"badge {class}\">{word}</span>")
}

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
pub fn tiles(tiles: impl IntoIterator<Item = (impl AsRef<str>, String)>) -> String {
    let tile = |(what, value): (_, String)| {
        let (value, what) = (escaped(&value), escaped(AsRef::as_ref(&what)));
        format!("<div><b>{value}</b><span>{what}</span></div>\n")
    };
    let tiles: String = tiles.into_iter().map(tile).collect();
    format!("<div class=\"tiles\">\n{tiles}</div>\n")
}

/// Lines that are typed.
pub fn commands(lines: &[String]) -> String {
    let lines: String = lines.iter().map(|line| escaped(line) + "\n").collect();
    format!("<pre>{lines}</pre>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shown_is_text_and_no_markup() {
        let table = table(&["a", "n"], [["<b> & \"c\"".to_owned(), "1,000.5".to_owned()]]);
        assert!(
            table.contains("<td>&lt;b&gt; &amp; &quot;c&quot;</td><td class=\"n\">1,000.5</td>"),
            "{table}"
        );
        assert_eq!(inlined("<?xml?><svg a=\"\"><g/></svg><!-- x -->\n"), "<svg a=\"\"><g/></svg>");
        assert_eq!(inlined("none"), "");
        assert_eq!(figure("none", "words"), "");
        let row = ["<b>", "1", "2"].map(str::to_owned);
        let [what, left, right] = row;
        let text = comparison(["a", "b"], [[what, left, right, badge("same", "same")]]);
        assert!(text.contains("<td>&lt;b&gt;</td><td data-side=\"a\">1</td>"), "{text}");
        assert!(text.contains("<td><span class=\"badge same\">same</span></td>"), "{text}");
    }
}
