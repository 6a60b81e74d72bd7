"""An observation <-> what is written of it: an SROS 2 policy and a file of the types of its channels (S3, S15, S16).

In: an observation. Out: XML, with what sros2 passes over in its ``<metadata>``, and YAML; both sorted, the same bytes
for the same observation. A node without an enclave gets one of its own, and that is said. Endpoints of no node stand
under a namespace of their own, one profile for each participant, and the metadata say so: who reads it has elements
outside ROS (rule S9). Who uses a channel with a type that is not known is not in the types, not with another type
either, so that nobody takes the channel's types for all of them.

What an earlier run wrote is an observation again, to which others add. A line of it that no observation says to have
seen is an error: it would be lost in silence.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from lxml import etree
from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq

from rosprivacy.analysis.errors import InputErrors, ObservationError, noting, shown
from rosprivacy.ingest.policies.observed_metadata import (
    FOLDED,
    GRANT,
    MADE_UP,
    NOBODY,
    OF_NO_NODE,
    TAG,
    VERSION,
    WAS,
    observed_in,
    observed_of,
)
from rosprivacy.ingest.policies.policy_xml import ROLES, read_policy
from rosprivacy.ingest.policies.xinclude import Documents
from rosprivacy.ingest.reading.path_kinds import is_file
from rosprivacy.ingest.running.observation import Folded, Observation, ObservedEndpoint, ObservedNode, Span, added_up
from rosprivacy.ingest.running.observed_names import whole_actions, with_folded_names, with_good_names
from rosprivacy.ingest.types.types_file import read_types

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Policy

    Types = Mapping[tuple[str, str, int, str], set[tuple[str, str]]]

LONGEST_PARTICIPANT = 40
Grants = dict[tuple[str, str, str], tuple["Span", tuple[str, ...]]]  # kind, role, name -> when, by which doors
Written = TypeVar("Written", CommentedMap, CommentedSeq)
USERS = {  # role of an endpoint -> section, and what its node is there
    "publish": ("topics", "writers"),
    "subscribe": ("topics", "readers"),
    "reply": ("services", "servers"),
    "request": ("services", "clients"),
    "execute": ("actions", "servers"),
    "call": ("actions", "clients"),
}
INSTEAD = "name a policy as rosprivacy observe wrote it; analyze takes this one beside others"
FIRST_SIDE = ("publish", "reply", "execute")  # writers and servers
WITHOUT_TYPES = "{file} is not there: of what was seen then no types are known"


@dataclass(frozen=True, slots=True)
class Prepared:
    """An observation as policy and types tell it: good names, made-up ones folded, actions whole, every node in one
    enclave at least.

    Attributes
    ----------
    enclaves
        Path -> nodes, sorted.
    made_up
        Those of the enclaves that no door told.
    """

    observation: Observation
    folded: tuple[Folded, ...]
    enclaves: Mapping[str, tuple[str, ...]]
    made_up: frozenset[str]


def prepared(observation: Observation) -> Prepared:
    """Make an observation ready to be written."""
    good = with_good_names(added_up((observation,)))
    named = replace(good, endpoints=tuple(map(_of_somebody, whole_actions(good.endpoints))), gaps=good.all_gaps)
    once, folded = with_folded_names(added_up((named,)))
    told: dict[str, set[str]] = defaultdict(set)
    for node in once.nodes:
        if node.enclave not in ("", "/"):  # the root is what every unsecured node says
            told[node.name].add(node.enclave)
    names = {node.name for node in once.nodes} | {endpoint.node for endpoint in once.endpoints}
    enclaves: dict[str, set[str]] = defaultdict(set)
    for name in names:
        for path in told.get(name) or (name,):
            enclaves[path].add(name)
    made_up = frozenset(path for path, nodes in enclaves.items() if any(name not in told for name in nodes))
    return Prepared(once, folded, {path: tuple(sorted(enclaves[path])) for path in sorted(enclaves)}, made_up)


def _of_somebody(endpoint: ObservedEndpoint) -> ObservedEndpoint:
    """An endpoint of no node is of its participant, under a name that no node has."""
    if endpoint.node:
        return endpoint
    named = re.sub(r"[^A-Za-z0-9]+", "_", endpoint.participant)[:LONGEST_PARTICIPANT].strip("_") or "unknown"
    return replace(endpoint, node=f"{NOBODY}/participant_{named}")


def policy_xml(ready: Prepared) -> bytes:
    """Return the policy; ``ValueError`` if there is nothing in it: a policy cannot be empty."""
    if not ready.enclaves:
        raise ValueError("nothing was observed")
    grants: dict[str, Grants] = defaultdict(dict)
    for one in ready.observation.endpoints:
        key = one.kind, one.role, one.name
        seen, doors = grants[one.node].get(key, (one.span, ()))
        grants[one.node][key] = seen.with_(one.span), tuple(sorted({*doors, *one.doors}))
    root = etree.Element("policy", version="0.2.0")
    enclaves = etree.SubElement(root, "enclaves")
    for path, nodes in ready.enclaves.items():
        profiles = etree.SubElement(etree.SubElement(enclaves, "enclave", path=path), "profiles")
        for node in nodes:
            _profile(profiles, node, grants[node])
        _metadata(profiles, ready, path, grants)
    return etree.tostring(root, pretty_print=True, xml_declaration=True, encoding="UTF-8")


def _profile(profiles: etree._Element, node: str, grants: Grants) -> None:
    namespace, _, base = node.rpartition("/")
    profile = etree.SubElement(profiles, "profile", ns=namespace or "/", node=base)
    for group, (kind, roles) in ROLES.items():
        for role in roles:
            names = sorted(name for of, does, name in grants if (of, does) == (kind, role))
            if names:
                element = etree.SubElement(profile, group, {role: "ALLOW"})
                for name in names:
                    etree.SubElement(element, kind).text = name


def _metadata(profiles: etree._Element, ready: Prepared, path: str, grants: Mapping[str, Grants]) -> None:
    """What is known of an enclave's grants beside that they are used."""
    whole, nodes = ready.observation, ready.enclaves[path]
    said = {"version": VERSION, "by": " ".join(whole.doors), "from": whole.span.first, "to": whole.span.last}
    if whole.domains:
        said["domain"] = " ".join(map(str, whole.domains))
    if whole.gaps:
        said["gaps"] = " ".join(f"{gap}:{number}" for gap, number in whole.all_gaps.items())
    if path in ready.made_up:
        said["enclave"] = MADE_UP
    observed = etree.SubElement(etree.SubElement(profiles, "metadata"), TAG, said)
    for one in ready.folded:
        if one.name in nodes:
            folded = etree.SubElement(observed, FOLDED, name=one.name, rule=one.rule)
            for name in one.names:
                etree.SubElement(folded, WAS).text = name
    for node in nodes:
        if node.startswith(f"{NOBODY}/"):
            etree.SubElement(observed, OF_NO_NODE, node=node)
        for (kind, role, name), (seen, doors) in sorted(grants[node].items()):
            facts = {"node": node, "kind": kind, "role": role, "name": name, "by": " ".join(doors)}
            etree.SubElement(observed, GRANT, facts | {"first": seen.first, "last": seen.last})


