"""Grants set to DENY, as a patch of the policy files: a unified diff that is read anew before it is given out.

In: policies and grants. Out: ``Patch``. Files are cut at the places that expat names; what comes out is written to a
folder of its own and read like any policy: only if it grants exactly what it should is it a patch.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections import Counter
from dataclasses import dataclass, field
from difflib import unified_diff
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING
from xml.parsers import expat

from rosprivacy.analysis.errors import InputErrors, shown
from rosprivacy.analysis.files_read import one_run
from rosprivacy.ingest.policies.policy_xml import ROLES, read_policy
from rosprivacy.ingest.reading.bounded_file import contents

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.model import Grant, Policy

GROUPS = {kind: group for group, (kind, _) in ROLES.items()}
TEMPORARY = "rosprivacy-patch-"  # beginning of the folder in which a changed policy is read
Key = tuple[bool, str, str, str, str, str, bool]


@dataclass(frozen=True, slots=True)
class Patch:
    """Changes of policy files.

    Attributes
    ----------
    diff
        Unified; empty if there is nothing to change or no patch could be made.
    why_not
        Why no patch could be made.
    """

    diff: str = ""
    why_not: str = ""


@dataclass(slots=True)
class _Span:
    """An element of a file: where it begins and ends, in bytes."""

    tag: str
    attributes: Mapping[str, str]
    line: int
    start: int
    parent: _Span | None
    end: int = 0
    close: int = 0  # where the end tag begins
    empty: bool = False  # <a/>
    names: int = 0  # of a group


@dataclass(slots=True)
class _Text:
    """A file as it is being changed."""

    name: str
    data: bytes
    spans: list[_Span] = field(default_factory=list)


def patch(policies: Iterable[Policy], grants: Collection[Grant]) -> Patch:
    """Return the patch that sets some grants to DENY in the files that they were read from.

    A line is moved into a group that denies; where that cannot be (its group allows other roles too, or the line
    stands in a file that others include), a group that denies is added to the profile and wins (rule S5). It would not
    where sros2 does not read the profile: there a line is moved or not changed.
    """
    diffs: dict[str, str] = {}
    for policy in policies:
        mine = [grant for grant in policy.grants if grant in set(grants)]
        if not mine:
            continue
        if policy.saved:
            return Patch(why_not=f"{shown(policy.file)}: read from a saved graph; name the policies for a patch")
        try:
            changed = _changed(policy, mine)
            if changed is None:
                return Patch(why_not=f"{shown(policy.file)}: no small change of the file does just this")
            diffs |= {name: _diff(name, before, after) for name, (before, after) in changed.items()}
        except (OSError, ValueError, expat.ExpatError) as error:
            return Patch(why_not=f"{shown(policy.file)}: {shown(str(error))}")
    return Patch("".join(diffs[name] for name in sorted(diffs)))


def _changed(policy: Policy, grants: list[Grant]) -> dict[str, tuple[bytes, bytes]] | None:
    """File -> (before, after); None if no way of changing gives what it should."""
    before = {name: contents(Path(name)) for name, _ in policy.sources}
    moved = Counter(_key(grant._replace(allow=False) if grant in set(grants) else grant) for grant in policy.grants)
    added = Counter(map(_key, policy.grants)) + Counter(_key(grant._replace(allow=False)) for grant in grants)
    ways = ((_move, moved), (_add, added))
    for change, expected in ways[:1] if any(grant.dead for grant in grants) else ways:
        after = dict(before)
        once = {(g.place, g.role, g.kind, g.name, g.node): g for g in grants}  # a profile that is included twice
        upwards = sorted(
            once.values(), key=lambda grant: grant.place.line, reverse=True
        )  # what is above keeps its line
        if all(change(after, policy, grant) for grant in upwards) and _grants(policy, after) == expected:
            return {name: (before[name], data) for name, data in after.items() if data != before[name]}
    return None


def _key(grant: Grant) -> Key:
    return (grant.allow, grant.role, grant.kind, grant.name, grant.enclave, grant.node, grant.dead)


def _grants(policy: Policy, texts: Mapping[str, bytes]) -> Counter[Key] | None:
    """What a changed policy grants, read like any other; None if it can no longer be read."""
    with tempfile.TemporaryDirectory(prefix=TEMPORARY) as folder:
        paths = {name: os.path.abspath(name) for name in texts}  # noqa: PTH100 - by its text, as includes are resolved
        root = os.path.commonpath([os.path.dirname(path) for path in paths.values()])  # noqa: PTH120
        for name, path in paths.items():
            copy = Path(folder, os.path.relpath(path, root))
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(texts[name])
        try:
            copied = str(Path(folder, os.path.relpath(paths[policy.file], root)))
            with one_run():  # copies of ours, which are gone soon, are no inputs
                return Counter(map(_key, read_policy(copied, include_root=folder).grants))
        except InputErrors:
            return None


def _move(texts: dict[str, bytes], _: Policy, grant: Grant) -> bool:
    """Take a line out of its group, and put it into one that denies; a group of one line is turned as a whole."""
    name = grant.place.file
    text = _read(name, texts[name])
    group = next((s for s in text.spans if s.tag == grant.kind and s.line == grant.place.line), None)
    if group is None or group.parent is None:
        return False
    line, group = group, group.parent
    roles = [role for role in ROLES[GROUPS[grant.kind]][1] if role in group.attributes]
    if len(roles) > 1:
        return False
    if group.names == 1:
        return _turn(texts, name, group, grant.role)
    after = _group(text.data, group, grant)
    data = text.data[: group.end] + after + text.data[group.end :]
    start, end = _whole_lines(text.data, line.start, line.end)
    texts[name] = data[:start] + data[end:]
    return True


def _turn(texts: dict[str, bytes], name: str, group: _Span, role: str) -> bool:
    data = texts[name]
    head, body = data[: group.start], data[group.start :]
    turned, count = re.subn(rb"(<[^<>]*?\b" + role.encode() + rb"\s*=\s*([\"']))ALLOW(?=\2)", rb"\1DENY", body, count=1)
    texts[name] = head + turned
    return bool(count)


def _add(texts: dict[str, bytes], policy: Policy, grant: Grant) -> bool:
    """Add a group that denies to the end of the profile."""
    for place in (p.place for p in policy.profiles if (p.enclave, p.node) == (grant.enclave, grant.node)):
        text = _read(place.file, texts[place.file])
        for profile in (s for s in text.spans if s.tag == "profile" and not s.empty):
            namespace, node = profile.attributes.get("ns", ""), profile.attributes.get("node", "")
            joined = namespace + node if namespace.endswith("/") else f"{namespace}/{node}"
            opened = text.data.count(b"\n", 0, profile.start) + 1
            if joined == grant.node and opened <= place.line <= text.data.count(b"\n", 0, profile.close) + 1:
                inner = [s for s in text.spans if s.parent is profile]
                if not inner:
                    continue
                after = _group(text.data, inner[-1], grant)
                texts[place.file] = text.data[: inner[-1].end] + after + text.data[inner[-1].end :]
                return True
    return False


def _group(data: bytes, neighbour: _Span, grant: Grant) -> bytes:
    """A group that denies, laid out like its neighbour."""
    newline = b"\r\n" if b"\r\n" in data[: neighbour.end] else b"\n"
    margin = data[data.rfind(b"\n", 0, neighbour.start) + 1 : neighbour.start]
    if margin.strip():
        margin = newline = b""
    step = b"  " if newline else b""
    tag, name = GROUPS[grant.kind], escape(grant.name, quote=False)
    lines = (f'<{tag} {grant.role}="DENY">', f"<{grant.kind}>{name}</{grant.kind}>", f"</{tag}>")
    inner = zip((b"", step, b""), (one.encode() for one in lines), strict=True)
    return b"".join(newline + margin + extra + one for extra, one in inner)


def _whole_lines(data: bytes, start: int, end: int) -> tuple[int, int]:
    """The lines that an element has to itself, else just the element."""
    before, after = data.rfind(b"\n", 0, start) + 1, data.find(b"\n", end) + 1
    if after and not data[before:start].strip() and not data[end:after].strip():
        return before, after
    return start, end


def _read(name: str, data: bytes) -> _Text:
    """Find the elements of a file.

    Raises
    ------
    ValueError
        If it is not UTF-8: a patch is text.
    """
    data.decode("utf-8")
    text = _Text(name, data)
    parser = expat.ParserCreate()
    stack: list[_Span] = []

    def start(tag: str, attributes: dict[str, str]) -> None:
        at, line = parser.CurrentByteIndex, parser.CurrentLineNumber
        span = _Span(tag.rpartition(":")[2], attributes, line, at, stack[-1] if stack else None)
        if span.parent:
            span.parent.names += span.tag == span.parent.tag[:-1]
        text.spans.append(span)
        stack.append(span)

    def end(_: str) -> None:
        span = stack.pop()
        opened = _after_tag(data, span.start)
        span.empty = data[opened - 2 : opened] == b"/>"
        span.close = parser.CurrentByteIndex
        span.end = opened if span.empty else data.index(b">", span.close) + 1

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.Parse(data, True)
    return text


def _after_tag(data: bytes, start: int) -> int:
    """Where a start tag ends; values of attributes may have a > in them."""
    match = re.compile(rb"<(?:[^\"'>]|\"[^\"]*\"|'[^']*')*>").match(data, start)
    return match.end() if match else start


def _diff(name: str, before: bytes, after: bytes) -> str:
    if not name.isprintable():
        raise ValueError("a patch cannot name this file")
    old, new = (_lines(data.decode("utf-8")) for data in (before, after))
    shown_as = name if os.path.isabs(name) else f"/{name}"  # noqa: PTH117
    return "".join(_ended(unified_diff(old, new, f"a{shown_as}", f"b{shown_as}")))


def _lines(text: str) -> list[str]:
    """Lines with their ends, at line feeds only."""
    return [line for line in re.split(r"(?<=\n)", text) if line]


def _ended(lines: Iterable[str]) -> Iterator[str]:
    for line in lines:
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"
