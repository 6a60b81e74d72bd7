"""What an earlier run wrote -> an observation again, to which others add (rule S16).

In: policies that ``rosprivacy observe`` wrote, and the types beside them. Out: a door that has looked already. A line
that no observation says to have seen is an error: it would be lost in silence.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, ObservationError, shown
from rosprivacy.ingest.observe.observation import Folded, Observation, ObservedEndpoint, ObservedNode, Span, added_up
from rosprivacy.ingest.policies.observed_metadata import FOLDED, MADE_UP, WAS, observed_in, observed_of
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ingest.policies.xinclude import Documents
from rosprivacy.ingest.types.types_file import read_types

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from lxml import etree

    from rosprivacy.analysis.model import Policy

    Types = Mapping[tuple[str, str, int, str], set[tuple[str, str]]]  # kind, channel, side, node -> types and hashes

INSTEAD = "name a policy as rosprivacy observe wrote it; analyze takes this one beside others"
FIRST_SIDE = ("publish", "reply", "execute")  # writers and servers
WITHOUT_TYPES = "{file} is not there: of what was seen then no types are known"


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
        """Read all files.

        Raises
        ------
        InputErrors
            With what is wrong in any of them.
        """
        seen: list[Observation] = []
        problems: list[InputError] = []
        for policy, types in self.files:
            try:
                seen.append(_read(policy, types))
            except InputErrors as errors:
                problems += errors.errors
        if problems:
            raise InputErrors(problems)
        yield added_up(seen)


def _read(file: str, types_file: str) -> Observation:
    policy = read_policy(file)
    made = {element: path for path, element in _metadata(file)}
    unseen = [grant for grant in policy.grants if grant.seen is None]
    problems: list[InputError] = [
        ObservationError(g.place.file, g.place.line, f"no observation says that {shown(g.name)} was seen", INSTEAD)
        for g in unseen
    ]
    if not made:
        problems = [ObservationError(file, 0, "no observation is in it", INSTEAD)]
    if problems:
        raise InputErrors(problems)
    there = Path(types_file).is_file()
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


def _metadata(file: str) -> Iterator[tuple[str, etree._Element]]:
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
        if grant.seen:
            key, span = (grant.enclave, grant.node), Span(grant.seen.first, grant.seen.last)
            spans[key] = spans[key].with_(span) if key in spans else span
    for profile in policy.profiles:
        path, node = profile.enclave, profile.node
        if not profile.participant:
            told = "" if path in made_up and path == node else path
            yield ObservedNode(node, spans.get((path, node), whole.seen), told)


def _endpoints(policy: Policy, types: Types) -> Iterator[ObservedEndpoint]:
    """Each grant as often as types were seen for it; the type is not known where the file of types has none."""
    strangers = {profile.node: profile.participant for profile in policy.profiles if profile.participant}
    for grant in policy.grants:
        if grant.seen is None:
            continue
        seen, known_as = Span(grant.seen.first, grant.seen.last), strangers.get(grant.node, grant.node)
        node = "" if grant.node in strangers else grant.node
        participant = known_as.removeprefix("participant_") if grant.node in strangers else ""
        side = 0 if grant.role in FIRST_SIDE else 1
        for type_, digest in sorted(types.get((grant.kind, grant.name, side, known_as), {("", "")})):
            yield ObservedEndpoint(
                node, grant.role, grant.name, seen, type_, digest, participant=participant, doors=grant.seen.by
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
