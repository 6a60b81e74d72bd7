"""Graph -> a first label file: every element once, grouped, with comments, ready to fill in.

In: a flow graph. Out: YAML text that is a valid label file as it is (it says nothing yet).
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import yaml

from rosprivacy.analysis.text import blanked

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rosprivacy.analysis.model import FlowGraph

HEADER = """\
# yaml-language-server: $schema={schema}
# Labels: which elements bring personal data in, let it out, clean it or pass it on, per kind of data.
# Fill in what you know; an element without a label counts as not reviewed, and data passes it.
#
#   nodes:     {{source: [Video]}}                    brings the data in
#              {{source: {{Video: [/robot_video]}}}}    … but only through these channels
#              {{leak: [Voice]}}                      lets it out: to a cloud, a display, a log
#              {{sanitizer: {{Video: anonymise}}}}      ends it: anonymise, aggregate, drop; pseudonymise does not
#              {{derives: [{{from: Video, to: FaceTemplate}}]}}   makes one kind of another
#              conduit  or  {{conduit: [Location]}}   reviewed: passes it on
#   channels:  mundane     never carries personal data
#              sensitive   reviewed: may carry it
#              {{only: [HomeMap]}}  or  {{never: [Location]}}
#
# Categories: {categories}
labels: 1
"""
LONGEST_KEY = 1000  # of YAML, without a question mark before it
SCHEMA_FILE = "labels.schema.json"


def template(graph: FlowGraph, categories: Collection[str], standard: Collection[tuple[str, str]]) -> str:
    """Return the text of a first label file.

    Parameters
    ----------
    categories
        Names to show in the head.
    standard
        (kind, name) of the channels that the standard file takes as mundane: listed as comments.
    """
    text = HEADER.format(schema=SCHEMA_FILE, categories=", ".join(categories))
    taken = set(standard)
    return text + "\n".join([*_nodes(graph, taken), *_channels(graph, taken), ""])


def _nodes(graph: FlowGraph, standard: Collection[tuple[str, str]]) -> Iterator[str]:
    enclaves: dict[str, set[str]] = defaultdict(set)
    for profile in graph.profiles:
        enclaves[profile.node].add(profile.enclave)
    groups: dict[str, list[str]] = defaultdict(list)
    for element in graph.elements:
        if element.is_node:
            groups[", ".join(sorted(enclaves[element.name]))].append(element.name)
    writes, reads = _neighbours(graph, standard)
    yield "\nnodes:"
    for group, names in sorted(groups.items()):
        yield f"  # enclave {blanked(group, '?')}"
        for name in names:
            yield f"  {_key(name)}{_doing(writes.get(name, set()), reads.get(name, set()))}"


def _neighbours(
    graph: FlowGraph, standard: Collection[tuple[str, str]]
) -> tuple[Mapping[str, set[str]], Mapping[str, set[str]]]:
    """Names of the channels that each node writes and reads, the standard ones left out."""
    writes: dict[str, set[str]] = defaultdict(set)
    reads: dict[str, set[str]] = defaultdict(set)
    for flow in graph.flows:
        source, target = graph.elements[flow.source], graph.elements[flow.target]
        channel = target if source.is_node else source
        if (channel.kind, channel.name) in standard:
            continue
        if source.is_node:
            writes[source.name].add(target.name)
        elif target.is_node:
            reads[target.name].add(source.name)
    return writes, reads


def _doing(writes: set[str], reads: set[str], most: int = 4) -> str:
    parts = []
    for verb, names in (("writes", writes), ("reads", reads)):
        if names:
            more = f" and {len(names) - most} more" if len(names) > most else ""
            parts.append(f"{verb} {', '.join(sorted(names)[:most])}{more}")
    return f"  # {blanked('; '.join(parts), '?')}" if parts else ""


def _channels(graph: FlowGraph, standard: Collection[tuple[str, str]]) -> Iterator[str]:
    kinds: dict[str, list[str]] = defaultdict(list)
    for kind, name in sorted({(e.kind, e.name) for e in graph.elements if not e.is_node}, key=lambda k: (k[1], k[0])):
        kinds[name].append(kind)
    groups: dict[str, list[str]] = defaultdict(list)
    for name, found in kinds.items():
        groups["standard" if all((kind, name) in standard for kind in found) else " and ".join(found)].append(name)
    taken = groups.pop("standard", [])
    yield "\nchannels:"
    for group, names in sorted(groups.items()):
        yield f"  # {group}s" if " " not in group else f"  # {group} of one name"
        yield from (f"  {_key(name)}" for name in names)
    if taken:
        yield "  # taken as mundane by the standard file; remove the # to say otherwise"
        yield from (f"  # {_key(name)} sensitive" for name in taken)


def _key(name: str) -> str:
    """A name as a YAML key, with its colon."""
    if not name.startswith(("/", "*", "?", "[")):  # sros2 does not repair a namespace without /; labels need one
        name = ("?" if name[0] in "!^]" else f"[{name[0]}]") + name[1:]
    plain = name.isascii() and all(c.isalnum() or c in "/_-." for c in name)
    text = name if plain else yaml.dump(name, default_style='"', width=float("inf")).strip()
    return f"{text}:" if len(text) < LONGEST_KEY else f"? {text}\n  :"
