"""Reports for people: all that the document tells, nothing that it does not; in words that give no verdict of law."""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import json
import os
import re
import string
import subprocess
import sys
from collections import Counter
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import html as lxml_html
from markdown_it import MarkdownIt

from rosprivacy.analysis.errors import InputError
from rosprivacy.report.compare.changes import changes
from rosprivacy.report.compare.difference import difference
from rosprivacy.report.compare.earlier import Earlier, read_earlier
from rosprivacy.report.compare.snapshot import snapshot
from rosprivacy.report.page import article30
from rosprivacy.report.page.html import html
from rosprivacy.report.page.markdown import markdown
from rosprivacy.report.page.outline import Outline, outline
from rosprivacy.report.page.redact import redacted
from rosprivacy.report.page.words import TABLES, Words
from rosprivacy.report.spreadsheet import FORMULA
from tests.helpers.graphs import hospital
from tests.helpers.paths import ROOT
from tests.helpers.reports import HOSTILE, care, fleet, hostile, run, with_decisions, with_outside

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

LANGUAGES = ["en", "de"]
# what a report never says: verdicts of law, promises
FORBIDDEN = re.compile(
    r"\b(violat\w*|illegal\w*|unlawful\w*|breach\w*|complian\w*|comply|safe|harmless|"
    r"versto\w*|verletz\w*|illegal\w*|rechtswidrig\w*|unzulässig\w*|\w*konform\w*|sicher|unbedenklich|datenpanne)\b",
    re.IGNORECASE,
)


def told(document: dict[str, Any], language: str = "en", **options: Any) -> Outline:
    return outline(document, language, **options)


def page(document: dict[str, Any], language: str = "en", **options: Any) -> Any:
    return lxml_html.document_fromstring(html(told(document, language, **options)))


def texts(document: dict[str, Any], language: str = "en", **options: Any) -> Iterator[str]:
    """The report in both forms, as text without marks."""
    report = told(document, language, **options)
    yield lxml_html.document_fromstring(html(report)).text_content()
    yield re.sub(r"\\(.)", r"\1", markdown(report))


# ---------------------------------------------------------------- words


def test_every_language_has_the_same_words_with_the_same_places() -> None:
    def places(text: str) -> set[str]:
        return {name for _, name, _, _ in string.Formatter().parse(text) if name}

    tables = [{key: places(text) for key, text in table.items()} for table in TABLES.values()]
    assert tables[0] == tables[1]


def test_every_word_is_used_and_every_use_has_a_word() -> None:
    page = ROOT / "report" / "page"
    files = [*page.glob("*.py"), *(page / "templates").glob("*.j2"), ROOT / "analysis" / "durations.py"]  # its units
    source = "\n".join(file.read_text("utf-8") for file in files if not file.name.startswith("words_"))
    used = set(re.findall(r"[\"']([a-z0-9-]+(?:\.[a-z0-9_-]+)+)[\"']", source))
    ends = {".one", ".many"}
    families = set(re.findall(r"f?[\"']([a-z0-9.-]+\.)(?:[\"'] ~|\{)", source))
    for key in TABLES["en"]:
        stem = re.sub(r"\.(one|many)$", "", key)
        known = key in used or f'"{key}"' in source or f"'{key}'" in source or any(key.startswith(f) for f in families)
        assert known or (any(key.endswith(end) for end in ends) and f'"{stem}"' in source), key


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_word_is_a_verdict_of_law_or_a_promise(language: str) -> None:
    for key, text in TABLES[language].items():
        assert not FORBIDDEN.search(text), (key, text)


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("document", [care(), run(3), run(5)], ids=["care", "run3", "run5"])
def test_no_report_gives_a_verdict_of_law_or_a_promise(document: dict[str, Any], language: str) -> None:
    for text in texts(document, language):
        assert not FORBIDDEN.search(text), FORBIDDEN.search(text)


