//! Reader of `probes.ltx`: names of the probes, and their bits in a sample.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};

use tofsim::error::{Input, Result};

use super::header;
use super::opened::{Column, WIDEST_PROBE};

/// Probes of each core.
#[derive(Debug, Default)]
pub(super) struct List(BTreeMap<String, Vec<ListedProbe>>);

#[derive(Debug)]
struct ListedProbe {
    /// Port of the core; a view of other probes has none.
    port: Option<u64>,
    /// Lowest bit in the port.
    low: u64,
    column: Column,
}

/// A probe, and its lowest bit in a sample.
pub(super) type Placed = (Column, usize);

impl List {
    /// Parses a list.
    pub(super) fn read(source: &str, text: &str) -> Result<Self> {
        let document = Document::parse(text).map_err(|error| {
            let position = error.pos();
            Input::new(source, &error).at(position.row as usize, position.col as usize)
        })?;
        let mut list = List::default();
        let is_probe =
            |node: &Node| node.has_tag_name("probe") && node.attribute("type") == Some("ila");
        for node in document.descendants().filter(is_probe) {
            let (core, probe) = listed(node).map_err(|fault| {
                let position = document.text_pos_at(node.range().start);
                Input { source: source.to_owned(), ..fault }
                    .at(position.row as usize, position.col as usize)
            })?;
            list.0.entry(core).or_default().push(probe);
        }
        Ok(list)
    }

    /// Returns the probes of the core whose ports have `width` bits in total, in order of their bits. A port is as
    /// wide as its probes require; several probes may share bits.
    pub(super) fn placed(&self, core: &str, width: u32) -> Option<Vec<Placed>> {
        let mut fitting: Vec<_> = self.0.iter().collect();
        fitting.retain(|(_, probes)| bits(probes) == u64::from(width));
        if fitting.len() > 1 {
            fitting.retain(|(name, _)| *name == core);
        }
        let [(_, probes)] = fitting[..] else { return None };
        let mut begins = BTreeMap::new();
        let mut begin = 0;
        for (port, width) in ports(probes) {
            begins.insert(port, begin);
            begin += width;
        }
        let mut placed: Vec<Placed> = (probes.iter())
            .filter_map(|probe| {
                let low = begins[&probe.port?] + probe.low;
                Some((probe.column.clone(), low as usize))
            })
            .collect();
        placed.sort_by_key(|(_, low)| *low);
        Some(placed)
    }
}

/// Finds the position of a probe with the given name and width. Vivado omits the index of a single net in some files.
pub(super) fn place(placed: &[Placed], column: &Column) -> Option<usize> {
    let bare = |name: &str| indexed(name).map_or(name, |(name, _)| name).to_owned();
    let same = |other: &Column| other.name == column.name && other.lsb == column.lsb;
    let near = |other: &Column| other.name == column.name || bare(&other.name) == column.name;
    let find = |is_it: &dyn Fn(&Column) -> bool| {
        let mut found =
            placed.iter().filter(|(other, _)| other.width == column.width && is_it(other));
        let (_, low) = found.next()?;
        found.all(|(_, other)| other == low).then_some(*low)
    };
    find(&same).or_else(|| find(&near))
}

/// Returns the ports of some probes, with their widths.
fn ports(probes: &[ListedProbe]) -> BTreeMap<u64, u64> {
    let mut ports = BTreeMap::new();
    for probe in probes {
        if let Some(port) = probe.port {
            let width: &mut u64 = ports.entry(port).or_default();
            *width = (*width).max(probe.low + u64::from(probe.column.width));
        }
    }
    ports
}

fn bits(probes: &[ListedProbe]) -> u64 {
    ports(probes).values().sum()
}

/// Parses a probe and the name of its core.
///
/// # Errors
/// If the element is invalid.
fn listed(node: Node) -> std::result::Result<(String, ListedProbe), Input> {
    let fault = |expected: String| Input::new("", expected);
    let option = |id: &str| option(node, id);
    let number = |id| match option(id).map(str::parse::<u32>) {
        None => Ok(0),
        Some(Ok(number)) => Ok(number.into()),
        Some(Err(_)) => Err(fault(format!("expected a whole number as {id}"))),
    };
    let port = match option("PROBE_PORT") {
        Some("-1") => None,
        _ => Some(number("PROBE_PORT")?),
    };
    let low = number("PROBE_PORT_BITS")?;
    let nets = node.descendants().filter(|node| node.has_tag_name("net"));
    let names: Vec<_> = nets.filter_map(|net| net.attribute("name")).collect();
    let count = number("PROBE_PORT_BIT_COUNT")?;
    if names.is_empty() || names.len() > WIDEST_PROBE as usize {
        let expected = format!("expected 1 to {WIDEST_PROBE} nets in the probe");
        return Err(fault(expected).value(names.len()));
    }
    if count != 0 && count != names.len() as u64 {
        let expected = format!("expected {count} nets (PROBE_PORT_BIT_COUNT)");
        return Err(fault(expected).value(names.len()));
    }
    let core = option("CORE_UUID").or(option("HW_ILA")).unwrap_or_default();
    let column = column(&names).map_err(fault)?;
    Ok((core.to_owned(), ListedProbe { port, low, column }))
}

