"""An observation -> an ordinary SROS 2 policy, with what sros2 passes over in its ``<metadata>`` (rules S3, S16).

In: an observation. Out: XML, sorted, the same bytes for the same observation. A node without an enclave gets one of its
own, and that is said. Endpoints of no node stand under a namespace of their own, one profile for each participant, and
the metadata say so: who reads it has elements outside ROS (rule S9).
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from lxml import etree

from rosprivacy.ingest.observe.action_parts import whole_actions
from rosprivacy.ingest.observe.made_up_names import with_folded_names
from rosprivacy.ingest.observe.observation import added_up
from rosprivacy.ingest.observe.observed_names import with_good_names
from rosprivacy.ingest.policies.observed_metadata import FOLDED, GRANT, MADE_UP, NOBODY, OF_NO_NODE, TAG, VERSION, WAS
from rosprivacy.ingest.policies.policy_xml import ROLES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.ingest.observe.observation import Folded, Observation, ObservedEndpoint, Span

LONGEST_PARTICIPANT = 40
Grants = dict[tuple[str, str, str], tuple["Span", tuple[str, ...]]]  # kind, role, name -> when, by which doors


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
    """Return the policy.

    Raises
    ------
    ValueError
        If there is nothing in it: a policy cannot be empty.
    """
    if not ready.enclaves:
        raise ValueError("nothing was observed")
    grants: dict[str, Grants] = defaultdict(dict)
    for one in ready.observation.endpoints:
        key = one.kind, one.role, one.name
        seen, doors = grants[one.node].get(key, (one.seen, ()))
        grants[one.node][key] = seen.with_(one.seen), tuple(sorted({*doors, *one.doors}))
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
    said = {"version": VERSION, "by": " ".join(whole.doors), "from": whole.seen.first, "to": whole.seen.last}
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
