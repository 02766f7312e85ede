//! Pieces of HTML, which are XML too.

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
    table_with(header, rows, N)
}

/// The same where the cells of one column, counted from 0, are HTML already.
pub fn table_with<const N: usize>(
    header: &[&str; N],
    rows: impl IntoIterator<Item = [String; N]>,
    html: usize,
) -> String {
    let rows: Vec<_> = rows.into_iter().collect();
    let of_numbers = |column: usize| rows.iter().all(|row| is_number(&row[column]));
    let class: [&str; N] = std::array::from_fn(|k| if of_numbers(k) { " class=\"n\"" } else { "" });
    let cells = |kind: &str, row: &[String; N]| -> String {
        let cell = |(k, text): (usize, &String)| {
            let text = if k == html && kind == "td" { text.clone() } else { escaped(text) };
            format!("<{kind}{}>{text}</{kind}>", class[k])
        };
        format!("<tr>{}</tr>\n", row.iter().enumerate().map(cell).collect::<String>())
    };
    let head = match header.iter().all(|name| name.is_empty()) {
        true => String::new(),
        false => format!("<thead>\n{}</thead>\n", cells("th", &header.map(str::to_owned))),
    };
    let body: String = rows.iter().map(|row| cells("td", row)).collect();
    format!("<div class=\"scroll\"><table>\n{head}<tbody>\n{body}</tbody>\n</table></div>\n")
}

/// A picture with words below it, which shrinks with the page; nothing without a picture.
pub fn figure(svg: &str, words: &str) -> String {
    in_figure("", svg, words)
}

/// The same with a picture that is hard to read where it is small: a narrow page moves it within its box.
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
        let badge = table_with(&["", "a"], [["<b>".to_owned(), badge("same", "same")]], 1);
        assert!(badge.contains("<td>&lt;b&gt;</td><td><span class=\"badge same\">"), "{badge}");
    }
}
