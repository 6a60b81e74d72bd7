"""What changed between two JSON documents: verdict, paths, open elements, kinds of data, and how they were made.

In: the earlier document and the new one. Out: ``Changes``. A path that is gone because less was asked is no answer, so
everything that was asked or assumed otherwise is named first. This is for a person who assessed the earlier report;
``difference.py`` is for CI, has grants and labels too, and says what is worse. What is the same in both is told apart
alike, by ``matching.py``.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.text import printable
from rosprivacy.report.compare.matching import Identity, comparable, paired

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.compare.matching import Key

QUESTION_KEYS = (
    "view", "categories_asked", "data_types_asked", "identity_factors_asked", "article9_only", "article9_level",
    "standard_channels", "type_limits", "ontologies", "law_as_of", "rosprivacy",
)  # fmt: skip
READ = ("fleet", "policies", "labels")
COMPARED = ("pseudonymised", "dismissed", "accepted", "disjoint_paths", "article9")


class Changes(NamedTuple):
    """The difference.

    Attributes
    ----------
    scope
        (what was asked or assumed, before, now), where that differs.
    files
        Policies and label files that were added, removed or changed.
    new
        Ids of findings that were not there.
    removed
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
    removed: tuple[Mapping[str, Any], ...]
    changed: Mapping[str, tuple[str, ...]]
    opened: tuple[Mapping[str, Any], ...]
    closed: tuple[Mapping[str, Any], ...]
    kinds_new: tuple[str, ...]
    kinds_gone: tuple[str, ...]

    @property
    def nothing(self) -> bool:
        """Whether what was found is the same."""
        found = (self.new, self.removed, self.changed, self.opened, self.closed, self.kinds_new, self.kinds_gone)
        return self.before == self.now and not any(found)

    def marks(self) -> dict[str, str]:
        """Id of a finding -> ``new`` or ``changed``."""
        return {**dict.fromkeys(self.new, "new"), **dict.fromkeys(self.changed, "changed")}


def changes(before: Mapping[str, Any], now: Mapping[str, Any]) -> Changes:
    """Compare two documents. Complexity: O(size of both)."""
    were, are = Identity.of(before), Identity.of(now)
    old, new = _findings(before, were), _findings(now, are)
    pairs = paired(old, new)
    differ = {new[b]["id"]: tuple(_different(old[a], new[b], were, are)) for a, b in pairs.common}
    appeared = {new[key]["id"] for key in pairs.new}
    vanished = {old[key]["id"] for key in pairs.removed}
    left, arrived = _open(before, were), _open(now, are)
    elements = paired(left, arrived)
    opened, closed = set(elements.new), set(elements.removed)
    kinds = [[category["name"] for category in document["categories"]] for document in (before, now)]
    return Changes(
        before=before["verdict"],
        now=now["verdict"],
        scope=tuple(scope(before["assumptions"], now["assumptions"])),
        files=tuple(_files(before["assumptions"], now["assumptions"])),
        new=tuple(finding["id"] for finding in now["findings"] if finding["id"] in appeared),
        removed=tuple(finding for finding in before["findings"] if finding["id"] in vanished),
        changed={f["id"]: differ[f["id"]] for f in now["findings"] if differ.get(f["id"])},
        opened=tuple(element for at, element in arrived.items() if at in opened),
        closed=tuple(element for at, element in left.items() if at in closed),
        kinds_new=tuple(name for name in kinds[1] if name not in kinds[0]),
        kinds_gone=tuple(name for name in kinds[0] if name not in kinds[1]),
    )


def _findings(document: Mapping[str, Any], identity: Identity) -> dict[Key, Mapping[str, Any]]:
    found: dict[Key, Mapping[str, Any]] = {}
    for finding in document["findings"]:
        at = identity.finding(finding)
        found[(*at, finding["id"]) if at in found else at] = finding
    return found


def _different(old: Mapping[str, Any], new: Mapping[str, Any], were: Identity, are: Identity) -> Iterator[str]:
    """What differs for a reader; lines that moved in a file are no change, nor are names that are made up."""
    if comparable(list(map(were.element, old["witness"]))) != comparable(list(map(are.element, new["witness"]))):
        yield "witness"
    told = [what for what in COMPARED if what != "disjoint_paths" or (old.get(what) and new.get(what))]
    yield from (what for what in told if (old.get(what) or False) != (new.get(what) or False))
    if _reason(old) != _reason(new):
        yield "reason"
    if _robots(old, were) != _robots(new, are):
        yield "robots"
    if [law["provision"] for law in old.get("law", ())] != [law["provision"] for law in new.get("law", ())]:
        yield "law"
    if _at(old.get("special_from"), were) != _at(new.get("special_from"), are):
        yield "special_from"


def _reason(finding: Mapping[str, Any]) -> str:
    """Why it is one, without a line by which it is so."""
    because = finding.get("because")
    return str(because["key"] if because and "line" in because["values"] else finding.get("reason", ""))


def _robots(finding: Mapping[str, Any], identity: Identity) -> Any:
    return identity.patterns.get(finding["id"], {}).get("robots")


def _at(element: Mapping[str, Any] | None, identity: Identity) -> Any:
    return comparable(identity.element(element)) if element else None


def _open(document: Mapping[str, Any], identity: Identity) -> dict[Key, Mapping[str, Any]]:
    return {identity.element(question["element"]): question["element"] for question in document["open"]}


def scope(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """Yield what was asked or assumed otherwise, before and now: what is gone may only not have been asked for."""
    for what in (what for what in QUESTION_KEYS if what in before and what in now):
        old, new = before[what], now[what]
        if _compared(old) != _compared(new):
            yield what, _shown(old), _shown(new)


def _compared(value: Any) -> Any:
    """A value without what follows from the system: how many channels or flows a file closed."""
    return {k: v for k, v in value.items() if k not in ("taken", "flows")} if isinstance(value, dict) else value


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
