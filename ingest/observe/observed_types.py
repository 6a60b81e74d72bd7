"""An observation -> which types its channels have, and who writes and reads them with these (rules S15, S16).

In: an observation as it is written. Out: YAML, sorted. Who uses a channel with a type that is not known is not in it,
not with another type either, so that nobody takes the channel's types for all of them.
"""

from __future__ import annotations

from collections import defaultdict
from io import StringIO
from typing import TYPE_CHECKING, TypeVar

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq

from rosprivacy.ingest.policies.observed_metadata import NOBODY

if TYPE_CHECKING:
    from rosprivacy.ingest.observe.observation import Observation, ObservedEndpoint

Written = TypeVar("Written", CommentedMap, CommentedSeq)
USERS = {  # role of an endpoint -> section, and what its node is there
    "publish": ("topics", "writers"),
    "subscribe": ("topics", "readers"),
    "reply": ("services", "servers"),
    "request": ("services", "clients"),
    "execute": ("actions", "servers"),
    "call": ("actions", "clients"),
}


def types_yaml(observation: Observation) -> str:
    """Return the types of channels, as ``--types`` reads them."""
    entries: dict[str, dict[str, dict[tuple[str, str], list[ObservedEndpoint]]]] = {}
    for section, _ in USERS.values():
        entries[section] = defaultdict(lambda: defaultdict(list))
    unknown = {(one.role, one.name, one.node) for one in observation.endpoints if not one.type}
    for endpoint in observation.endpoints:
        if endpoint.type and (endpoint.role, endpoint.name, endpoint.node) not in unknown:
            entries[USERS[endpoint.role][0]][endpoint.name][endpoint.type, endpoint.hash].append(endpoint)
    document = CommentedMap(types=1, observed=_flow(_observed(observation)))
    for section, channels in entries.items():
        if channels:
            document[section] = CommentedMap(
                (name, CommentedSeq([_entry(*key, users) for key, users in sorted(types.items())]))
                for name, types in sorted(channels.items())
            )
    text = StringIO()
    writer = YAML()
    writer.width = 1_000_000
    writer.indent(mapping=2, sequence=4, offset=2)
    writer.dump(document, text)
    return text.getvalue()


def _observed(observation: Observation) -> CommentedMap:
    said = {"from": observation.seen.first, "to": observation.seen.last, "by": _flow(CommentedSeq(observation.doors))}
    return CommentedMap(said)


def _entry(name: str, digest: str, users: list[ObservedEndpoint]) -> CommentedMap:
    entry = CommentedMap(type=name)
    if digest:
        entry["hash"] = digest
    by_part: dict[str, set[str]] = defaultdict(set)
    for user in users:
        by_part[USERS[user.role][1]].add(user.node.removeprefix(f"{NOBODY}/"))
    for part in dict.fromkeys(part for _, part in USERS.values()):
        if part in by_part:
            entry[part] = _flow(CommentedSeq(sorted(by_part[part])))
    entry["first"] = min(user.seen.first for user in users)
    entry["last"] = max(user.seen.last for user in users)
    return _flow(entry)


def _flow(written: Written) -> Written:
    """In one line."""
    written.fa.set_flow_style()
    return written
