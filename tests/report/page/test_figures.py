"""Pictures in a report: each finding has one or a word how to get it; bounded; nothing but shapes and text."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest
from lxml import etree
from lxml import html as lxml_html

from rosprivacy.analysis.errors import DrawingError
from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
from rosprivacy.documents import document_of
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.document.contents import PATHS
from rosprivacy.report.finding_facts import in_order
from rosprivacy.report.page import figures as module
from rosprivacy.report.page.figures import (
    DRAWS,
    HIDDEN,
    SAYS,
    Figures,
    Inline,
    Wishes,
    aliases_of,
    figures,
    page_legend,
    page_svg,
    renamed,
)
from rosprivacy.report.page.html import html
from rosprivacy.report.page.outline import outline
from rosprivacy.report.pictures import dot as dot_module
from rosprivacy.report.pictures import graphviz
from rosprivacy.report.pictures.looks import LINE_LOOKS, ROLE_LOOKS
from rosprivacy.report.pictures.privacy import ReachedElements
from rosprivacy.report.pictures.views import FindingViews, finding_view
from rosprivacy.report.redact import redacted
from tests.helpers.graphs import care_home, factory
from tests.helpers.pages import LANGUAGES
from tests.helpers.pictures import hostile, of_findings
from tests.helpers.reports import care

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis

SVG = "{http://www.w3.org/2000/svg}"
ROOT = {"viewBox", "width", "height", "class", "font-family", "font-size", "role", "aria-label"}


def checked(svg: str) -> etree._Element:
    """Nothing but shapes and text: no id, no style, no link, no script, nothing external."""
    root = etree.fromstring(svg)
    assert set(root.attrib) <= ROOT
    for element in root.iter():
        assert element is root or element.tag in DRAWS
        assert element is root or set(element.attrib) <= SAYS
        assert not re.search(r"url|javascript:|https?:", "".join(map(str, element.attrib.values())))
    return root


def texts(root: etree._Element) -> str:
    return "\n".join(str(text.text).replace("\xa0", " ") for text in root.iter(f"{SVG}text"))


def made(analysis: Analysis, **wishes: Any) -> list[Inline]:
    found = of_findings(analysis, Wishes(**wishes))
    assert None not in found
    return [one for one in found if one]


def test_pictures_for_a_page_have_its_colours_and_name_both_ends() -> None:
    found = care_home().analysis
    for one, finding in zip(made(found), found.findings, strict=True):
        root = checked(one.svg)
        assert one.all_paths
        assert not re.search(r'(fill|stroke)="(black|#000000|white|#ffffff)"', one.svg)
        assert 'stroke="currentColor"' in one.svg
        assert {finding.source.name, finding.leak.name} <= set(texts(root).splitlines())


def test_a_way_that_is_wide_is_drawn_downwards() -> None:
    found = care_home().analysis
    for one in made(found):
        assert float(str(etree.fromstring(one.svg).get("width")).removesuffix("pt")) <= module.WIDEST


def test_a_picture_for_a_page_is_bounded_whatever_the_names_and_says_so() -> None:
    (one,) = of_findings(hostile())
    assert one
    assert len(one.svg) < 40_000
    checked(one.svg)
    many = hostile([f"/topic_with_a_long_name/{i}/{'x' * (i % 7)}" for i in range(500)])
    folded = of_findings(many)[0]
    assert folded
    assert len(folded.svg) < 10_000
    assert folded.all_paths  # all are on one box, which says how many they are


def test_what_is_not_whole_says_so_and_how_to_get_the_rest() -> None:
    result = factory(2)
    told = outline(result.document(), "en")
    one = made(result.analysis)[0]
    page = html(told, Figures({told.entries[0].id: Inline(one.svg, all_paths=False)}))
    assert "Only the shorter paths are drawn" in page
    assert f"rosprivacy graph … --finding {told.entries[0].id}" in page
    assert "Only the shorter paths" not in html(told, Figures({told.entries[0].id: one}))


def test_the_time_that_a_picture_takes_decides_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rule S14: what takes too long is an error, no smaller picture and no missing one."""
    monkeypatch.setattr(module, "SECONDS", 1e-9)
    with pytest.raises(
        DrawingError, match=r"^graph: a picture takes more than 1e-09 seconds; try again .*--format markdown$"
    ):
        of_findings(care_home().analysis)


