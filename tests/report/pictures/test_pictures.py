"""The formats: what they hold is read back by other programs' readers, and names that mean harm do none."""

from __future__ import annotations

import re
import runpy
import struct
import subprocess
import sys
from itertools import combinations
from typing import TYPE_CHECKING, Any

import networkx as nx
import pygraphviz
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

import rosprivacy
from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
from rosprivacy.analysis.text import printable, shortened
from rosprivacy.report.pictures import looks, narrow, views
from rosprivacy.report.pictures.dot import dot, label_lines
from rosprivacy.report.pictures.exports import graphml, label, mermaid, too_large
from rosprivacy.report.pictures.graphviz import drawn
from rosprivacy.report.pictures.phrases import broken, quoted
from tests.helpers.daily import one_in
from tests.helpers.graphs import care_home, factory
from tests.helpers.paths import ROOT
from tests.helpers.pictures import HOSTILE, hostile, pictures, ros

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.report.pictures.picture import Picture
    from tests.helpers.command import Cli

SVG = "{http://www.w3.org/2000/svg}"
PLACES = {"points", "d", "x", "y", "cx", "cy", "rx", "ry", "width", "height", "viewBox", "transform", "textLength"}
DRAWN = runpy.run_path(str(ROOT / "docs" / "draw_pictures.py"))
KNOWN = {"svg", "g", "title", "desc", "polygon", "path", "ellipse", "text", "polyline"}


def hostile_pictures() -> dict[str, Picture]:
    found = hostile()
    grouped = narrow.grouped(views.ros_view(found), "enclave", found.graph.profiles)
    finding = views.finding_view(PathsToLeaks(found), found.findings[0])
    return {
        "ros": grouped,
        "privacy": views.privacy_view(PathsToLeaks(found)),
        "finding": finding,
        "folded": narrow.folded(grouped),
    }


@pytest.fixture(params=["ros", "privacy", "finding", "folded"])
def evil(request: pytest.FixtureRequest) -> Picture:
    return hostile_pictures()[request.param]


def check_svg(text: str | bytes) -> etree._Element:
    """Nothing in it but shapes and text: no script, no link, no reference, nothing external."""
    root = etree.fromstring(text.encode() if isinstance(text, str) else text)
    assert root.getroottree().docinfo.doctype == ""
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(ids) == len(set(ids))
    for element in root.iter():
        assert isinstance(element.tag, str)
        assert element.tag.removeprefix(SVG) in KNOWN
        for name, value in element.attrib.items():
            assert not str(name).startswith("on")
            assert "href" not in str(name)
            assert not re.search(r"url\(|javascript:|https?:", str(value))
    for reference in str(root.get("aria-labelledby")).split():
        assert reference in ids
    return root


def texts(root: etree._Element) -> set[str]:
    return {str(element.text).replace("\xa0", " ") for element in root.iter(f"{SVG}text")}


def check_boxes(picture: Picture, root: etree._Element) -> None:
    """Every line of every label is drawn letter by letter, and every box says what it is."""
    shown = texts(root)
    for box in picture.boxes:
        for line in label_lines(picture, box):
            assert line in shown
    tips = {str(group.get("id")): str(group.findtext(f"{SVG}title")) for group in root.iter(f"{SVG}g")}
    for box in picture.boxes:
        (tip,) = [tip for id_, tip in tips.items() if id_.endswith(picture.keys[box.key]) and tip != "None"][:1]
        assert tip.startswith(shortened(box.names[0], 200))


def test_hostile_names_in_svg(evil: Picture) -> None:
    root = check_svg(drawn(evil, "svg").data)
    check_boxes(evil, root)
    assert root[0].tag == f"{SVG}title"
    assert root[0].text == printable(evil.title)
    assert root[1].tag == f"{SVG}desc"


def test_hostile_names_in_png(evil: Picture) -> None:
    data = drawn(evil, "png").data
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert all(100 < side < 20_000 for side in struct.unpack(">II", data[16:24]))