# ---------------------------------------------------------------- what it tells


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_finding_is_told_with_its_way_lines_and_law(language: str) -> None:
    document = care()
    for text in texts(document, language):
        for finding in document["findings"]:
            assert finding["id"] in text
            for element in finding["witness"]:
                assert element["name"] in text
            for step in finding["steps"]:
                for grant in step["policy"]:
                    assert f"{grant['file']}:{grant['line']}" in text
                    assert grant["enclave"] in text
        for category in document["categories"]:
            said = category["translations"].get(language, category)
            assert said["title"] in text
            assert said["definition"] in text
            for legal in category["law"]:
                law = {**legal, **legal["translations"].get(language, {})}
                assert law["provision"] in text
                assert law["condition"] in text or law["condition"].startswith("⊇")
                assert law["meaning"] in text


def test_each_assumption_is_told() -> None:
    document = care()
    document["assumptions"] |= {"categories_asked": ["Video"], "article9_only": True, "data_types_asked": ["video"]}
    document["assumptions"]["sanitizers_without_method"] = [
        {"element": document["findings"][0]["source"], "category": "Video", "taken_as": "pseudonymise"}
    ]
    for text in texts(document):
        for file in (*document["assumptions"]["policies"], *document["assumptions"]["labels"]):
            assert file["file"] in text
            assert file["sha256"] in text
        assert "each node does what its own profile in the policy says" in text
        assert "75 standard ROS channels taken to carry no personal data" in text
        assert "only about these kinds of data and narrower ones: Video. Others were not looked at" in text
        assert "only about data of these types: video" in text
        assert "only about data that can fall under Article 9(1)" in text
        assert "no label states how. It was taken as pseudonymisation" in text
        assert "The law is that of 2026-04-30" in text


@pytest.mark.parametrize(
    ("change", "verdict"),
    [
        ({}, "Personal data can reach a place that a person has to assess"),
        (
            {"verdict": "undetermined", "findings": [], "open": "some"},
            "Not determined: what data can pass is not reviewed",
        ),
        ({"verdict": "no-leak-found", "findings": []}, "No path to a recipient was found under the labels given"),
        ({"verdict": "undetermined", "findings": [], "open": []}, "no source was named, so no data was followed"),
        ({"verdict": "undetermined", "findings": [], "categories": []}, "no source was named, so no data was followed"),
    ],
)
def test_the_verdict_says_what_was_found_and_what_it_does_not_mean(change: dict[str, Any], verdict: str) -> None:
    document = care() | change
    if document["open"] == "some":
        where = document["carries"][0]["element"]
        document["open"] = [{"element": where, "categories": ["Video"], "distance": 1, "frontier": True}]
    if not document["categories"]:
        document |= {"roles": [], "derivations": [], "sanitizers": [], "carries": [], "subjects": []}
    for text in texts(document):
        assert verdict in text
        assert "This report is no legal verdict" in text


def test_where_data_become_special_is_told() -> None:
    for text in texts(care()):
        assert (
            "/face_recognizer makes data of this kind, which can be a special category, of data that are none" in text
        )
        assert "can be a special category from here on" in text


def test_pseudonymised_data_is_still_personal_and_asks_its_question() -> None:  # recital 26
    for text in texts(care()):
        assert "can this recipient do so, alone or with what others hold?" in text
        assert "pseudonymises: still personal data" in text


def test_open_elements_are_told_in_the_order_of_review() -> None:
    document = run(2)
    names = [row["element"]["name"] for row in document["open"]]
    assert [(group.key, [question.name for question in group.questions]) for group in told(document).questions] == [
        ("q.first", ["/robot_arm_control"]),
        ("q.channels", [name for name in names if name != "/robot_arm_control"]),
    ]


def test_what_passes_beside_a_sanitizer_is_told() -> None:
    (row,) = told(run(5)).cleanings
    assert (row.name, row.beside) == ("/filter", ("/emergency_stop",))


def test_a_way_that_does_not_lead_through_a_sanitizer_is_named_beside_it() -> None:
    document = run(3)
    document["sanitizers"] = [
        {
            "element": {"robot": "", "kind": "node", "name": "/filter"}, "category": "Video", "method": "drop",
            "stated": True, "reached": True, "leaves": [], "leaves_pseudonymised": [], "beside": [],
        }
    ]  # fmt: skip
    report = told(document)
    assert [number for _, number in report.cleanings[0].past] == [way.number for way in report.ways]


