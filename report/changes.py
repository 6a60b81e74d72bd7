"""What changed between two JSON documents: verdict, ways, open elements, kinds of data, and how they were made.

In: the earlier document and the new one. Out: ``Changes``. A way that is gone because less was asked is no answer, so
everything that was asked or assumed otherwise is named first.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.report.naming import key, printable

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.naming import Key

ASKED = (
    "view", "categories_asked", "data_types_asked", "article9_only", "standard_channels", "ontologies", "law_as_of",
    "rosprivacy",
)  # fmt: skip
READ = ("policies", "labels")
COMPARED = ("pseudonymised", "dismissed", "accepted", "disjoint_paths", "article9", "reason")


@dataclass(frozen=True, slots=True)
class Changes:
    """The difference.

    Attributes
    ----------
    scope
        (what was asked or assumed, before, now), where that differs.
    files
        Policies and label files that were added, removed or changed.
    new
        Ids of findings that were not there.
    gone
        Findings that are no longer there, as they were.
    changed
        Id -> what about it changed: keys of the contract.
    opened, closed
        Elements that are newly open, or no longer.
    kinds_new, kinds_gone
        Categories.
    """

    before: str
    now: str
    scope: tuple[tuple[str, str, str], ...]
    files: tuple[str, ...]
    new: tuple[str, ...]
    gone: tuple[Mapping[str, Any], ...]
    changed: Mapping[str, tuple[str, ...]]
    opened: tuple[Mapping[str, Any], ...]
    closed: tuple[Mapping[str, Any], ...]
    kinds_new: tuple[str, ...]
    kinds_gone: tuple[str, ...]

    @property
    def nothing(self) -> bool:
        """Whether what was found is the same."""
        found = (self.new, self.gone, self.changed, self.opened, self.closed, self.kinds_new, self.kinds_gone)
        return self.before == self.now and not any(found)

    def marks(self) -> dict[str, str]:
        """Id of a finding -> ``new`` or ``changed``."""
        return {**dict.fromkeys(self.new, "new"), **dict.fromkeys(self.changed, "changed")}


def changes(before: Mapping[str, Any], now: Mapping[str, Any]) -> Changes:
    """Compare two documents. Complexity: O(size of both)."""
    old = {finding["id"]: finding for finding in before["findings"]}
    new = {finding["id"]: finding for finding in now["findings"]}
    differ = {finding: tuple(_different(old[finding], new[finding])) for finding in new if finding in old}
    were, are = _open(before), _open(now)
    kinds = [[category["name"] for category in document["categories"]] for document in (before, now)]
    return Changes(
        before=before["verdict"],
        now=now["verdict"],
        scope=tuple(_scope(before["assumptions"], now["assumptions"])),
        files=tuple(_files(before["assumptions"], now["assumptions"])),
        new=tuple(finding for finding in new if finding not in old),
        gone=tuple(finding for key, finding in old.items() if key not in new),
        changed={finding: what for finding, what in differ.items() if what},
        opened=tuple(element for at, element in are.items() if at not in were),
        closed=tuple(element for at, element in were.items() if at not in are),
        kinds_new=tuple(name for name in kinds[1] if name not in kinds[0]),
        kinds_gone=tuple(name for name in kinds[0] if name not in kinds[1]),
    )


def _different(old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[str]:
    """What differs for a reader; lines that moved in a file are no change."""
    if list(map(key, old["witness"])) != list(map(key, new["witness"])):
        yield "witness"
    yield from (what for what in COMPARED if (old.get(what) or False) != (new.get(what) or False))
    if [law["provision"] for law in old.get("law", ())] != [law["provision"] for law in new.get("law", ())]:
        yield "law"
    if _at(old.get("special_from")) != _at(new.get("special_from")):
        yield "special_from"


def _at(element: Mapping[str, Any] | None) -> Key | None:
    return key(element) if element else None


def _open(document: Mapping[str, Any]) -> dict[Key, Mapping[str, Any]]:
    return {key(question["element"]): question["element"] for question in document["open"]}


def _scope(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    for what in ASKED:
        old, new = before.get(what), now.get(what)
        if _compared(old) != _compared(new):
            yield what, _shown(old), _shown(new)


def _compared(value: Any) -> Any:
    """A value without what follows from the system: how many channels a file took as mundane."""
    return {k: v for k, v in value.items() if k != "taken"} if isinstance(value, dict) else value


def _shown(value: Any) -> str:
    if isinstance(value, dict):
        value = value.get("file", "")
    if isinstance(value, list):
        parts = [str(part.get("file", part)) if isinstance(part, dict) else str(part) for part in value]
        return printable(", ".join(parts))
    return printable(value if isinstance(value, str) else json.dumps(value))


def _files(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    for kind in READ:
        old, new = ({entry["file"]: entry["sha256"] for entry in said.get(kind, ())} for said in (before, now))
        yield from sorted(name for name in {*old, *new} if old.get(name) != new.get(name))