def test_hostile_names_in_dot(evil: Picture) -> None:
    text = dot(evil)
    assert all(line.isprintable() for line in text.splitlines())
    graph = pygraphviz.AGraph(string=text)
    assert sorted(node for node in graph.nodes() if node[0] == "n") == sorted(evil.keys.values())
    assert all(node[0] in "nls" for node in graph.nodes())  # l and s: the legend
    pairs = {(evil.keys[line.source], evil.keys[line.target]) for line in evil.lines}
    ends = {frozenset(edge[:2]) for edge in graph.edges()}
    assert {pair for pair in ends if all(end[0] == "n" for end in pair)} == {frozenset(pair) for pair in pairs}
    assert all(len({end[0] == "n" for end in pair}) == 1 for pair in ends)
    known = {"label", "shape", "style", "fillcolor", "penwidth", "peripheries", "fontcolor", "id", "tooltip"}
    assert {name for node in graph.nodes() for name, value in node.attr.items() if value} <= {
        *known, "color", "fontname", "fontsize", "margin", "height",
    }  # fmt: skip


def test_hostile_names_in_graphml(evil: Picture) -> None:
    """Whole, but for what XML cannot say."""
    graph = nx.parse_graphml(graphml(evil))
    for box in evil.boxes:
        read = graph.nodes[evil.keys[box.key]]
        assert read["names"] == "\n".join(map(printable, box.names))
        assert read["kind"] == box.kind
    assert graph.number_of_edges() == len(evil.lines)


QUOTED = r'"(?:[A-Za-z0-9/_.,()* -]|#\d+;|<br/>)*"'
SHAPE = r"(?:\(\[|\[\[|\{\{|\[\(|\(\(|\[/|\[\\|\[|>)"
MERMAID_LINES = [
    r"flowchart (LR|TB)",
    r"  acc(Title|Descr): [^\n;#{}<>\"]*",
    r"  subgraph g\d+\[" + QUOTED + r"\]",
    r"    direction (LR|TB)",
    r"  end",
    r"  (?:  )?[nl]\d+" + SHAPE + QUOTED + r"[\])}/\\]{1,2}(:::Look[A-Za-z]+)?",
    r'    s\d+\(\(" "\)\) (-->|==>|-\.->|--x|-\.-x) t\d+\[' + QUOTED + r"\]",
    r"  n\d+ <?x?(?:--|==|-\.-)[>x] n\d+",
    r"  linkStyle \d+ (stroke:#[0-9a-f]{6},)?stroke-width:[\d.]+px",
    r'  subgraph legend\["Legend"\]',
    r"  classDef [A-Z]\w+ [a-z0-9:#,. -]+",
    r"  class [nl\d,]+ Unreviewed",
]


@pytest.mark.parametrize("name", [*(f"evil {name}" for name in hostile_pictures()), *pictures()])
def test_every_line_of_mermaid_is_one_of_a_few_harmless_forms(name: str) -> None:
    picture = hostile_pictures()[name[5:]] if name.startswith("evil ") else pictures()[name]
    text = mermaid(picture)
    for line in text.splitlines():
        assert any(re.fullmatch(form, line) for form in MERMAID_LINES), line
    links = sum(bool(re.match(r"\s+[ns]\d+(\(.*\))? \S*[-=]", line)) for line in text.splitlines())
    styles = [int(n) for n in re.findall(r"linkStyle (\d+)", text)]
    assert styles == list(range(links))


def decoded(text: str) -> str:
    return re.sub(r"#(\d+);", lambda number: chr(int(number[1])), text)


@given(st.text())
def test_a_label_of_mermaid_says_what_it_is_given(name: str) -> None:
    assert decoded(label(name)) == printable(name)
    assert re.fullmatch(QUOTED, f'"{label(name)}"')


@given(st.text(min_size=1, max_size=40))
def test_graphviz_draws_what_a_quoted_string_says(name: str) -> None:
    """Letter by letter, for any text: no escape, no entity, no end of the string."""
    graph = pygraphviz.AGraph(string=f"digraph {{ a [label={quoted('|' + name + '|')}] }}")
    root = etree.fromstring(graph.draw(format="svg", prog="dot"), etree.XMLParser(load_dtd=False))
    graph.close()
    assert "".join(root.itertext(f"{SVG}text", with_tail=False)).replace("\xa0", " ") == f"|{printable(name)}|"