def test_hostile_names_stay_text() -> None:
    found = hostile()
    for one in made(found, bound=100):
        root = checked(one.svg)
        assert "<script>alert(1)</script>" in "".join(root.itertext())


def test_only_what_is_known_to_draw_stays() -> None:
    picture = FindingViews(PathsToLeaks(care_home().analysis)).of(care_home().analysis.findings[0])
    evil = (
        '<svg width="9pt" height="9pt" viewBox="0 0 9 9" xmlns="http://www.w3.org/2000/svg" onload="x()">'
        '<script>x()</script><style>*{}</style><image href="http://127.0.0.1/"/><foreignObject/><?x y?><!-- c -->'
        '<g class="edge" id="e" onclick="x()" style="fill:red"><title>t</title>'
        '<a href="javascript:x()"><path d="M1"/></a>'
        '<path d="M0.123,1" fill="url(#x)" stroke="black"/></g></svg>'
    )
    root = checked(page_svg(evil.encode(), picture, 'a "way" <b>'))
    assert [str(element.tag).removeprefix(SVG) for element in root.iter()] == ["svg", "g", "path"]
    assert dict(root[0][0].attrib) == {"d": "M0.1,1", "stroke": "currentColor"}
    assert root.get("aria-label") == 'a "way" <b>'


def test_each_way_has_its_picture_and_says_it_in_words() -> None:
    result = care_home()
    told = outline(result.document(), "en")
    drawn = figures(document_of(result, (PATHS,)), told)
    page = lxml_html.document_fromstring(html(told, drawn))
    pictures = page.xpath("//figure[@class='picture']//*[@role='img']")
    assert [picture.get("aria-label") for picture in pictures] == [
        "Picture of the path: " + " → ".join(e["name"] for e in finding["witness"])
        for finding in in_order(care()["findings"], care())
    ]
    assert "no picture" not in page.text_content()
    assert set(drawn.of) == {entry.id for entry in told.entries}


def test_what_has_no_room_is_left_out_in_order_and_it_says_how_many_and_how_to_get_them() -> None:
    result = care_home()
    told = outline(result.document(), "en")
    every = figures(document_of(result, (PATHS,)), told)
    first = [entry.id for entry in told.entries][:1]
    some = figures(document_of(result, (PATHS,)), told, room=len(every.of[first[0]].svg.encode()))
    assert list(some.of) == first
    page = html(told, some)
    assert "2 of the paths below have no picture here" in page
    assert [f"--finding {entry.id}" in page for entry in told.entries] == [False, True, True]


def test_what_graphviz_cannot_draw_is_left_out_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    result = care_home()
    told = outline(result.document(), "en")
    second = told.entries[1].source
    real = dot_module.dot

    def dot(picture: Any, **options: Any) -> str:
        broken = any(second in box.names for box in picture.boxes)
        return "no graph" if broken else real(picture, **options)

    monkeypatch.setattr(module, "dot", dot)
    drawn = figures(document_of(result, (PATHS,)), told)
    missing = [entry.id for entry in told.entries if entry.id not in drawn.of]
    assert missing
    assert told.entries[1].id in missing
    assert f"{len(missing)} of the paths below have no picture here" in html(told, drawn)


