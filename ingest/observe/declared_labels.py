"""What nodes declare of themselves -> a label file, as their own word.

In: declarations. Out: YAML. A declaration names a node from which personal data stem, what for, and perhaps the file
that they are kept in; it names no kind of data, so the source is one of ``PersonalData``. The file is read only where
``--labels`` names it: a person takes it over, or does not.
"""

from __future__ import annotations

from io import StringIO
from typing import TYPE_CHECKING

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap

from rosprivacy.analysis.text import blanked
from rosprivacy.ingest.labels.entries import LONGEST_NAME as LONGEST
from rosprivacy.ingest.observe.declared import TYPE
from rosprivacy.ingest.observe.observed_names import is_name

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.ingest.observe.declared import Declared
    from rosprivacy.ingest.observe.observation import Span

ANY_KIND = "PersonalData"
HEAD = """\
# What nodes declared of themselves ({type}), seen from {first} to {last}.
# It is their own word: nobody has checked it, and it names no kind of data. Review it, name the kinds, give it with -l.
"""


def declared_labels(several: Iterable[Declared], seen: Span) -> str:
    """Return a label file; empty if nothing that is declared can be said in one."""
    nodes: dict[str, CommentedMap] = {}
    elements: dict[str, CommentedMap] = {}
    flows: set[tuple[str, str]] = set()
    for one in sorted(set(several)):
        if not is_name(one.node):
            continue
        facts = nodes.setdefault(one.node, CommentedMap(source=[ANY_KIND], author=f"{one.node} itself"))
        called, purpose = _plain(one.called), _plain(one.purpose)
        _say(facts, "note", f"declared on {one.topic}" + (f": {called}" if called else ""))
        if purpose:
            purposes = facts.setdefault("purpose", [])
            purposes += [purpose] if purpose not in purposes else []
        if one.path:
            name = _element(one.path)
            elements.setdefault(name, CommentedMap(kind="storage", author=f"{one.node} itself"))
            flows.add((one.node, name))
    if not nodes:
        return ""
    document = CommentedMap(labels=1, nodes=CommentedMap(sorted(nodes.items())))
    if elements:
        document["elements"] = CommentedMap(sorted(elements.items()))
        document["flows"] = [{"from": node, "to": name} for node, name in sorted(flows)]
    text = StringIO()
    writer = YAML()
    writer.width = 1_000_000
    writer.dump(document, text)
    return HEAD.format(type=TYPE, first=seen.first, last=seen.last) + text.getvalue()


def _say(facts: CommentedMap, key: str, text: str) -> None:
    known = facts.get(key)
    facts[key] = text if known is None or known == text else f"{known}; {text}"


def _element(path: str) -> str:
    """A name that no element of ROS has, without what the label file's grammar forbids."""
    return f"file {_plain(path).lstrip('/').replace(':', '_')}"[:LONGEST].strip()


def _plain(text: str) -> str:
    return " ".join(blanked(text).split())[:LONGEST]
