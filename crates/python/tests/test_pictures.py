"""What a notebook shows."""

import xml.etree.ElementTree as ElementTree

import tofsim


def test_frames_evaluations_and_scenarios_have_pictures() -> None:
    frame = tofsim.simulate("kc705", 1, by_cause=True)[0]
    svg = frame._repr_svg_()
    ElementTree.fromstring(svg)
    for word in ["signal: ", "ambient: ", "true: 0.5000 m", "estimated: "]:
        assert word in svg, word
    plain = tofsim.simulate("kc705", 1, "shot")[0]._repr_svg_()
    ElementTree.fromstring(plain)
    assert "signal: " not in plain
    evaluation = tofsim.evaluate(rows=102, check=0)
    picture = evaluation._repr_svg_()
    assert picture is not None
    ElementTree.fromstring(picture)
    assert evaluation._repr_html_().startswith("<table>")
    html = tofsim.Scenario("far")._repr_html_()
    assert "<h3>far</h3>" in html and "<table" in html
    for thing in [frame, evaluation, tofsim.Scenario("far"), tofsim.Network()]:
        assert repr(thing).startswith("<tofsim.")