@pytest.mark.parametrize("language", ["en", "de", "fr"])
def test_without_graphviz_the_report_says_in_one_place_how_to_get_pictures(
    language: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(graphviz, "find_spec", lambda _: None)
    result = care_home()
    told = outline(result.document(), language)
    drawn = figures(document_of(result, (PATHS,)), told)
    assert drawn == Figures(installed=False)
    page = html(told, drawn)
    assert page.count("[views]") == 1
    assert "<figure" not in page
    assert 'id="h-legend"' not in page
    assert "--finding" not in page


def test_a_redacted_report_has_redacted_pictures() -> None:
    result = care_home()
    document = result.document()
    (copy,) = redacted([document])
    told = outline(copy, "en", redacted=True)
    drawn = figures(document_of(result, (PATHS,)), told, aliases_of(document, copy))
    page = html(told, drawn)
    names = {element.name for element in result.analysis.graph.elements if len(element.name) > 4}
    assert len(drawn.of) == len(told.entries)
    assert not [name for name in names if name in page]
    shown = texts(etree.fromstring(drawn.of[told.entries[0].id].svg))
    assert told.entries[0].source in shown
    assert told.entries[0].leak in shown


def test_what_has_no_alias_has_no_name() -> None:
    found = care_home().analysis
    picture = renamed(finding_view(PathsToLeaks(found), found.findings[0]), {})
    assert all(name.startswith("…") for box in picture.boxes for name in box.names)
    assert picture.title == ""
    assert len(picture.keys) == len(picture.boxes)


def test_the_legend_can_explain_every_role_in_each_language() -> None:
    every = {*ROLE_LOOKS, *LINE_LOOKS, HIDDEN}
    for language in LANGUAGES:
        looks = page_legend(Words(language), every)
        assert len(looks) == len(ROLE_LOOKS) + 5
        assert len({words for _, _, words in looks}) == len({look for look, _, _ in looks}) == len(looks)


def test_the_legend_of_a_page_has_what_is_in_its_pictures_and_no_more() -> None:
    result = care_home()
    told = outline(result.document(), "en")
    drawn = figures(document_of(result, (PATHS,)), told)
    page = lxml_html.document_fromstring(html(told, drawn))
    samples = page.xpath("//div[@class='legend']//li")
    words = [sample.text_content().strip() for sample in samples]
    assert words == [said for *_, said in page_legend(Words("en"), drawn.looks)]
    assert Words("en")("phrase.look.source") in words
    assert Words("en")("phrase.look.open") not in words  # all is reviewed in the care home
    assert all(sample.find("svg").get("aria-hidden") == "true" for sample in samples)


def test_what_pictures_share_is_made_once_for_each_kind_of_data(monkeypatch: pytest.MonkeyPatch) -> None:
    """So that the time grows with the findings, not with findings times elements."""
    asked: list[str] = []

    def reached(analysis: Analysis, categories: set[str], say: Any) -> Any:
        asked.extend(categories)
        return ReachedElements(analysis, categories, say)

    monkeypatch.setattr("rosprivacy.report.pictures.views.ReachedElements", reached)
    found = factory(2).analysis
    made(found)
    assert len(found.findings) > 1
    assert sorted(asked) == sorted({finding.category for finding in found.findings})


def test_the_room_is_that_of_a_file_that_can_be_mailed() -> None:
    assert module.ROOM <= 6 * 2**20


def test_the_first_picture_has_the_shortest_paths_of_what_is_to_be_decided_and_nothing_else() -> None:
    result = care_home()
    told = outline(result.document(), "en")
    drawn = figures(document_of(result, (PATHS,)), told)
    assert drawn.overview
    assert drawn.drawn == told.opening.count == 3
    page = lxml_html.document_fromstring(html(told, drawn))
    (picture,) = page.xpath("//section[@id='decide']//figure")
    texts = {text.text for text in picture.iter("text")}
    names = {element["name"] for finding in care()["findings"] for element in finding["witness"]}
    assert names <= texts
    assert {text for text in texts if text.startswith("/")} == names
    assert picture.xpath(".//figcaption/a/@href") == ["#h-legend"]


def test_the_first_picture_stays_small_and_says_what_it_leaves_out(monkeypatch: pytest.MonkeyPatch) -> None:
    result = care_home()
    told = outline(result.document(), "en")
    monkeypatch.setattr("rosprivacy.report.page.figures.OVERVIEW", 8)
    drawn = figures(document_of(result, (PATHS,)), told)
    assert drawn.drawn == 1
    assert "The shortest paths of the first 1 of 3 to decide" in html(told, drawn)
