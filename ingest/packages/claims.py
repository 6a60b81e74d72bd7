"""What a package says of a node: the list ``says`` of a file -> claims, one for each kind.

In: values of the file. Out: ``Claim``, or the problems of the file with their lines. A package says ``likely`` of what
its node does, and ``may`` of what depends on a setting or on what comes in; it cannot be certain of somebody's node.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Confidence, Method, Place
from rosprivacy.analysis.suggesting.evidence import CONDUIT, DERIVATION, LEAK, SANITIZER, SOURCE
from rosprivacy.analysis.suggesting.ros_package import WHERE, Claim
from rosprivacy.ingest.reading.format_reader import FileReader

if TYPE_CHECKING:
    import re
    from collections.abc import Iterator

    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

ROLES = {"source": SOURCE, "leak": LEAK, "derives": DERIVATION, "sanitizer": SANITIZER, "conduit": CONDUIT}
KEYS = (*ROLES, "to", "confidence", "why")
SAID = (Confidence.LIKELY, Confidence.MAY)
METHODS = tuple(method for method in Method if method is not Method.ABSENT)
LONGEST = 500  # characters of a text


@dataclass(kw_only=True, eq=False, repr=False)
class ClaimReader(FileReader):
    """Reads what a package says of its nodes.

    Attributes
    ----------
    vocabulary
        The kinds that there are, a user's own too.
    """

    vocabulary: Vocabulary

    def claims(self, value: Value) -> Iterator[Claim]:
        """Return what stands under ``says``."""
        for item in self.filled(value, "says", "write what the node does with data, or leave it out"):
            said = {key: one for key, _, one in self.entries_of(item, KEYS)}
            roles = [key for key in ROLES if key in said]
            if len(roles) != 1 or "why" not in said:
                self.problem(
                    item.line,
                    "a statement that is not of one role, with its reason",
                    f"write one of {', '.join(ROLES)}, and why: …",
                )
                continue
            if ("to" in said) != (roles == ["leak"]):
                self.problem(item.line, "to belongs to a leak", f"say of each leak where it goes: {', '.join(WHERE)}")
                continue
            basis = Claim(
                ROLES[roles[0]],
                "",
                Confidence(self.one_of(said["confidence"], "confidence", SAID)) if "confidence" in said else SAID[0],
                self.text(said["why"], "why"),
                Place(self.file, item.line),
                where=self.one_of(said["to"], "to", WHERE) if "to" in said else "",
            )
            yield from self._of_role(basis, said[roles[0]])

    def _of_role(self, basis: Claim, value: Value) -> Iterator[Claim]:
        if basis.role == DERIVATION:
            yield from self._derivations(basis, value)
        elif basis.role == SANITIZER:
            yield from self._sanitizers(basis, value)
        elif basis.role == CONDUIT and (value.kind, value.text) == ("text", "all"):
            yield basis
        else:
            for item in self.filled(value, basis.role, "write […]"):
                yield basis._replace(kind=self._kind(item))

    def _derivations(self, basis: Claim, value: Value) -> Iterator[Claim]:
        for item in self.filled(value, "derives", "write [{from: Video, to: FaceTemplate}]"):
            said = {key: one for key, _, one in self.entries_of(item, ("from", "to"))}
            if len(said) != 2:  # noqa: PLR2004 - from and to
                self.problem(item.line, "a derivation without from or to", "write {from: Video, to: FaceTemplate}")
            else:
                yield basis._replace(kind=self._kind(said["from"]), to=self._kind(said["to"]))

    def _sanitizers(self, basis: Claim, value: Value) -> Iterator[Claim]:
        if value.kind != "map" or not value.entries:
            self.problem(value.line, "a sanitizer states its method", "write {Video: anonymise}")
        for name, line, method in value.entries:
            kind = self._kind(method._replace(line=line, kind="text", text=name))
            yield basis._replace(kind=kind, method=Method(self.one_of(method, "a sanitizer's method", METHODS)))

    def _kind(self, value: Value) -> str:
        category = self.vocabulary.find(value.text) if value.kind == "text" else None
        if category is None:
            problem = f"unknown category {shown(value.text or value.kind)!r}"
            self.problem(value.line, problem, self.vocabulary.hint(value.text))
            return ""
        return category.name

    def filled(self, value: Value, what: str, hint: str) -> tuple[Value, ...]:
        """Return the items of a list that is not empty."""
        items = self.list_of(value, what, hint)
        if value.kind in ("list", "empty") and not items:
            self.problem(value.line, f"{what} is empty", hint)
        return items

    def text(self, value: Value, what: str) -> str:
        """Return a text of bounded length, on one line."""
        text = value.text.strip()
        if value.kind not in ("text", "number") or not text or len(text) > LONGEST or not text.isprintable():
            found = shown(text[:40]) or value.kind
            self.problem(
                value.line, f"{what} takes one line of at most {LONGEST} characters, not {found!r}", "correct it"
            )
            return ""
        return text

    def plain(self, value: Value, what: str, form: re.Pattern[str], hint: str = "write a plain name") -> str:
        """Return a text of a form."""
        text = self.text(value, what)
        if text and not form.fullmatch(text):
            self.problem(value.line, f"{what} cannot be {shown(text[:40])!r}", hint)
        return text

    def one_of(self, value: Value, what: str, words: tuple[str, ...]) -> str:
        """Return one word of a list; the last where another one stands."""
        if value.kind != "text" or value.text not in words:
            self.problem(value.line, f"{what} {shown(value.text or value.kind)!r}", f"write {' or '.join(words)}")
            return words[-1]
        return value.text