def types_yaml(observation: Observation) -> str:
    """Return the types of channels, as ``--types`` reads them."""
    entries: dict[str, dict[str, dict[tuple[str, str], list[ObservedEndpoint]]]] = {}
    for section, _ in USERS.values():
        entries[section] = defaultdict(lambda: defaultdict(list))
    unknown = {(one.role, one.name, one.node) for one in observation.endpoints if not one.type}
    for endpoint in observation.endpoints:
        if endpoint.type and (endpoint.role, endpoint.name, endpoint.node) not in unknown:
            entries[USERS[endpoint.role][0]][endpoint.name][endpoint.type, endpoint.hash].append(endpoint)
    seen, doors = observation.span, _flow(CommentedSeq(observation.doors))
    document = CommentedMap(types=1, observed=_flow(CommentedMap({"from": seen.first, "to": seen.last, "by": doors})))
    for section, channels in entries.items():
        if channels:
            document[section] = CommentedMap(
                (name, CommentedSeq([_entry(*key, users) for key, users in sorted(types.items())]))
                for name, types in sorted(channels.items())
            )
    return yaml_text(document, offset=2)


def yaml_text(document: CommentedMap, offset: int = 0) -> str:
    """Return a document as YAML, whose lists stand so many columns behind their keys."""
    text = StringIO()
    writer = YAML()
    writer.width = 1_000_000
    writer.indent(mapping=2, sequence=2 + offset, offset=offset)
    writer.dump(document, text)
    return text.getvalue()


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
    entry["first"] = min(user.span.first for user in users)
    entry["last"] = max(user.span.last for user in users)
    return _flow(entry)


def _flow(written: Written) -> Written:
    """In one line."""
    written.fa.set_flow_style()
    return written


