"""What lies outside ROS, and log calls, of a scanned system -> a label file: facts, and questions as comments.

In: by node what its code exchanges data with and logs; what configurations state; the channels of the system. Out: the
text of a label file. What a file states is an element, with flows from and to the channels that it names; what the use
of a library suggests is a suggestion, as ``suggest`` writes it: the node may be a leak. A node that logs data of a
channel writes it into the log files of ROS, a storage for which nobody has stated a retention. Which node exchanges
data with a service of a compose file nobody says: that is an element without flows, and told as such (rule S11).
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from ruamel.yaml.comments import CommentedMap

from rosprivacy.analysis.model import Confidence, Element, Place
from rosprivacy.analysis.suggesting.evidence import ANYTHING, CODE, LEAK, Evidence, LabelProposal, SuggestedLabel
from rosprivacy.analysis.text import blanked, cut
from rosprivacy.ingest.running.observed_files import yaml_text
from rosprivacy.ingest.suggestion_rules.comments import comment_of, with_comments

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.ingest.scan.scan_facts import CodePlace, External, LogCall

HEAD = """\
# What lies outside ROS, read from source code and configurations. Elements and flows stand in a file, at the place that
# the note names; suggestions are what the use of a library may mean. Nothing of it was seen running: review it.
"""
LOG_FILES = "~/.ros/log"  # of loggers, and of what launched nodes print, unless ROS_LOG_DIR says otherwise
WHERE_OF = {"screen": "display", "loudspeaker": "loudspeaker", "file": "file", "database": "file"}  # else network
VOLUME = "volume "
EVERYTHING = (".*", ".+")
LONGEST_NAME = 120
LOGGED = "data of channels is logged"


def outside_labels(
    externals: Iterable[tuple[str, External]],
    logs: Iterable[tuple[str, LogCall]],
    stated: Iterable[External],
    channels: Mapping[str, str],
) -> str:
    """Return the text of a label file; empty if there is nothing to say.

    Parameters
    ----------
    externals, logs
        Each with the full name of its node.
    channels
        Of the system: name -> ``topic``, ``service`` or ``action``.
    """
    elements: dict[str, CommentedMap] = {}
    flows: dict[tuple[str, str, str], CommentedMap] = {}
    for one in sorted(set(stated)):
        name = element_name(one.name)
        kind = "storage" if one.name.startswith(VOLUME) else "external-system"
        elements.setdefault(name, CommentedMap(kind=kind, note=f"stated in {_at(one.place)}"))
        for channel in _of_system(one.channels, channels):
            end = CommentedMap({channels[channel]: channel})
            if one.outgoing:
                flows.setdefault((channel, "", name), CommentedMap({"from": end, "to": name}))
            if one.incoming:
                flows.setdefault((name, "", channel), CommentedMap({"from": name, "to": end}))
    places: dict[str, list[CodePlace]] = defaultdict(list)
    for node, call in logs:
        places[node].append(call.place)
    for node, some in sorted(places.items()):
        first = min(some)
        elements.setdefault(LOG_FILES, CommentedMap(kind="storage", note=f"{LOGGED}, first by {node} ({_at(first)})"))
        flows[node, "node", LOG_FILES] = CommentedMap({"from": CommentedMap(node=node), "to": LOG_FILES})
    comments = list(_suggestions(externals))
    if not elements and not comments:
        return ""
    document = CommentedMap(labels=1)
    if elements:
        document["elements"] = CommentedMap(sorted(elements.items()))
    if flows:
        document["flows"] = [flow for _, flow in sorted(flows.items(), key=lambda pair: pair[0])]
    return with_comments(HEAD + yaml_text(document), comments)


def element_name(text: str) -> str:
    """Return a name that an element outside ROS can have: in one line, without a colon, and no name of ROS.

    >>> element_name("MQTT broker [::1]"), element_name("/data")
    ('MQTT broker [__1]', 'outside /data')
    """
    name = " ".join(blanked(text).split()).replace(":", "_")[:LONGEST_NAME].strip()
    return name if name[:1].isalnum() or name.startswith("~") else f"outside {name}".strip()


def _of_system(names: Collection[str], channels: Mapping[str, str]) -> Iterator[str]:
    """The channels of the system that a configuration names; patterns are not followed but for one that takes all."""
    if any(name in EVERYTHING for name in names):
        yield from sorted(channels)
        return
    for name in names:
        absolute = f"/{name.lstrip('/')}"
        if absolute in channels:
            yield absolute


def _suggestions(externals: Iterable[tuple[str, External]]) -> Iterator[str]:
    """One comment for each node to which code says that something may leave ROS."""
    by_node: dict[str, set[External]] = defaultdict(set)
    for node, one in externals:
        if one.outgoing and not one.stated:
            by_node[node].add(one)
    for node, some in sorted(by_node.items()):
        label = SuggestedLabel(Element("node", node), LEAK, ANYTHING)
        reasons = tuple(_reason(label, one) for one in sorted(some))
        yield comment_of(LabelProposal(label, Confidence.MAY, reasons))


def _reason(label: SuggestedLabel, external: External) -> Evidence:
    place = Place(external.place.file, external.place.line)
    what = (
        f"exchanges data with {cut(element_name(external.name), LONGEST_NAME)} ({external.sort}, {_at(external.place)})"
    )
    return Evidence(label, CODE, Confidence.MAY, what, place, where=WHERE_OF.get(external.sort, "network"))


def _at(place: CodePlace) -> str:
    return f"{blanked(place.file)}:{place.line}"