@given(st.text())
def test_a_name_is_broken_into_few_short_lines(name: str) -> None:
    lines = broken(name)
    assert 1 <= len(lines) <= 3
    assert all(len(line) <= 28 and line.isprintable() for line in lines)
    if len(printable(name)) <= 28:
        assert "".join(lines) == printable(name)


def test_hostile_names_come_through_the_command_line(cli: Cli, tmp_path: Path) -> None:
    """From a policy file to each format, with no name that ends anything."""
    names = [name for name in HOSTILE if name.isprintable()]
    escaped = [name.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;") for name in names]
    topics = "".join(f"<topic>{name}</topic>" for name in escaped)
    policy = tmp_path / "evil.policy.xml"
    policy.write_text(
        '<policy version="0.2.0"><enclaves><enclave path="/&lt;b&gt;"><profiles>'
        f'<profile ns="/" node="a"><topics publish="ALLOW">{topics}</topics></profile>'
        f'<profile ns="/" node="&lt;script&gt;"><topics subscribe="ALLOW">{topics}</topics></profile>'
        "</profiles></enclave></enclaves></policy>",
        "utf-8",
    )
    labels = tmp_path / "labels.yaml"
    labels.write_text("labels: 1\nnodes:\n  /a: {source: [Video]}\n  '/<script>': {leak: [Video]}\n", "utf-8")
    for form in ("svg", "graphml"):
        output = tmp_path / f"picture.{form}"
        options = ["--labels", labels, "--show", "privacy", "--cluster", "enclave", "--output", output]
        done = cli("graph", policy, *map(str, options))
        assert (done.returncode, done.stderr) == (0, "")
        root = etree.fromstring(output.read_bytes())
        assert not list(root.iter("{*}script"))
        assert "<script>" in "".join(root.itertext())


def test_the_description_tells_the_ways_to_people_who_do_not_see_the_picture() -> None:
    root = check_svg(drawn(views.privacy_view(PathsToLeaks(factory(2).analysis)), "svg").data)
    assert root.get("role") == "img"
    assert root[0].text == "Where Video can go (declared): data can get out"
    assert "Video: /safety_camera to /safety_video to /archive_server." in str(root[1].text)


def test_tips_name_the_policy_line() -> None:
    root = check_svg(drawn(ros(factory(2)), "svg").data)
    tips = [str(title.text) for title in root.iter(f"{SVG}title")]
    assert any(t.startswith("/safety_camera to /safety_video (allowed") and "before.policy.xml:54" in t for t in tips)


def test_large_flowcharts_are_known_to_be_refused_by_mermaid() -> None:
    small, large = (
        views.privacy_view(PathsToLeaks(factory(2).analysis)),
        views.privacy_view(PathsToLeaks(hostile([f"/t{i}" for i in range(300)]))),
    )
    assert not too_large(small, mermaid(small))
    assert too_large(large, mermaid(large))


def luminance(colour: str) -> float:
    parts = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one: str, other: str) -> float:
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def test_text_and_lines_stand_out_from_what_is_behind_them() -> None:
    """WCAG 2.2, 1.4.3 and 1.4.11: 4.5 for text, 3 for lines."""
    for look in [*looks.KIND_LOOKS.values(), *looks.ROLE_LOOKS.values()]:
        assert contrast(looks.TEXT, look.colour) >= 4.5, look
    for look in looks.LINE_LOOKS.values():
        assert contrast(looks.PAPER, look.colour) >= 3, look


def test_looks_differ_in_more_than_colour() -> None:
    """Kinds by shape; lines by width, dashes or head; roles by outline, or by words that stand on the box."""
    shapes = [shape.graphviz for shape in looks.SHAPES.values()]
    assert len(set(shapes)) == len(shapes)
    for one, other in combinations(looks.LINE_LOOKS.values(), 2):
        alike = (one.width, one.style, one.head) == (other.width, other.style, other.head)
        assert not alike or {one.words, other.words} == {
            looks.LINE_LOOKS["allowed"].words, looks.LINE_LOOKS["data"].words,  # never in one picture
        }  # fmt: skip
    in_words = {"derivation", "sanitizer"}
    outlines = {name: (x.width, x.style, x.double) for name, x in looks.ROLE_LOOKS.items() if name not in in_words}
    assert len(set(outlines.values())) == len(outlines)
    said = [
        word
        for box in views.privacy_view(PathsToLeaks(care_home().analysis)).boxes
        if box.look in in_words
        for word in box.words
    ]
    assert {word.split()[0] for word in said} == {"makes", "pseudonymises", "ends"}