fn option<'a>(probe: Node<'a, '_>, id: &str) -> Option<&'a str> {
    let options = probe.descendants().filter(|node| node.has_tag_name("Option"));
    options.filter(|node| node.attribute("Id") == Some(id)).find_map(|node| node.attribute("value"))
}

/// Builds the column of some nets, highest bit first; the indices of a bus decrease by one.
fn column(nets: &[&str]) -> std::result::Result<Column, String> {
    let indexed: Option<Vec<_>> = nets.iter().map(|net| indexed(net)).collect();
    if let Some(indexed) = indexed.filter(|_| nets.len() > 1) {
        let ((name, msb), (_, lsb)) = (indexed[0], indexed[indexed.len() - 1]);
        let bit =
            |(place, net): (usize, &(&str, u32))| *net == (name, msb.wrapping_sub(place as u32));
        if msb as usize >= nets.len() - 1 && indexed.iter().enumerate().all(bit) {
            return header::parse(&format!("{name}[{msb}:{lsb}]"));
        }
    }
    let (name, width) = (nets[0].to_owned(), nets.len() as u32);
    Ok(Column { name, width, vector: width > 1, ..Column::default() })
}

/// Splits `name[index]`.
fn indexed(net: &str) -> Option<(&str, u32)> {
    let (name, index) = net.strip_suffix(']')?.rsplit_once('[')?;
    Some((name, index.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn probe(core: &str, port: i32, low: u32, nets: &[&str]) -> String {
        let nets: String = nets.iter().map(|net| format!("<net name=\"{net}\"/>")).collect();
        format!(
            "<probe type=\"ila\"><probeOptions><Option Id=\"HW_ILA\" value=\"{core}\"/>\
             <Option Id=\"PROBE_PORT\" value=\"{port}\"/>\
             <Option Id=\"PROBE_PORT_BITS\" value=\"{low}\"/></probeOptions>\
             <nets>{nets}</nets></probe>"
        )
    }

    fn placed(probes: &[String], core: &str, width: u32) -> Option<Vec<(String, usize)>> {
        let text = format!("<probeData><probeset>{}</probeset></probeData>", probes.concat());
        let placed = List::read("a.ltx", &text).unwrap().placed(core, width)?;
        Some(placed.iter().map(|(column, low)| (column.head(), *low)).collect())
    }

    fn some(expected: &[(&str, usize)]) -> Option<Vec<(String, usize)>> {
        Some(expected.iter().map(|(name, low)| (name.to_string(), *low)).collect())
    }

    #[test]
    fn buses_are_put_together_and_ports_sorted() {
        let probes = [
            probe("u", 2, 0, &["x/b[5]", "x/b[4]"]),
            probe("u", 0, 0, &["r[4]"]),
            probe("u", 10, 0, &["c[0]", "c[1]"]),
            probe("u", 3, 0, &["&lt;const0&gt;", "d"]),
        ];
        let expected = [("r[4]", 0), ("x/b[5:4]", 1), ("<const0>[1:0]", 3), ("c[0][1:0]", 5)];
        assert_eq!(placed(&probes, "u", 7), some(&expected));
    }

    #[test]
    fn probes_may_share_the_bits_of_a_port_and_views_have_none() {
        let probes = [
            probe("u", -1, 0, &["Interface[1]", "Interface[0]"]),
            probe("u", 1, 0, &["ctrl[1]", "ctrl[0]"]),
            probe("u", 1, 1, &["ready"]),
            probe("u", 0, 0, &["data[2]", "data[1]", "data[0]"]),
        ];
        let expected = [("data[2:0]", 0), ("ctrl[1:0]", 3), ("ready", 4)];
        assert_eq!(placed(&probes, "u", 5), some(&expected));
    }

    #[test]
    fn a_probe_is_found_by_its_name_with_or_without_an_index() {
        let text =
            format!("<p>{}{}</p>", probe("u", 0, 0, &["addra[0]"]), probe("u", 1, 0, &["b"]));
        let placed = List::read("a.ltx", &text).unwrap().placed("u", 2).unwrap();
        let find = |head| place(&placed, &header::parse(head).unwrap());
        assert_eq!(
            [find("b"), find("addra"), find("b[1:0]"), find("c")],
            [Some(1), Some(0), None, None]
        );
    }

    #[test]
    fn of_several_cores_the_one_that_fits_is_taken() {
        let probes = [
            probe("u", 0, 0, &["a"]),
            probe("v", 0, 0, &["b[1]", "b[0]"]),
            probe("w", 0, 0, &["c"]),
        ];
        assert_eq!(placed(&probes, "", 2), some(&[("b[1:0]", 0)]));
        assert_eq!(placed(&probes, "w", 1), some(&[("c", 0)]));
        assert_eq!(placed(&probes, "u", 3), None);
        assert_eq!(placed(&probes, "x", 1), None);
    }

    #[test]
    fn what_is_no_list_of_probes_is_told_with_its_place() {
        let fault = |text| List::read("a.ltx", text).unwrap_err().to_string();
        assert!(fault("<a>\n<b></a>").starts_with("a.ltx:2:"));
        let nets = "<p>\n <probe type=\"ila\"><nets/></probe></p>";
        assert!(fault(nets).starts_with("a.ltx:2:2: 0: expected 1 to 4096 nets"));
        let port = probe("u", -2, 0, &["a"]);
        assert!(fault(&port).ends_with("expected a whole number as PROBE_PORT"));
    }
}
