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
pub fn inlined(svg: &str) -> String {
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
    let head = match header.iter().all(|name| name.is_empty()) {
        true => String::new(),
        false => format!("<thead>\n{}</thead>\n", cells("th", &header.map(str::to_owned))),
    };
    let body: String = rows.iter().map(|row| cells("td", row)).collect();
    format!("<div class=\"scroll\"><table>\n{head}<tbody>\n{body}</tbody>\n</table></div>\n")
}

/// A picture with words below it; nothing without a picture.
pub fn figure(svg: &str, words: &str) -> String {
    if svg.is_empty() {
        String::new()
    } else {
        format!("<figure>\n{svg}\n<figcaption>{words}</figcaption>\n</figure>\n")
    }
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
    }
}