@pytest.mark.slow
def test_a_picture_without_graphviz_needs_no_graphviz() -> None:
    code = (
        "import sys; sys.modules['pygraphviz'] = None\nfrom rosprivacy.cli.app import main\n"
        "sys.argv = ['rosprivacy', 'graph', 'examples/factory/before.policy.xml', '--format', '{}']\nmain()"
    )
    for form, start in (("dot", "digraph"), ("mermaid", "flowchart"), ("graphml", "<?xml")):
        done = subprocess.run(
            [sys.executable, "-c", code.format(form)], cwd=ROOT, capture_output=True, text=True, check=True
        )
        assert done.stdout.startswith(start)
    assert rosprivacy.__version__


@pytest.mark.slow
def test_a_report_without_graphviz_is_written_with_the_same_exit_code(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['pygraphviz'] = None\nfrom rosprivacy.cli.app import main\n"
        "sys.argv = ['rosprivacy', *{}]\nmain()"
    )
    system = ["examples/factory/before.policy.xml", "-l", "examples/factory/run2.labels.yaml", "-o"]
    for command, status in ((["report"], 0), (["analyze", "--format", "html"], 1)):
        page = tmp_path / f"{command[0]}.html"
        words = [*command, *system, str(page)]
        done = subprocess.run(
            [sys.executable, "-c", code.format(words)], cwd=ROOT, capture_output=True, text=True, check=False
        )
        assert done.returncode == status, done.stderr
        (line,) = done.stderr.splitlines()
        assert "pygraphviz" in line
        assert page.read_text("utf-8").count("[views]") == 1


def test_the_pictures_of_the_documentation_are_shown_there_and_can_be_read_on_a_page() -> None:
    """Letters of 11 points on a picture of 1,100 are 9 dots high on a page of 900."""
    page = "".join((ROOT / "docs" / f"{name}.md").read_text("utf-8") for name in ("views", "what-it-finds"))
    files = sorted((ROOT / "docs" / "pictures").glob("*.svg"))
    assert {drawing.name for drawing in DRAWN["PICTURES"]} == {file.stem for file in files}
    for file in files:
        assert f"](pictures/{file.name})" in page
        root = check_svg(file.read_bytes())
        if not file.stem.endswith("-all"):
            assert int(str(root.get("width")).removesuffix("pt")) <= 1100, file.name


@pytest.mark.parametrize(
    "drawing", one_in(4, [d for d in DRAWN["PICTURES"] if d.system != "turtlebot3"], in_ci=1), ids=lambda d: str(d.name)
)
def test_the_pictures_of_the_documentation_are_what_the_program_draws(drawing: Any, cli: Cli, tmp_path: Path) -> None:
    """Not byte for byte: where boxes and lines stand depends on the fonts of the machine. All else has to be equal."""
    system = DRAWN["SYSTEMS"][drawing.system]
    file = tmp_path / "drawn.svg"
    assert cli("graph", *system.files, *drawing.options.split(), "-o", file, cwd=system.folder).returncode == 0
    kept = (ROOT / "docs" / "pictures" / f"{drawing.name}.svg").read_bytes()
    assert shapes(file.read_bytes()) == shapes(kept), "python docs/draw_pictures.py draws them anew"


def shapes(svg: bytes) -> list[tuple[str, dict[str, str], str]]:
    """The elements of a picture in their order, with all that is not a place or a size."""
    tree = etree.fromstring(svg)
    return [
        (str(e.tag), {name: value for name, value in e.attrib.items() if name not in PLACES}, e.text or "")
        for e in tree.iter()
    ]
