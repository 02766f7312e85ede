//! Reads the interface of a module from Verilator's XML.

use roxmltree::{Document, Node};

use tofsim::error::{Input, Result};

use super::{Interface, PortShape};

/// The `var` elements of the module, with the types that they refer to.
///
/// # Errors
/// When it is no XML, or the module is not in it.
pub fn read(text: &str, module: &str) -> Result<Interface> {
    let fault = |what: String| Input::new("verilator --xml-only", what);
    let document = Document::parse(text).map_err(|error| fault(format!("no XML: {error}")))?;
    let is_meant = |node: &Node| {
        let names = [node.attribute("origName"), node.attribute("name")];
        node.has_tag_name("module") && names.contains(&Some(module))
    };
    let found = document.descendants().find(is_meant);
    let found = found.ok_or_else(|| fault(format!("no module {module} in it")))?;
    let mut interface = Interface::default();
    for variable in found.children().filter(|node| node.has_tag_name("var")) {
        let Some(name) = variable.attribute("name") else { continue };
        if variable.attribute("param") == Some("true") {
            interface.parameters.insert(name.to_owned());
        } else if let Some(direction) = variable.attribute("dir") {
            let (width, words) =
                shape(&document, variable.attribute("dtype_id")).unwrap_or((1, None));
            let output = direction == "output";
            interface.ports.insert(name.to_owned(), PortShape { output, width, words });
        }
    }
    Ok(interface)
}

/// Width of a type [bits], and the indices of an unpacked array.
fn shape(document: &Document, id: Option<&str>) -> Option<(u32, Option<(u32, u32)>)> {
    let in_table = |node: &Node| node.parent().is_some_and(|table| table.has_tag_name("typetable"));
    let node = document.descendants().find(|node| in_table(node) && node.attribute("id") == id)?;
    let sub = || shape(document, node.attribute("sub_dtype_id"));
    match node.tag_name().name() {
        "refdtype" | "enumdtype" => sub(),
        "structdtype" => {
            let members = node.children().filter(|node| node.has_tag_name("memberdtype"));
            let width = |member: Node| Some(shape(document, member.attribute("sub_dtype_id"))?.0);
            Some((members.map(width).sum::<Option<u32>>()?, None))
        }
        array @ ("packarraydtype" | "unpackarraydtype") => {
            let (first, last) = range(node)?;
            let width = sub()?.0 * (first.abs_diff(last) + 1);
            Some((width, (array == "unpackarraydtype").then_some((first, last))))
        }
        _ => {
            let number =
                |name| node.attribute(name).map_or(Some(0), |text| text.parse::<i64>().ok());
            Some((number("left")?.abs_diff(number("right")?) as u32 + 1, None))
        }
    }
}

/// The two constants of an array's range.
fn range(array: Node) -> Option<(u32, u32)> {
    let constants = array.descendants().filter(|node| node.has_tag_name("const"));
    let number = |node: Node| {
        let digits = node.attribute("name")?.rsplit('h').next()?.to_owned();
        u32::from_str_radix(&digits, 16).ok()
    };
    let mut numbers = constants.map(number);
    Some((numbers.next()??, numbers.next()??))
}

#[cfg(test)]
mod tests {
    use super::*;

    const XML: &str = r#"<verilator_xml><netlist>
        <module name="a" origName="a">
          <var name="N" dtype_id="1" param="true"/>
          <var name="K" dtype_id="1" localparam="true"/>
          <var name="clk" dtype_id="2" dir="input"/>
          <var name="depth" dtype_id="5" dir="output"/>
          <var name="counts" dtype_id="4" dir="output"/>
          <func name="f"><var name="x" dtype_id="1" dir="input"/></func>
        </module>
        <typetable>
          <basicdtype id="1" name="logic" left="15" right="0"/>
          <basicdtype id="2" name="logic"/>
          <unpackarraydtype id="4" sub_dtype_id="1"><range>
            <const name="32'sh0"/><const name="32'shff"/>
          </range></unpackarraydtype>
          <refdtype id="5" name="depth_t" sub_dtype_id="1"/>
        </typetable></netlist></verilator_xml>"#;

    #[test]
    fn widths_go_through_arrays_and_names_of_types() {
        let Interface { ports, parameters } = read(XML, "a").unwrap();
        let shape = |output, width, words| PortShape { output, width, words };
        assert_eq!(ports["clk"], shape(false, 1, None));
        assert_eq!(ports["depth"], shape(true, 16, None));
        assert_eq!(ports["counts"], shape(true, 4096, Some((0, 255))));
        assert_eq!(
            (ports.len(), parameters.into_iter().collect::<Vec<_>>()),
            (3, vec!["N".to_owned()])
        );
        assert!(read(XML, "b").unwrap_err().to_string().contains("no module b"));
    }
}
