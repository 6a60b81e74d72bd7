"""The report as a page: links, headings, names that mean harm, copies for others."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections import Counter
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markdown_it import MarkdownIt

from rosprivacy.report.compare.changes import changes
from rosprivacy.report.page import article30
from rosprivacy.report.page.markdown import markdown
from rosprivacy.report.page.notice import notice
from rosprivacy.report.redact import redacted
from tests.helpers.reports import HOSTILE, care, fleet, hostile, run, with_decisions, with_outside

if TYPE_CHECKING:
    from pathlib import Path
from tests.helpers.pages import LANGUAGES, earlier, page, texts, told


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
    naming = [node.get(what, "") for node in root.iter() for what in ("aria-labelledby", "for", "data-of")]
    assert {id_ for ids_named in naming for id_ in ids_named.split()} <= set(ids)


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


def harmless_page(root: Any) -> None:
    assert {node.tag for node in root.iter() if isinstance(node.tag, str)} <= {
        "html", "head", "body", "meta", "link", "title", "style", "script", "a", "div", "header", "p", "h1", "h2", "h3",
        "h4", "nav", "ol", "ul", "li", "main", "section", "article", "footer", "span", "bdi", "dl", "dt", "dd", "table",
        "caption", "thead", "tbody", "tr", "th", "td", "form", "fieldset", "legend", "label", "input", "select",
        "option", "button", "details", "summary", "textarea", "noscript", "figure", "img", "br", "b", "code", "dfn",
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
    # the rows to decide and the paths of two flows, where names are code
    assert len([heading for heading in headings if "harmed" in heading]) == 4
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
    for text in (notice(copy, language), article30.record_of_processors(copy, language)):
        assert [name for name in names if name in text] == []
    assert [entry.id for entry in told(copy).entries] == [entry.id for entry in told(document).entries]


def test_a_name_is_replaced_by_the_same_one_in_both_documents() -> None:
    old = care()
    old["findings"].pop()
    copies = redacted([care(), old])
    assert copies[0]["findings"][0] == copies[1]["findings"][0]
    differ = changes(copies[1], copies[0])
    assert (len(differ.new), differ.removed, dict(differ.changed)) == (1, (), {})