def test_the_elements_that_nothing_reaches_are_told_too() -> None:
    document = care()
    for text in texts(document):
        assert all(element["name"] in text for element in document["unreached"])
        assert all(row["element"]["name"] in text for row in document["carries"])
        assert all(row["enclave"] in text for row in document["enclaves"])


def test_the_nine_criteria_show_what_is_seen_and_never_that_no_assessment_is_needed() -> None:
    shown = {row.name: row.shows for row in told(care()).criteria}
    assert len(shown) == 9
    assert "/face_recognizer makes face template of video of persons" in shown["Evaluation or scoring"]
    assert "face template" in shown["Sensitive or highly personal data"]
    assert shown["Vulnerable persons"] == "Persons that labels name: residents, staff, visitors"
    assert shown["Automated decisions with legal or similar effect"] == ""


# ---------------------------------------------------------------- the two tables


def cells(table: Any) -> dict[str, dict[str, str]]:
    return {
        row.name: {column: cell.text for column, cell in zip(table.columns, row.cells, strict=True)}
        for row in table.rows
    }


def test_whose_data_by_kind() -> None:
    report = told(care())
    assert cells(report.subjects) == {
        "residents": {
            "face template": "1 path to assess", "location": "–", "person track": "–",
            "video of persons": "1 path to assess", "voice": "1 path to assess",
        },
        "staff": {
            "face template": "1 path to assess", "location": "–", "person track": "–",
            "video of persons": "1 path to assess", "voice": "1 path to assess",
        },
        "visitors": {
            "face template": "1 path to assess", "location": "–", "person track": "–",
            "video of persons": "1 path to assess", "voice": "–",
        },
        "persons not stated": {
            "face template": "–", "location": "brought in, no path found", "person track": "can be made of it",
            "video of persons": "–", "voice": "–",
        },
    }  # fmt: skip
    assert report.silent == ("/lidar",)


def test_who_gets_which_kind() -> None:
    no = "no path found"
    assert cells(told(care()).recipients) == {
        "/recorder": {
            "face template": no, "location": no, "person track": no,
            "video of persons": "1 path to assess, pseudonymised", "voice": no,
        },
        "/uplink": {
            "face template": "1 path to assess", "location": no, "person track": no, "video of persons": no,
            "voice": "1 path to assess",
        },
    }  # fmt: skip


def test_a_recipient_that_nothing_reaches_is_a_row_all_the_same() -> None:
    document = care() | {"findings": []}
    assert set(cells(told(document).recipients)) == {"/recorder", "/uplink"}


def test_tables_are_cut_into_parts_that_fit_a_page() -> None:
    document = care()
    document["categories"] = [{**document["categories"][0], "name": f"K{i}", "title": f"k{i}"} for i in range(14)]
    document["categories"][3]["name"] = "Video"
    document |= {"findings": [], "roles": [row for row in document["roles"] if row["category"] == "Video"]}
    document |= {"derivations": [], "sanitizers": [], "carries": [], "open": []}
    parts = list(told(document).recipients.parts())
    assert [len(part.columns) for part in parts] == [6, 6, 2]
    assert all(len(row.cells) == len(part.columns) for part in parts for row in part.rows)


# ---------------------------------------------------------------- what other parts of the program add


def test_storages_are_told_with_their_retention_and_what_is_missing() -> None:
    for text in texts(with_outside(care())):
        assert "video of persons: 30 days; everything: 1 year" in text
        assert "yes, for how long is not stated" in text
        assert "country: not stated" in text
        assert "US (adequacy decision for some recipients)" in text
        assert "standard contractual clauses" in text
        assert "Speech Inc." in text
        assert "is kept at archive: without a stated end, or too long" in text
        assert "Reason: no retention is stated" in text
        assert "Members of the EEA and adequacy decisions as of 2026-06-30" in text


