//! Writer of `probes.ltx`: the names of the nets, bit by bit, in XML.

use std::io::{self, Write};

use super::super::capture::Capture;

/// Name of the core in the files of an archive.
pub(super) const CORE: &str = "u_ila_0";
/// Name of the KC705's device in a list of probes.
const PART: &str = "xc7k325t_0";
/// UUID of a core that was never built.
const UUID: &str = "00000000000000000000000000000000";

/// Writes the probes of a capture as Vivado's `probes.ltx`.
pub fn ltx(out: &mut dyn Write, capture: &Capture) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>")?;
    writeln!(out, "<probeData version=\"2\" minor=\"2\">")?;
    writeln!(out, "  <probeset name=\"{PART}\" active=\"false\">")?;
    for (port, probe) in capture.probes.iter().enumerate() {
        let bus = if probe.vector { "bus" } else { "net" };
        write!(out, "    <probe type=\"ila\" busType=\"{bus}\" ")?;
        writeln!(out, "source=\"netlist\" spec=\"ILA_V2_RT\">")?;
        writeln!(out, "      <probeOptions Id=\"DebugProbeParams\">")?;
        let mut option = |id, value: &dyn std::fmt::Display| {
            writeln!(out, "        <Option Id=\"{id}\" value=\"{value}\"/>")
        };
        option("BSCAN_SWITCH_INDEX", &0)?;
        option("CORE_LOCATION", &"1:0")?;
        option("CORE_UUID", &UUID)?;
        option("HUB_CLK_INPUT_FREQ_HZ", &"")?;
        option("HW_ILA", &CORE)?;
        option("PROBE_PORT", &port)?;
        option("PROBE_PORT_BITS", &0)?;
        option("PROBE_PORT_BIT_COUNT", &probe.width)?;
        writeln!(out, "      </probeOptions>\n      <nets>")?;
        let name = escaped(&probe.name);
        if probe.vector {
            for bit in (0..probe.width).rev() {
                writeln!(out, "        <net name=\"{name}[{}]\"/>", probe.lsb + bit)?;
            }
        } else {
            writeln!(out, "        <net name=\"{name}\"/>")?;
        }
        writeln!(out, "      </nets>\n    </probe>")?;
    }
    writeln!(out, "  </probeset>\n</probeData>")
}

/// Escapes a text for an attribute.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // XML has no way to write these.
            '\0'..=' ' | '\u{fffe}' | '\u{ffff}' if character != ' ' => escaped.push('\u{fffd}'),
            character => escaped.push(character),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ila::{Probe, Radix};

    #[test]
    fn nets_are_named_bit_by_bit_from_the_top() {
        let name = "u/<const0>_\"17\"&".to_owned();
        let bus = Probe { name, width: 2, lsb: 4, vector: true, radix: Radix::Hex };
        let name = "valid".to_owned();
        let wire = Probe { name, width: 1, lsb: 0, vector: false, radix: Radix::Hex };
        let mut out = Vec::new();
        ltx(&mut out, &Capture::new(vec![bus, wire])).unwrap();
        let text = String::from_utf8(out).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let nets = document.descendants().filter_map(|node| {
            if node.has_tag_name("net") { node.attribute("name") } else { None }
        });
        let names: Vec<_> = nets.collect();
        assert_eq!(names, ["u/<const0>_\"17\"&[5]", "u/<const0>_\"17\"&[4]", "valid"]);
        assert!(text.contains("\"PROBE_PORT_BIT_COUNT\" value=\"2\""));
        assert!(text.contains("<probeData version=\"2\" minor=\"2\">"));
        assert!(
            text.contains("type=\"ila\" busType=\"bus\" source=\"netlist\" spec=\"ILA_V2_RT\"")
        );
    }
}
