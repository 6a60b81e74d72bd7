"""The pages of scripted sessions are what they were, byte for byte: each is a hash in ``golden_pages.tsv``.

``python -m tests.explorer.web.test_golden_pages`` writes the hashes anew; with a folder, the pages themselves go there
too, to compare those of two commits with ``diff -r``. Places in pictures are left out: fonts decide them.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any
from urllib.parse import urlencode

import pytest
from lxml import html

from rosprivacy.analysis.python_311 import chdir
from tests.helpers.explorers import Explorer, begin_stored
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


HASHES = Path(__file__).with_name("golden_pages.tsv")
DATE = "1780000000"  # of decisions
POSTED = "/undo", "/redo", "/save", "/merge", "/resume", "/forget"
SIGNED = {"reason": "within the building", "owner": "A. Lee", "expires": "2999-12-31", "legal_basis": "6(1)(f)"}


class Visitor:
    """A browser that keeps each page that it is shown, under what it asked."""

    def __init__(self, explorer: Explorer, story: str) -> None:
        self.explorer, self.client, self.story = explorer, explorer.client(), story
        self.pages: list[tuple[str, str]] = []

    def get(self, address: str) -> html.HtmlElement:
        answer = self.client.get(address)
        self.pages.append((f"{self.story} GET {address}", f"{answer.status_code}\n{answer.text}"))
        return html.fromstring(answer.text)

    def post(self, address: str, **fields: Any) -> str:
        """Post a form as the page of now does; return where the window goes on."""
        data = {"version": str(self.explorer.session.version), **fields}
        answer = self.client.post(address, data=data)
        to = answer.headers.get("location", "")
        asked = f"{self.story} POST {address} {urlencode(data, doseq=True)}"
        self.pages.append((asked, f"{answer.status_code} {to}\n{answer.text}"))
        return to

    def submit(self, form: Any, **fields: Any) -> str:
        values: dict[str, list[str]] = {}
        for name, value in form.form_values():
            values.setdefault(name, []).append(value)
        return self.post(form.get("action"), **{**values, **fields})

    def elements(self, step: int = 1) -> list[str]:
        return list(self.explorer.site.standing.elements)[::step]

    def at(self, name: str) -> str:
        """The id of the element of a name."""
        there = self.explorer.site.standing.elements.items()
        return next(at for at, element in there if element.full_name == name)

    def try_all(self, address: str, most: int = 6) -> None:
        """Try what a page offers, look at each trial, and drop it."""
        forms = [form for form in self.get(address).forms if str(form.get("action")).startswith("/try")]
        for number, form in enumerate(forms[:most]):
            to = self.submit(form, name=f"trial {number}")
            if to:
                there = self.get(to)
                for link in there.xpath("//*[@id='hand']//a/@href")[:2]:
                    self.get(link)
        self.get("/")
        for number in range(len(forms[:most]) - 1):
            self.post("/try", what="together", first=f"trial {number}", second=f"trial {number + 1}")
        for name in self.explorer.session.scenarios:
            self.post("/drop", name=name)


def labelling(visitor: Visitor) -> None:
    """Label the care home, with what is wrong, undone, saved, changed by somebody else, and left."""
    for address in ("/", "/?draw=all", "/?find=cam", "/?find=zzz", "/?hide=Video", "/now", "/static/picture.css"):
        visitor.get(address)
    camera = visitor.at("/camera")
    visitor.post("/label", element=camera, role="source", brings="Video", note="it films", by="A. Lee")
    for address in ("/", "/?hide=Video", "/?draw=all&hide=Voice", "/?finding=0123456789abcdef&closes=1&trial=none"):
        visitor.get(address)
    for offer in visitor.get("/").xpath("//form[@class='offer']")[:1]:
        visitor.submit(offer)
    for at in visitor.elements(4):
        visitor.get(f"/?at={at}")
    for role in ("leak", "sanitizer", "mundane", "absent", "derives"):
        visitor.post("/label", element=visitor.elements()[0], role=role)
    for role, more in (
        ("leak", {"about": "Video"}),
        ("sanitizer", {"about": "Video", "method": "pseudonymise"}),
        ("derives", {"about": "Video", "makes": "FaceTemplate"}),
        ("conduit", {"about": "*"}),
        ("absent", {"reason": "only in tests"}),
        ("nothing", {}),
    ):
        visitor.post("/label", element=visitor.elements()[1], role=role, **more)
        visitor.get("/")
    for path in ("/undo", "/undo", "/redo", "/save", "/save"):
        visitor.post(path)
        visitor.get("/")
    visitor.post("/label", element=camera, role="source", brings="Voice")
    labels = visitor.explorer.labels
    labels.write_text(labels.read_text("utf-8") + "# by hand <b>\n", "utf-8")
    for path in ("/save", "/merge", "/save", *POSTED):
        visitor.get("/")
        visitor.get("/now")
        visitor.post(path)
    for path in ("/label", *POSTED, "/try", "/drop", "/decide"):
        visitor.post(path, version="0")
        visitor.post(path, version="x")
    visitor.post("/label", element="e0", role="leak")
    visitor.post("/label", element=camera, role="leak", about="Nothing")
    visitor.post("/label", element=camera, role="leak", note="\x00")


def deciding(visitor: Visitor, step: int = 8, of: int = 2) -> None:
    """Look at findings, ask what closes them, try that and more, and decide."""
    visitor.get("/")
    for finding in list(visitor.explorer.site.standing.findings)[:of]:
        visitor.get(f"/?finding={finding}")
        visitor.try_all(f"/?finding={finding}&closes=1")
        for form in visitor.get(f"/?finding={finding}").xpath("//form[@id='decide']"):
            visitor.submit(form, choice="accept")
            visitor.submit(form, choice="accept", **SIGNED)
            visitor.get(f"/?finding={finding}")
    for at in visitor.elements(step):
        visitor.get(f"/?at={at}")
        visitor.try_all(f"/?at={at}", 3)
    for what in ("filter", "cut", "storage", "doubt", "proposal", "together", "nothing"):
        visitor.post("/try", what=what)
        visitor.post("/try", what=what, element=visitor.elements()[0], data="*", days="x", country="xx")
    visitor.get("/")


def fleet(visitor: Visitor) -> None:
    """Label models and robots of a fleet, and decide about some of them."""
    deciding(visitor, 60, 1)
    blur = visitor.at("carrier_01:/blur")
    for whose in ("model", "robot"):
        visitor.post("/label", element=blur, role="leak", about="Video", whose=whose)
        visitor.get("/")
        visitor.get(f"/?at={blur}")
    for path in POSTED:
        visitor.post(path)
    visitor.get("/")
    finding = next(iter(visitor.explorer.site.standing.findings))
    for form in visitor.get(f"/?finding={finding}").xpath("//form[@id='decide']"):
        visitor.submit(form, choice="avoid", reason="later")
    visitor.get(f"/?finding={finding}")


def reviewing(visitor: Visitor, questions: int = 14) -> None:
    """Answer one question after the other, in all ways, and end with the summary."""
    for address in ("/", "/?step=summary", "/?step=source", "/?step=source&find=cam", "/?at=e0"):
        visitor.get(address)
    extra = {"method": "drop", "makes": "FaceTemplate", "note": "we looked", "by": "A. Lee"}
    for number in range(questions):
        forms = visitor.get("/").xpath("//form[starts-with(@action, '/label')]")
        if not forms:
            break
        roles = forms[0].xpath(".//input[@name='role']/@value")
        visitor.submit(forms[0], role=roles[number % len(roles)])
        visitor.submit(forms[0], role=roles[number % len(roles)], **extra)
        if number % 5 == 1:
            visitor.post("/undo")
    for address in ("/", "/?step=summary", "/?step=source"):
        visitor.get(address)
    visitor.post("/save?step=summary")
    visitor.get("/?step=summary")
    for at in visitor.elements(30):
        visitor.get(f"/?at={at}")


def screens(visitor: Visitor, more: int = 25) -> None:
    """Go through what is suggested, one element a screen, back, and to the end."""
    keys = ("take", "back", "undo", "take", "no", "undo", "no", *["take"] * more, "undo", "x")
    said = [{"tick": "1"}, {"tick": "99"}, {"key": "take", "by": ""}, *({"key": key, "by": "A. Lee"} for key in keys)]
    for fields in said:
        (form,) = visitor.get("/?ask=1").xpath("//form[@class='screen']")
        visitor.submit(form, **fields)
    visitor.post("/label", element=visitor.elements()[0], role="leak", about="Video")
    visitor.get("/?ask=1")


def stored(visitor: Visitor) -> None:
    """Look at what is in a database, and ask a server that is gone."""
    visitor.get("/")
    for at in visitor.elements(12):
        visitor.get(f"/?at={at}")
    for finding in visitor.explorer.site.standing.findings:
        visitor.get(f"/?finding={finding}")
        visitor.get(f"/cypher?ask=leak-path-graph&finding={finding}")
    visitor.get(f"/cypher?ask=sources-of-element&at={visitor.elements()[0]}")
    visitor.get("/cypher?ask=nothing&at=e0")
    visitor.get("/cypher")
    visitor.post("/cypher", text="MATCH (n) RETURN n", at=visitor.elements()[0])
    visitor.post("/cypher", ask="nothing")
    visitor.post("/cypher", text="")
    visitor.post("/cypher", text="x" * 20_001)
    for do in ("ask", "edit"):
        visitor.post("/cypher", ask="sources-of-element", do=do, **{"p-element": "/camera"})


CARE, FACTORY = "care-home.policy.xml", "before.policy.xml"
STORIES: dict[str, tuple[Callable[[Visitor], None], str, str, dict[str, Any]]] = {
    "labelling": (labelling, CARE, "new.labels.yaml", {}),
    "deciding": (deciding, FACTORY, "run2.labels.yaml", {"language": "de", "decisions": Path("d.yaml")}),
    "care": (deciding, CARE, "care-home.labels.yaml", {}),
    "fleet": (fleet, "fleet.yaml", "fleet.yaml", {"fleet": True, "language": "fr", "decisions": Path("d.yaml")}),
    "review": (reviewing, CARE, "new.labels.yaml", {"review": True}),
    "review-fleet": (reviewing, "fleet.yaml", "fleet.yaml", {"fleet": True, "review": True, "language": "de"}),
    "read-only": (deciding, FACTORY, "run1.labels.yaml", {"read_only": True}),
    "screens": (screens, CARE, "new.labels.yaml", {"language": "de"}),
    "stored": (stored, FACTORY, "run2.labels.yaml", {"stored": True}),
}
OF_STORY = {CARE: "care-home", FACTORY: "factory", "fleet.yaml": "fleet"}


def pages(story: str) -> list[tuple[str, str]]:
    """What a story shows: what was asked, and what was answered; in a folder with a copy of the example."""
    told, policy, labels, how = STORIES[story]
    with TemporaryDirectory() as folder, chdir(folder):
        for file in (ROOT / "examples" / OF_STORY[policy]).iterdir():
            if file.is_file():
                shutil.copy(file, file.name)
        if story == "review-fleet":  # nobody has spoken of the carriers yet
            for name in ("carrier", "carrier_lent"):
                file = Path(f"{name}.labels.yaml")
                file.write_text(f"{file.read_text('utf-8').partition('nodes:')[0]}nodes: {{}}\n", "utf-8")
        open_explorer = begin_stored if how.get("stored") else Explorer
        explorer = open_explorer(Path(policy), Path(labels), **{key: how[key] for key in how if key != "stored"})
        with contextlib.closing(explorer.site):
            visitor = Visitor(explorer, story)
            told(visitor)
            return visitor.pages


def lines(story: str, keep: Path | None = None) -> Iterator[str]:
    """Yield ``hash, what was asked`` for the pages of a story."""
    for number, (asked, answered) in enumerate(pages(story)):
        if keep:
            (keep / f"{story}-{number:03}").write_text(f"{asked}\n{answered}", "utf-8")
        bare = re.sub("<svg.*?</svg>", lambda svg: re.sub(r"-?\d+(\.\d+)?", "0", svg[0]), answered, flags=re.DOTALL)
        yield f"{hashlib.sha256(bare.encode()).hexdigest()[:12]}\t{asked[:160]}"


@pytest.mark.slow
@pytest.mark.parametrize("story", STORIES)
def test_pages_are_what_they_were(story: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", DATE)
    known = [line for line in HASHES.read_text("utf-8").splitlines() if line.partition("\t")[2].startswith(f"{story} ")]
    assert list(lines(story)) == known


if __name__ == "__main__":
    os.environ["SOURCE_DATE_EPOCH"] = DATE
    kept = Path(sys.argv[1]).resolve() if sys.argv[1:] else None
    if kept:
        kept.mkdir(parents=True, exist_ok=True)
    HASHES.write_text("".join(f"{line}\n" for story in STORIES for line in lines(story, kept)), "utf-8")