def test_decisions_stand_beside_their_way_with_what_they_lack() -> None:
    document = with_decisions(care())
    report = told(document)
    assert [way.state for way in report.ways] == ["accepted", "decided", "open"]
    for text in texts(document):
        assert "staff has to know" in text
        assert "6(1)(c)" in text
        assert "no exception of Article 9(2) is recorded" in text  # Article 6 alone does not do for a special category
        assert "to be mitigated" in text
        assert "matches no path any more" in text
        assert "1 path to assess accepted by a person's decision; section 4 shows each" in text
    assert {what: number for number, what in report.numbers}["paths to assess"] == 2


def test_findings_that_differ_only_in_the_robot_are_one_with_its_robots_listed() -> None:  # S10
    robots = [f"robot{number:02}" for number in range(20)]
    document = fleet(care(), robots)
    report = told(document)
    assert len(document["findings"]) == 60
    assert [len(way.robots) for way in report.ways] == [20, 20, 20]
    assert [row.name for row in report.recipients.rows] == ["/recorder (20 robots)", "/uplink (20 robots)"]
    for text in texts(document):
        assert all(robot in text for robot in robots)
        assert "/uplink (20 robots)" in text
    assert {item.robots for item in report.items} == {20}


def test_a_way_from_robot_to_robot_is_another_pattern_than_one_inside_a_robot() -> None:
    document = fleet(care(), ["a", "b"])
    document["findings"][0]["leak"]["robot"] = "b"
    assert [len(way.robots) for way in told(document).ways] == [0, 2, 2, 0]


# ---------------------------------------------------------------- what changed


def earlier(document: dict[str, Any]) -> Earlier:
    return Earlier(document, "old.json", "0" * 64)


def test_nothing_changed_is_said_so() -> None:
    differ = changes(care(), care())
    assert differ.nothing
    for text in texts(care(), earlier=earlier(care())):
        assert "Nothing changed in what was found" in text


def test_new_gone_and_changed_ways_are_told() -> None:
    old, new = care(), care()
    new["findings"][1]["witness"].insert(1, {"robot": "", "kind": "topic", "name": "/detour"})
    new["findings"][1]["steps"].insert(1, new["findings"][1]["steps"][0])
    gone = new["findings"].pop(0)
    old["findings"].pop(2)
    differ = changes(old, new)
    assert [finding["id"] for finding in differ.gone] == [gone["id"]]
    assert differ.new == (new["findings"][1]["id"],)
    assert differ.changed == {new["findings"][0]["id"]: ("witness",)}
    report = told(new, earlier=earlier(old))
    assert [way.mark for way in report.ways] == ["changed", "new"]
    for text in texts(new, earlier=earlier(old)):
        assert gone["id"] in text
        assert "another shortest path" in text


def test_a_line_that_only_moved_is_no_change() -> None:
    new = care()
    for step in new["findings"][0]["steps"]:
        step["policy"][0]["line"] += 7
    assert changes(care(), new).nothing


def test_a_way_that_is_gone_because_less_was_asked_is_no_answer() -> None:
    new = care()
    new["findings"] = []
    new["verdict"] = "no-leak-found"
    new["assumptions"] |= {"categories_asked": ["Voice"], "view": "enforced"}
    for text in texts(new, earlier=earlier(care())):
        assert "were not made in the same way. A path that is new or gone can come from that alone" in text
        assert "view: 'declared', now 'enforced'" in text
        assert "kinds asked for: all, now Voice" in text


def test_how_many_channels_the_standard_file_took_is_no_other_way_of_asking() -> None:
    new = care()
    new["assumptions"]["standard_channels"]["taken"] = 3
    assert changes(care(), new).scope == ()


