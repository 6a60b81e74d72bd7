"""The CNIL's PIA tool as tests need it: what it does with a file when it imports, shows, sorts and checks it.

``Tool`` does what the tool's own import and views do, step by step, written anew from a reading of them.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from html.parser import HTMLParser
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.python_311 import from_iso
from rosprivacy.report.catalogs.words import plain

if TYPE_CHECKING:
    from datetime import datetime

CREATED = "2026-01-02T03:04:05.000Z"
TEXT = (111, 112, 113, 121, 122, 123, 211, 212, 213, 214, 215, 221, 222, 223, 224, 225, 226, 227)
LIST = tuple(10 * risk + n for risk in (32, 33, 34) for n in (1, 2, 3, 4))
GAUGE = tuple(10 * risk + n for risk in (32, 33, 34) for n in (5, 6))
ITEMS = {"1.1": TEXT[:3], "1.2": TEXT[3:6], "2.1": TEXT[6:11], "2.2": TEXT[11:], **{
    f"3.{n}": tuple(q for q in (*LIST, *GAUGE) if q // 10 == 30 + n) for n in (2, 3, 4)
}}  # fmt: skip
ON_EVERY_OBJECT = {"constructor", "__proto__", "toString", "valueOf", "hasOwnProperty", "isPrototypeOf"}


@dataclass
class Tool:
    """The tool's database after an import."""

    pia: dict[str, Any] = field(default_factory=dict)
    answers: dict[int, dict[str, Any]] = field(default_factory=dict)
    measures: dict[int, dict[str, Any]] = field(default_factory=dict)
    evaluations: list[dict[str, Any]] = field(default_factory=list)
    comments: list[dict[str, Any]] = field(default_factory=list)

    @classmethod
    def load(cls, text: str) -> Tool:
        """'Import a PIA': JSON.parse, then importData; what would be an exception or a wrong record fails here."""
        data = json.loads(text, parse_constant=lambda name: pytest.fail(f"no JSON: {name}"))
        tool = cls()
        assert data["pia"], "wrong pia file"
        given_pia = data["pia"]
        assert not given_pia.get("user_pias")  # names of users of another server
        tool.pia = {
            key: given_pia[key]
            for key in (
                "category", "dpo_status", "dpo_opinion", "concerned_people_opinion", "concerned_people_status",
                "concerned_people_searched_opinion", "concerned_people_searched_content", "rejection_reason",
                "applied_adjustments", "dpos_names", "people_names", "author_name", "evaluator_name", "validator_name",
            )
        }  # fmt: skip
        tool.pia["name"] = "(IMPORT) " + given_pia["name"]
        assert not given_pia["structure_id"]
        tool.pia["status"] = int(given_pia["status"])
        tool.pia["created_at"], tool.pia["updated_at"] = date(given_pia["created_at"]), date(given_pia["updated_at"])
        tool.import_answers(data["answers"])
        tool.import_measures(data)
        for comment in data["comments"]:
            date(comment["created_at"])
            assert comment["for_measure"] is False  # the tool would look for it under the new id of a measure
            assert isinstance(comment["reference_to"], int)  # looked up by (pia, number of the question)
        tool.comments = data["comments"]
        return tool

    def import_answers(self, answers: list[Any]) -> None:
        assert isinstance(answers, list)  # answers.forEach
        for answer in answers:
            assert isinstance(answer["reference_to"], int)  # looked up by (pia, number)
            assert answer["reference_to"] not in self.answers  # the first one only would be shown
            date(answer["created_at"])
            self.answers[answer["reference_to"]] = answer["data"]

    def import_measures(self, data: dict[str, Any]) -> None:
        assert isinstance(data["measures"], list)  # measures.length, measures.forEach
        for number, measure in enumerate(data["measures"], 1):
            date(measure["created_at"])
            assert isinstance(measure["id"], int)
            self.measures[1000 + number] = {key: measure[key] for key in ("title", "content", "placeholder")}
        assert data["evaluations"] == []  # even a pending one closes the answers

    def valid(self, question: int) -> bool:
        """answerIsValid."""
        data = self.answers[question]
        if question in GAUGE:
            return bool(data["text"]) and data["gauge"] > 0
        return bool(data["list"] if question in LIST else data["text"])

    def status(self, item: str) -> int:
        """Verification without evaluations: 0 nothing, 1 begun, 2 ready to be evaluated."""
        if item == "3.1":
            full = [m for m in self.measures.values() if m["title"] and m["content"]]
            return (2 if len(full) == len(self.measures) else 1) if full else 0
        answered = [question for question in ITEMS[item] if question in self.answers]
        if answered and sum(map(self.valid, answered)) == len(ITEMS[item]):
            return 2
        return 1 if answered else 0

    def shown_as_html(self) -> list[str]:
        """All that the tool puts into a page as HTML, unsanitised where it says so itself."""
        texts = [data["text"] for data in self.answers.values() if data["text"]]
        texts += [item for data in self.answers.values() for item in data["list"]]
        return texts + [measure[key] for measure in self.measures.values() for key in ("title", "content")]


def date(text: str) -> datetime:
    """``new Date(text)`` that is none of the invalid ones."""
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z", text)
    return from_iso(text)


class Page(HTMLParser):
    """What a browser makes of a text: tags, attributes, and the text that is seen."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.open: list[str] = []
        self.seen = ""
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[Any]) -> None:
        assert not attrs
        self.tags.append(tag)
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.seen += data


def imported(data: dict[str, Any]) -> Tool:
    """A file that the tool takes, and that harms nobody who looks at it."""
    tool = Tool.load(json.dumps(data, ensure_ascii=False, allow_nan=False).encode().decode())
    for text in tool.shown_as_html():
        page = Page(text)
        assert set(page.tags) <= {"p", "ul", "li", "strong", "em"}
        assert plain(page.seen).isprintable()
    for question in LIST:
        for item in tool.answers.get(question, {"list": []})["list"]:
            assert item
            assert Page(item).seen == item  # the same as text and as HTML
            assert item not in ON_EVERY_OBJECT  # used as a key of an object
    titles = [measure["title"] for measure in tool.measures.values()]
    assert len(set(titles)) == len(titles)
    assert all(0 < len(title) <= 120 and Page(title).seen == title for title in titles)
    assert tool.answers.get(324, {"list": []})["list"] == titles  # chosen from the measures, by title
    assert all(isinstance(tool.pia[f"{who}_name"], str) for who in ("author", "evaluator", "validator"))  # sorted by
    return tool


def seen(tool: Tool, question: int) -> str:
    return Page(tool.answers[question]["text"]).seen
