//! Lines of the Verilog, found at compile time.

/// Returns the number of the line, from 1, at which the first of `texts` that occurs in a file ends. A file without any of
/// them does not compile.
pub const fn line_of(file: &[u8], texts: &[&str]) -> u32 {
    let mut place = 0;
    while place < texts.len() {
        if let Some(line) = find(file, texts[place].as_bytes()) {
            return line;
        }
        place += 1;
    }
    panic!("the text is not in the Verilog")
}

const fn find(file: &[u8], text: &[u8]) -> Option<u32> {
    let (mut line, mut place) = (1, 0);
    while place + text.len() <= file.len() {
        let mut same = 0;
        while same < text.len() && file[place + same] == text[same] {
            same += 1;
        }
        if same == text.len() {
            return Some(if text[0] == b'\n' { line + 1 } else { line });
        }
        if file[place] == b'\n' {
            line += 1;
        }
        place += 1;
    }
    None
}

/// Evaluates to the text of a module's file in the repository.
#[macro_export]
macro_rules! verilog {
    ($module:ident) => {
        include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/rtl_ref/", stringify!($module), ".v"))
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_that_begins_with_a_line_feed_is_on_the_line_after_it() {
        let file = b"a\n  b\nb\n";
        assert_eq!(line_of(file, &["b"]), 2);
        assert_eq!(line_of(file, &["c", "\nb"]), 3);
    }
}