def test_files_that_differ_are_named() -> None:
    new = care()
    new["assumptions"]["policies"][0]["sha256"] = "1" * 64
    assert changes(care(), new).files == (new["assumptions"]["policies"][0]["file"],)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", ":1: cannot be read"),
        ("[]", ": is not a document of the format rosprivacy.analysis/1"),
        ('{"format": "rosprivacy.analysis/2"}', ": is not a document of the format"),
        ('{"format": "rosprivacy.analysis/1"}', ": verdict is missing or of another type"),
        ("[" * 100_000, ": cannot be read"),
        ("\ud800", None),
    ],
)
def test_what_is_no_document_is_refused_in_one_line(tmp_path: Path, text: str, message: str | None) -> None:
    file = tmp_path / "old.json"
    file.write_bytes(text.encode("utf-8", "surrogatepass"))
    with pytest.raises(InputError) as caught:
        read_earlier(str(file))
    assert str(caught.value).startswith(str(file))
    assert "\n" not in str(caught.value)
    assert message is None or message in str(caught.value)


@pytest.mark.parametrize(
    "way", [("findings", 0, "witness", 0, "name"), ("open",), ("findings", 0, "id"), ("categories",)]
)
def test_a_damaged_document_is_refused_with_the_place(tmp_path: Path, way: tuple[Any, ...]) -> None:
    document: Any = care()
    inside = document
    for key in way[:-1]:
        inside = inside[key]
    inside[way[-1]] = 7
    file = tmp_path / "old.json"
    file.write_text(json.dumps(document))
    with pytest.raises(InputError, match=re.escape(str(way[-1]))):
        read_earlier(str(file))


# ---------------------------------------------------------------- the page


def test_the_same_document_gives_the_same_bytes() -> None:
    assert html(told(care(), made="2026-11-21")) == html(told(care(), made="2026-11-21"))


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_page_asks_nobody_for_anything(language: str) -> None:
    root = page(care(), language)
    assert root.get("lang") == language
    for node in root.iter():
        for attribute in ("src", "srcset", "action", "data", "poster"):
            assert node.get(attribute, "data:").startswith("data:")
        if node.get("href") is not None:
            assert node.get("href").startswith("#") or node.tag == "link"
    assert [link.get("href") for link in root.iter("link")] == ["data:,"]
    assert "url(" not in root.findtext(".//style")
    assert "@import" not in root.findtext(".//style")


def test_its_policy_names_the_one_style_and_the_one_script_by_their_hashes() -> None:
    root = page(care())
    (policy,) = [m.get("content") for m in root.iter("meta") if m.get("http-equiv") == "Content-Security-Policy"]
    assert policy.startswith("default-src 'none';")
    assert "unsafe" not in policy
    for tag in ("style", "script"):
        (node,) = root.iter(tag)
        digest = base64.b64encode(hashlib.sha256(node.text.encode()).digest()).decode()
        assert f"{tag}-src 'sha256-{digest}'" in policy
    assert not [node for node in root.iter() for name in node.attrib if name == "style" or name.startswith("on")]


def documents() -> list[dict[str, Any]]:
    return [
        care(),
        with_decisions(with_outside(care())),
        run(2),
        fleet(care(), ["a", "b", "c"]),
        care() | {"findings": []},
    ]


@pytest.mark.parametrize("document", documents(), ids=["care", "decided", "open", "fleet", "none"])
def test_every_link_leads_to_something_and_ids_are_unique(document: dict[str, Any]) -> None:
    root = page(document, earlier=earlier(run(2)))
    ids = [node.get("id") for node in root.iter() if node.get("id")]
    assert len(ids) == len(set(ids))
    links = {node.get("href")[1:] for node in root.iter("a")}
    assert links <= set(ids)
    named = [node.get(what) for node in root.iter() for what in ("aria-labelledby", "for", "data-of") if node.get(what)]
    assert set(named) <= set(ids)


@pytest.mark.parametrize("document", documents(), ids=["care", "decided", "open", "fleet", "none"])
def test_headings_go_down_by_one_and_tables_have_captions_and_headers(document: dict[str, Any]) -> None:
    root = page(document)
    levels = [int(node.tag[1]) for node in root.iter("h1", "h2", "h3", "h4", "h5")]
    assert levels[0] == 1
    assert all(below <= above + 1 for above, below in pairwise(levels))
    for table in root.iter("table"):
        assert table.find("caption").text_content().strip()
        assert all(cell.get("scope") == "col" for cell in table.findall("thead/tr/th"))
        widths = {len(row) for row in table.iter("tr")}
        assert len(widths) == 1


