//! `probes.ltx`: names and widths, for archives without a CSV.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};

use tofsim::error::{Input, Result};

use super::heads;
use super::opened::{Column, WIDEST_PROBE};

/// A probe in its core.
struct PlacedProbe {
    /// Port of the core and bit of the port.
    place: (u64, u64),
    column: Column,
}

/// The columns of the core that has `width` bits in a sample, lowest bit first.
pub(super) fn columns(source: &str, text: &str, core: &str, width: u32) -> Result<Vec<Column>> {
    let document = Document::parse(text).map_err(|error| {
        let position = error.pos();
        Input::new(source, &error).at(position.row as usize, position.col as usize)
    })?;
    let mut cores: BTreeMap<String, Vec<PlacedProbe>> = BTreeMap::new();
    let is_probe =
        |node: &Node| node.has_tag_name("probe") && node.attribute("type") == Some("ila");
    for node in document.descendants().filter(is_probe) {
        let fault = |expected: String| {
            let position = document.text_pos_at(node.range().start);
            Input::new(source, expected).at(position.row as usize, position.col as usize)
        };
        let option = |id: &str| option(node, id);
        let number = |id| match option(id).map(str::parse::<u64>) {
            None => Ok(0),
            Some(Ok(number)) => Ok(number),
            Some(Err(_)) => Err(fault(format!("expected a whole number as {id}"))),
        };
        let place = (number("PROBE_PORT")?, number("PROBE_PORT_BITS")?);
        let nets = node.descendants().filter(|node| node.has_tag_name("net"));
        let names: Vec<_> = nets.filter_map(|net| net.attribute("name")).collect();
        let count = number("PROBE_PORT_BIT_COUNT")?;
        if names.is_empty() || names.len() > WIDEST_PROBE as usize {
            let expected = format!("expected 1 to {WIDEST_PROBE} nets in the probe");
            return Err(fault(expected).value(names.len()).into());
        }
        if count != 0 && count != names.len() as u64 {
            let expected = format!("expected {count} nets (PROBE_PORT_BIT_COUNT)");
            return Err(fault(expected).value(names.len()).into());
        }
        let name = option("CORE_UUID").or(option("HW_ILA")).unwrap_or_default();
        let probe = PlacedProbe { place, column: column(&names).map_err(fault)? };
        cores.entry(name.to_owned()).or_default().push(probe);
    }
    let bits =
        |probes: &[PlacedProbe]| probes.iter().map(|probe| probe.column.width as u64).sum::<u64>();
    let mut fitting: Vec<_> =
        cores.into_iter().filter(|(_, probes)| bits(probes) == width as u64).collect();
    if fitting.len() > 1 {
        fitting.retain(|(name, _)| name == core);
    }
    match fitting.pop() {
        Some((_, mut probes)) if fitting.is_empty() => {
            probes.sort_by_key(|probe| probe.place);
            Ok(probes.into_iter().map(|probe| probe.column).collect())
        }
        _ => {
            let text =
                format!("expected one core with probes of {width} bits together (data_width)");
            Err(Input::new(source, text).into())
        }
    }
}

fn option<'a>(probe: Node<'a, '_>, id: &str) -> Option<&'a str> {
    let options = probe.descendants().filter(|node| node.has_tag_name("Option"));
    options.filter(|node| node.attribute("Id") == Some(id)).find_map(|node| node.attribute("value"))
}

/// The column of some nets, highest bit first. A bus counts down by one.
fn column(nets: &[&str]) -> std::result::Result<Column, String> {
    let indexed: Option<Vec<_>> = nets.iter().map(|net| indexed(net)).collect();
    if let Some(indexed) = indexed.filter(|_| nets.len() > 1) {
        let ((name, msb), (_, lsb)) = (indexed[0], indexed[indexed.len() - 1]);
        let bit =
            |(place, net): (usize, &(&str, u32))| *net == (name, msb.wrapping_sub(place as u32));
        if msb as usize >= nets.len() - 1 && indexed.iter().enumerate().all(bit) {
            return heads::parse(&format!("{name}[{msb}:{lsb}]"));
        }
    }
    let (name, width) = (nets[0].to_owned(), nets.len() as u32);
    Ok(Column { name, width, lsb: 0, vector: width > 1, radix: None, text: false, word: 0 })
}

/// Splits `name[index]`.
fn indexed(net: &str) -> Option<(&str, u32)> {
    let (name, index) = net.strip_suffix(']')?.rsplit_once('[')?;
    Some((name, index.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn probe(core: &str, port: u32, nets: &[&str]) -> String {
        let nets: String = nets.iter().map(|net| format!("<net name=\"{net}\"/>")).collect();
        format!(
            "<probe type=\"ila\"><probeOptions><Option Id=\"HW_ILA\" value=\"{core}\"/>\
             <Option Id=\"PROBE_PORT\" value=\"{port}\"/></probeOptions><nets>{nets}</nets></probe>"
        )
    }

    fn heads(
        probes: &[String],
        core: &str,
        width: u32,
    ) -> std::result::Result<Vec<String>, String> {
        let text = format!("<probeData><probeset>{}</probeset></probeData>", probes.concat());
        let columns = columns("a.ltx", &text, core, width).map_err(|error| error.to_string())?;
        Ok(columns.iter().map(Column::head).collect())
    }

    #[test]
    fn buses_are_put_together_and_ports_sorted() {
        let probes = [
            probe("u", 2, &["x/b[5]", "x/b[4]"]),
            probe("u", 0, &["r[4]"]),
            probe("u", 10, &["c[0]", "c[1]"]),
            probe("u", 3, &["&lt;const0&gt;", "d"]),
        ];
        let expected = ["r[4]", "x/b[5:4]", "<const0>[1:0]", "c[0][1:0]"].map(str::to_owned);
        assert_eq!(heads(&probes, "u", 7), Ok(expected.to_vec()));
    }

    #[test]
    fn of_several_cores_the_one_that_fits_is_taken() {
        let probes =
            [probe("u", 0, &["a"]), probe("v", 0, &["b[1]", "b[0]"]), probe("w", 0, &["c"])];
        assert_eq!(heads(&probes, "", 2), Ok(vec!["b[1:0]".into()]));
        assert_eq!(heads(&probes, "w", 1), Ok(vec!["c".into()]));
        let error = "a.ltx: expected one core with probes of 3 bits together (data_width)";
        assert_eq!(heads(&probes, "u", 3), Err(error.into()));
        assert!(heads(&probes, "x", 1).is_err());
    }

    #[test]
    fn what_is_no_list_of_probes_is_told_with_its_place() {
        let fault = |text| columns("a.ltx", text, "u", 1).unwrap_err().to_string();
        assert!(fault("<a>\n<b></a>").starts_with("a.ltx:2:"));
        let nets = "<p>\n <probe type=\"ila\"><nets/></probe></p>";
        assert!(fault(nets).starts_with("a.ltx:2:2: 0: expected 1 to 4096 nets"));
    }
}