@dataclass(frozen=True, slots=True)
class EarlierFiles:
    """A door of what was seen before.

    Attributes
    ----------
    files
        (policy, the types beside it, which need not be there).
    """

    files: tuple[tuple[str, str], ...]

    def looks(self, seconds: float | None = None) -> Iterator[Observation]:  # noqa: ARG002 - files have looked already
        """Read all files; ``InputErrors`` has every problem."""
        seen: list[Observation] = []
        problems: list[InputError] = []
        for policy, types in self.files:
            with noting(problems):
                seen.append(_read(policy, types))
        if problems:
            raise InputErrors(problems)
        yield added_up(seen)


def _read(file: str, types_file: str) -> Observation:
    policy = read_policy(file)
    made = {element: path for path, element in _observations(file)}
    unseen = [grant for grant in policy.grants if grant.observation is None]
    problems: list[InputError] = [
        ObservationError(g.place.file, g.place.line, f"no observation says that {shown(g.name)} was seen", INSTEAD)
        for g in unseen
    ]
    if not made:
        problems = [ObservationError(file, 0, "no observation is in it", INSTEAD)]
    if problems:
        raise InputErrors(problems)
    there = is_file(types_file)
    remarks = () if there else (WITHOUT_TYPES.format(file=shown(types_file)),)
    try:
        whole = added_up(_of_enclave(element) for element in made)
    except ValueError as error:
        raise InputErrors(
            [ObservationError(file, 0, f"what it says was seen cannot be read: {error}", INSTEAD)]
        ) from None
    endpoints = tuple(_endpoints(policy, _types(types_file) if there else {}))
    nodes = tuple(_nodes(policy, {path for element, path in made.items() if element.get("enclave") == MADE_UP}, whole))
    return replace(whole, nodes=nodes, endpoints=endpoints, remarks=remarks)


def _of_enclave(element: etree._Element) -> Observation:
    """What an observation says of itself beside an enclave."""
    said = observed_of(element)
    domains = tuple(map(int, element.get("domain", "").split()))
    return Observation(
        said.by, Span(said.first, said.last), domains=domains, gaps=dict(said.gaps), folded=tuple(_folded(element))
    )


def _observations(file: str) -> Iterator[tuple[str, etree._Element]]:
    """What observations say in each enclave; that it can be read was seen by who read the policy."""
    for profiles in Documents(Path(file).parent).open(file).element.iter("profiles"):
        enclave = profiles.getparent()
        for child in profiles:
            observed = observed_in(child) if child.tag == "metadata" else None
            if observed is not None and enclave is not None:
                yield enclave.get("path", ""), observed


def _nodes(policy: Policy, made_up: Collection[str], whole: Observation) -> Iterator[ObservedNode]:
    """The nodes, from their first use to the last; one that used nothing, as long as was looked."""
    spans: dict[tuple[str, str], Span] = {}
    for grant in policy.grants:
        if grant.observation:
            key, span = (grant.enclave, grant.node), Span(grant.observation.first, grant.observation.last)
            spans[key] = spans[key].with_(span) if key in spans else span
    for profile in policy.profiles:
        path, node = profile.enclave, profile.node
        if not profile.participant:
            told = "" if path in made_up and path == node else path
            yield ObservedNode(node, spans.get((path, node), whole.span), told)


def _endpoints(policy: Policy, types: Types) -> Iterator[ObservedEndpoint]:
    """Each grant as often as types were seen for it; the type is not known where the file of types has none."""
    strangers = {profile.node: profile.participant for profile in policy.profiles if profile.participant}
    for grant in policy.grants:
        if grant.observation is None:
            continue
        seen, known_as = Span(grant.observation.first, grant.observation.last), strangers.get(grant.node, grant.node)
        node = "" if grant.node in strangers else grant.node
        participant = known_as.removeprefix("participant_") if grant.node in strangers else ""
        side = 0 if grant.role in FIRST_SIDE else 1
        for type_, digest in sorted(types.get((grant.kind, grant.name, side, known_as), {("", "")})):
            yield ObservedEndpoint(
                node, grant.role, grant.name, seen, type_, digest, participant=participant, doors=grant.observation.by
            )


def _types(file: str) -> Types:
    found: dict[tuple[str, str, int, str], set[tuple[str, str]]] = defaultdict(set)
    for channel in read_types(file).channels:
        for one in channel.types:
            for side, nodes in enumerate(one.ends):
                for node in nodes:
                    found[channel.kind, channel.name, side, node].add((one.type, one.hash))
    return found


def _folded(element: etree._Element) -> Iterator[Folded]:
    for child in element:
        if child.tag == FOLDED:
            names = tuple(sorted({was.text for was in child if was.tag == WAS and was.text}))
            yield Folded(child.get("name", ""), names, child.get("rule", ""))