# ---------------------------------------------------------------- names that mean harm


def harmless_page(root: Any) -> None:
    assert {node.tag for node in root.iter() if isinstance(node.tag, str)} <= {
        "html", "head", "body", "meta", "link", "title", "style", "script", "a", "div", "header", "p", "h1", "h2", "h3",
        "h4", "nav", "ol", "ul", "li", "main", "section", "article", "footer", "span", "bdi", "dl", "dt", "dd", "table",
        "caption", "thead", "tbody", "tr", "th", "td", "form", "fieldset", "legend", "label", "input", "select",
        "option", "button", "noscript", "figure", "img", "br", "b", "code",
    }  # fmt: skip
    assert len(list(root.iter("script"))) == len(list(root.iter("style"))) == 1
    assert not [name for node in root.iter() for name in node.attrib if name.startswith("on")]
    assert all(link.get("href").startswith("#") for link in root.iter("a"))


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_name_becomes_html(tmp_path: Path, language: str) -> None:
    document = hostile(tmp_path)
    harmless_page(page(document, language, title=HOSTILE[0], earlier=earlier(hostile(tmp_path))))


def test_no_name_becomes_markdown(tmp_path: Path) -> None:
    text = markdown(told(hostile(tmp_path), title=HOSTILE[4]))
    tokens = MarkdownIt("commonmark").enable("table").parse(text)
    inside = [child for token in tokens for child in token.children or ()]
    assert not {token.type for token in [*tokens, *inside]} & {
        "html_inline",
        "html_block",
        "link_open",
        "image",
        "fence",
    }
    headings = [t.content for t, before in zip(tokens[1:], tokens, strict=False) if before.type == "heading_open"]
    assert len([heading for heading in headings if "harmed" in heading]) == 2  # of two ways, where names are code
    tables = [token for token in tokens if token.type == "table_open"]
    assert len(tables) > 5


def test_names_are_shown_whole_enough_and_on_one_line(tmp_path: Path) -> None:
    for text in texts(hostile(tmp_path)):
        assert "\\u202eevil\\u2066x" in text  # controls of the reading direction are spelt out
        assert "\u202e" not in text
        assert HOSTILE[6] in text
        assert max(map(len, re.findall(r"x{9,}", text))) < 200  # 4,000 characters are not repeated


@given(name=st.text(max_size=60))
def test_any_name_leaves_the_page_and_the_text_as_they_are(name: str) -> None:
    def shape(document: dict[str, Any]) -> tuple[Counter[Any], Counter[str]]:
        tokens = MarkdownIt("commonmark").enable("table").parse(markdown(told(document)))
        return Counter(node.tag for node in page(document).iter()), Counter(token.type for token in tokens)

    document = CARE
    named = json.loads(json.dumps(document).replace('"/recorder"', json.dumps(f"/{name}recorder")))
    named["assumptions"]["labels"][0]["file"] = f"{name}x"
    assert shape(named) == shape(document)


CARE = care()


# ---------------------------------------------------------------- the record of processing


def record(document: dict[str, Any], language: str = "en") -> list[dict[str, str]]:
    text = article30.record(document, language)
    assert text.startswith("\ufeff")
    rows = csv.DictReader(io.StringIO(text.removeprefix("\ufeff")), delimiter=article30.SEPARATORS[language])
    short = {Words(language)(f"r.{field}"): field for field in article30.Entry.__dataclass_fields__}
    return [{short[column]: cell for column, cell in row.items()} for row in rows]


def test_one_row_for_each_kind_and_recipient() -> None:
    assert [(row["category"], row["recipient"], row["form"]) for row in record(care())] == [
        ("face template", "/uplink", "as it is"),
        ("location", "no recipient found under the labels given", ""),
        ("person track", "no recipient found under the labels given", ""),
        ("video of persons", "/recorder", "pseudonymised"),
        ("voice", "/uplink", "as it is"),
    ]


