//! Reads the interface of a module from Icarus's compiled form.

use super::{Interface, PortShape};

/// The compiled form has the root's own things before those of the scopes in it:
///
/// ```text
/// S_0x1 .scope module, "hidden" "hidden" 2 1;
///     .port_info 1 /OUTPUT 4096 "counts";
/// P_0x2 .param/l "Neurons" 0 2 1, +C4<01000>;
/// v0x3 .array "counts", 255 0;
/// ```
///
/// A parameter has a 0 after its name, a `localparam` a 1; an array has its last index first.
pub fn read(text: &str) -> Interface {
    let mut interface = Interface::default();
    let lines = text.lines().map(str::trim);
    let root = lines.skip_while(|line| !line.contains(" .scope module,")).skip(1);
    for line in root.take_while(|line| !line.contains(" .scope ")) {
        let mut parts = line.split('"');
        let (Some(head), Some(name), Some(rest)) = (parts.next(), parts.next(), parts.next())
        else {
            continue;
        };
        if head.starts_with(".port_info") {
            interface.ports.extend(port(head).map(|shape| (name.to_owned(), shape)));
        } else if head.contains(" .param/") && rest.starts_with(" 0 ") {
            interface.parameters.insert(name.to_owned());
        } else if head.contains(" .array")
            && let Some(port) = interface.ports.get_mut(name)
        {
            port.words = words(rest);
        }
    }
    interface
}

fn port(head: &str) -> Option<PortShape> {
    let mut words = head.split_whitespace().skip(2);
    let output = words.next()? == "/OUTPUT";
    Some(PortShape { output, width: words.next()?.parse().ok()?, words: None })
}

fn words(rest: &str) -> Option<(u32, u32)> {
    let mut numbers = rest.split([' ', ',', ';']).filter_map(|word| word.parse().ok());
    let (last, first) = (numbers.next()?, numbers.next()?);
    Some((first, last))
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMPILED: &str = "S_0x1 .scope package, \"$unit\" \"$unit\" 2 1;\n .timescale 0 0;\n\
        S_0x2 .scope module, \"a\" \"a\" 2 2;\n .timescale -12 -15;\n    \
        .port_info 0 /INPUT 1 \"clk\";\n    .port_info 1 /OUTPUT 4096 \"counts\";\n    \
        .port_info 2 /OUTPUT 36 \"depth\";\nP_0x3 .param/str \"File\" 0 2 1, \"x.mem\";\n\
        P_0x4 .param/l \"Inner\" 1 2 2, +C4<0100>;\nv0x5 .array \"counts\", 255 0;\n\
        v0x6 .array \"ram\", 0 255, 15 0;\nS_0x7 .scope generate, \"g\" \"g\" 3 6, 3 6 0, S_0x2;\n\
        P_0x8 .param/l \"k\" 0 3 6, +C4<00>;\nS_0x9 .scope module, \"b\";\n    \
        .port_info 0 /INPUT 3 \"inner\";\n";

    #[test]
    fn ports_arrays_and_parameters_are_those_of_the_root() {
        let Interface { ports, parameters } = read(COMPILED);
        assert_eq!(ports.keys().collect::<Vec<_>>(), ["clk", "counts", "depth"]);
        assert_eq!(ports["depth"], PortShape { output: true, width: 36, words: None });
        assert_eq!(ports["counts"].words, Some((0, 255)));
        assert_eq!(parameters.into_iter().collect::<Vec<_>>(), ["File"]);
    }
}