def test_what_only_a_person_can_know_is_empty_and_marked() -> None:
    for row in record(care()):
        assert row["controller"] == row["purpose"] == ""
        assert row["complete"].startswith("30(1)(a), 30(1)(b)")
        assert ("30(1)(c)" in row["complete"]) == (row["subjects"] == "")


def test_storages_and_recipients_fill_their_fields() -> None:
    rows = {(row["category"], row["recipient"]): row for row in record(with_outside(care()))}
    speech = rows["voice", "speech service"]
    assert speech["role"] == "processor"
    assert speech["transfer"].startswith("US, adequacy decision for some recipients, standard contractual clauses")
    assert rows["video of persons", "archive"]["retention"] == "archive: video of persons: 30 days; everything: 1 year"
    assert "archive: not encrypted at rest" in rows["video of persons", "archive"]["measures"]


def test_recipients_that_nobody_reviewed_may_be_missing_and_the_row_says_so() -> None:
    (row, *_) = record(run(2))
    assert "there may be more recipients" in row["note"]


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_cell_is_a_formula(tmp_path: Path, language: str) -> None:
    document = hostile(tmp_path)
    for finding, begin in zip(document["findings"], ("=", "+", "-", "@", "\t=", " =", "＝"), strict=False):
        finding["leak"]["name"] = f"{begin}cmd|' /C calc'!A0"
    document["categories"][0]["title"] = "=1+1"
    document["categories"][0]["translations"] = {}
    rows = record(document, language)
    assert rows[0]["category"] == "'=1+1"
    assert len(rows) == len(document["findings"]) + 1  # and the storage
    for row in rows:
        assert not [cell for cell in row.values() if cell.lstrip().startswith(FORMULA)]


# ---------------------------------------------------------------- copies for others


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_redacted_copy_names_nobody(language: str) -> None:
    document = with_decisions(with_outside(care()))
    document["patterns"] = [{"secret": "/uplink"}]  # what is not known here could name anybody
    (copy,) = redacted([document])
    names = {row["element"]["name"] for row in (*document["carries"], *document["outside"])} | {
        "/care_home", "care-home", "residents", "visitors", "Speech Inc.", "care management", "staff has to know",
    }  # fmt: skip
    every = (*texts(copy, language, redacted=True, earlier=earlier(copy)), article30.record(copy, language))
    for text in every:
        assert [name for name in names if name in text] == []
        assert document["findings"][0]["id"] in text
    assert [way.id for way in told(copy).ways] == [way.id for way in told(document).ways]


def test_a_name_is_replaced_by_the_same_one_in_both_documents() -> None:
    old = care()
    old["findings"].pop()
    copies = redacted([care(), old])
    assert copies[0]["findings"][0] == copies[1]["findings"][0]
    differ = changes(copies[1], copies[0])
    assert (len(differ.new), differ.gone, dict(differ.changed)) == (1, (), {})


# ---------------------------------------------------------------- the command


def command(*arguments: str, cwd: Path = ROOT, **environment: str) -> subprocess.CompletedProcess[bytes]:
    inherited = {**os.environ, "SOURCE_DATE_EPOCH": "1790000000", **environment}
    full = [sys.executable, "-m", "rosprivacy", "report", *arguments]
    return subprocess.run(full, cwd=cwd, env=inherited, capture_output=True, check=False)


SYSTEM = ["examples/care-home/care-home.policy.xml", "-l", "examples/care-home/care-home.labels.yaml"]


@pytest.mark.slow
@pytest.mark.parametrize("form", ["html", "markdown", "article30"])
def test_the_bytes_are_the_same_in_every_process(form: str) -> None:
    done = [command(*SYSTEM, "-f", form, "--lang", "de", PYTHONHASHSEED=seed) for seed in ("0", "4711")]
    assert [run.returncode for run in done] == [0, 0]
    assert done[0].stdout == done[1].stdout


def test_the_page_is_dated_as_the_environment_says() -> None:
    assert b"Made on 2026-09-21" in command(*SYSTEM).stdout
    refused = command(*SYSTEM, SOURCE_DATE_EPOCH="yesterday")
    assert (refused.returncode, refused.stderr.count(b"\n")) == (2, 1)


def test_it_is_utf8_whatever_the_terminal_is() -> None:
    done = command(*SYSTEM, "--lang", "de", LC_ALL="C", PYTHONUTF8="0", PYTHONIOENCODING="ascii")
    assert "Wohin personenbezogene Daten gelangen können" in done.stdout.decode("utf-8")


def renamed(document: dict[str, Any], old: str, new: str) -> dict[str, Any]:
    """As after another start; ids are made from names."""
    copied: dict[str, Any] = json.loads(json.dumps(document).replace(f'"{old}"', f'"{new}"'))
    for finding in copied["findings"]:
        if new in (finding["source"]["name"], finding["leak"]["name"]):
            finding["id"] = finding["id"][::-1]
    return copied


def test_names_that_are_made_up_at_each_start_are_no_change() -> None:
    for name in ("/recorder", "/uplink"):  # leaks of ways
        old = renamed(care(), name, f"{name}_5591c2d0")
        new = renamed(care(), name, f"{name}_55a1ff00")
        assert changes(old, new).nothing
        assert not changes(old, new).marks()
        other = changes(old, renamed(care(), name, f"{name}_of_somebody_else"))
        assert other.new
        assert other.gone


def test_what_is_the_same_is_the_same_for_diff() -> None:
    """One implementation of what elements and findings are told apart by."""
    old, new = renamed(care(), "/recorder", "/recorder_10000"), renamed(run(2), "/archive_server", "/other")
    for before, now in ((old, care()), (care(), new), (run(1), run(2)), (run(2), run(1))):
        report, diff = changes(before, now), difference(snapshot(before, None), snapshot(now, None))
        assert len(report.new) == len(diff["findings"]["new"])
        assert len(report.gone) == len(diff["findings"]["gone"])


def test_a_fleet_has_the_same_ways_whichever_robot_is_shown() -> None:
    now = hospital().document()
    text = json.dumps(now).replace("carrier_01", "carrier_00")  # another robot comes first
    before = json.loads(text)
    for finding in before["findings"]:
        if finding["source"]["robot"] == "carrier_00":
            finding["id"] = finding["id"][::-1]
    ids = dict(zip([f["id"] for f in now["findings"]], [f["id"] for f in before["findings"]], strict=True))
    for pattern in before["fleet"]["patterns"]:
        pattern["finding"] = ids[pattern["finding"]]
    differ = changes(before, now)
    assert (differ.new, differ.gone, differ.opened, differ.closed) == ((), (), (), ())
    assert set(differ.changed.values()) == {("robots",)}


def test_it_is_written_to_a_file_and_compares_with_an_earlier_document(tmp_path: Path) -> None:
    old = tmp_path / "old.json"
    old.write_text(json.dumps(run(3)))
    done = command(*SYSTEM, "--since", str(old), "--title", "Care <robot>", "-o", str(tmp_path / "r.html"))
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
    text = (tmp_path / "r.html").read_text("utf-8")
    assert "Care &lt;robot&gt;" in text
    assert "What changed since the earlier report" in text


def test_a_report_that_is_written_is_no_failure_whatever_it_says() -> None:
    assert run(3)["verdict"] == "leak"
    assert command("examples/factory/before.policy.xml", "-l", "examples/factory/run3.labels.yaml").returncode == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], b"name at least one policy"),
        (["--from-database", *SYSTEM], b"takes what is in the database"),
        ([*SYSTEM, "--since", "missing.json"], b"missing.json: is not a file; give what"),
        ([*SYSTEM, "--lang", "xx"], b"xx"),
    ],
)
def test_what_cannot_be_done_is_said(arguments: list[str], message: bytes) -> None:
    done = command(*arguments)
    assert done.returncode == 2
    assert message in done.stderr
    assert b"Traceback" not in done.stderr


def test_a_redacted_copy_is_one_option() -> None:
    done = command(*SYSTEM, "--redact", "-f", "markdown")
    assert b"care" not in done.stdout.replace(b"health or social care", b"")
    assert b"Names of elements, files, enclaves, robots and persons were replaced" in done.stdout
