"""What is suggested for the systems of the labelled set, held against the readers: precision and recall.

In: systems. Out: ``Measured`` by what was looked at (everything, without types, names alone, types alone).
"""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.channels import Rules
from rosprivacy.analysis.suggesting.evidence import DERIVATION
from rosprivacy.analysis.suggesting.evidence import LEAK as LEAKS
from rosprivacy.analysis.suggesting.evidence import SOURCE as SOURCES
from rosprivacy.analysis.suggesting.library_rules import PYTHON, NodeUse
from rosprivacy.analysis.suggesting.name_rules import NameRules
from rosprivacy.analysis.suggesting.weighing import proposals, unsaid
from rosprivacy.ingest.known_packages.package_folders import read_packages
from rosprivacy.ingest.suggestion_rules.rule_files import read_library_rules, read_name_rules
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table
from rosprivacy.labelling.knowledge import KnownOfSystem, evidence
from rosprivacy.ontology.vocabulary import load
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import answer_robot
from tests.labelled.labelled_set import DERIVES, LEAK, SOURCE, Pair, judged, met

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence
    from pathlib import Path

    from rosprivacy.analysis.model import Element
    from tests.labelled.labelled_set import Judged, System

ROLES = {SOURCES: SOURCE, DERIVATION: DERIVES, LEAKS: LEAK}
NO_NAMES = NameRules()
LEGS = {"publishes": "publish", "subscribes": "subscribe"}
FOLDED = "/_action/"  # parts of actions, which are named themselves (rule S3)
ENDS = {"serves": ("reply", "execute"), "calls": ("request", "call")}


class Look(NamedTuple):
    """What suggestions are made from."""

    name: str
    types: bool = True
    names: bool = True
    packages: bool = True
    code: bool = True


LOOKS = (
    Look("everything"),
    Look("without code", code=False),
    Look("without types", types=False, code=False),
    Look("types alone", names=False, packages=False, code=False),
    Look("names alone", types=False, packages=False, code=False),
)


class Share(NamedTuple):
    """So many of so many."""

    part: int
    of: int

    @property
    def value(self) -> float:
        return self.part / self.of if self.of else 1.0

    def interval(self) -> tuple[float, float]:
        """Return Wilson's interval of 95 %."""
        if not self.of:
            return 0.0, 1.0
        z, n, p = 1.96, self.of, self.value
        middle, half = p + z * z / (2 * n), z * sqrt(p * (1 - p) / n + z * z / (4 * n * n))
        return (middle - half) / (1 + z * z / n), (middle + half) / (1 + z * z / n)


class Measured(NamedTuple):
    """How suggestions do.

    Attributes
    ----------
    precision
        By confidence: of those that the readers do not dispute, how many both of them say.
    recall
        By role: of what both readers say, how much is suggested, as ``may`` or surer.
    wrong
        By confidence: what no reader says.
    missed
        What both readers say and nothing suggests.
    by_that_kind
        Of the sources that both readers name: how many are suggested by that kind, or by a narrower one. Recall also
        counts those that are suggested by a broader one, as the protocol has it.
    asked_about
        Of the sources that both readers name: how many are of nodes of which any source is suggested, so that a person
        looks at the node, whatever kind is suggested.
    unseen
        Of what is not suggested: how much is of nodes of which nothing is suggested, so that no name, type or library
        speaks about them.
    """

    precision: Mapping[str, Share]
    recall: Mapping[str, Share]
    wrong: Mapping[str, Sequence[Pair]]
    missed: Sequence[Pair]
    by_that_kind: Share
    asked_about: Share
    unseen: Share


def measured(some: Iterable[System], look: Look, folder: Path) -> Measured:
    """Hold what is suggested for some systems against the readers."""
    some = tuple(some)
    hierarchy = load().hierarchy
    overlaps = hierarchy.overlaps
    truth = judged(some, overlaps)
    asked = {pair: confidence for system in some for pair, confidence in suggested(system, look, folder).items()}
    precision, wrong = {}, {}
    for confidence in Confidence:
        own = [pair for pair, found in asked.items() if found is confidence]
        precision[str(confidence)], wrong[str(confidence)] = _precision(own, truth, overlaps)
    recall = {}
    for role in ROLES.values():
        known = [pair for pair in truth.agreed if pair.role == role]
        recall[role] = Share(sum(met(pair, asked, overlaps) for pair in known), len(known))
    missed = sorted(pair for pair in truth.agreed if not met(pair, asked, overlaps))
    sources = [pair for pair in truth.agreed if pair.role == SOURCE]
    within = {pair._replace(kind=kind) for pair in asked for kind in (pair.kind and hierarchy.ancestors[pair.kind])}
    by_that_kind = Share(sum(pair in within for pair in sources), len(sources))
    looked_at = {pair[:2] for pair in asked if pair.role == SOURCE}
    asked_about = Share(sum(pair[:2] in looked_at for pair in sources), len(sources))
    told_of = {pair[:2] for pair in asked}
    unseen = Share(sum(pair[:2] not in told_of for pair in missed), len(missed))
    return Measured(precision, recall, wrong, missed, by_that_kind, asked_about, unseen)


def table(looks: Mapping[str, Measured]) -> str:
    """Write the figures as they stand in figures.md."""
    rows = []
    for name, found in looks.items():
        shares = [*(found.precision[sure] for sure in ("likely", "may")), found.recall[SOURCE]]
        shares += [found.by_that_kind, found.asked_about]
        shares += [found.recall[role] for role in (DERIVES, LEAK)]
        rows.append(f"| {name} | {' | '.join(f'{share.part} of {share.of}' for share in shares)} |\n")
    return "".join(rows)


def suggested(system: System, look: Look, folder: Path) -> Mapping[Pair, Confidence]:
    """Return what is suggested for the nodes of a system, each with its confidence."""
    policy, labels = folder / f"{system.name}.policy.xml", folder / f"{system.name}.labels.yaml"
    policy.write_text(policy_text(system), "utf-8")
    labels.write_text(types_text(system), "utf-8")
    result = answer_robot((str(policy),), (str(labels),) if look.types else (), Settings())
    vocabulary, bounds = result.vocabulary, Settings().bounds
    table = read_table(TABLE, vocabulary, bounds)
    names = read_name_rules((), vocabulary, bounds)[0] if look.names else NO_NAMES
    rules = Rules(table.suggestions, table.limits.of, names, vocabulary.hierarchy)
    packages = read_packages((), vocabulary, bounds) if look.packages else ()
    libraries = read_library_rules((), vocabulary, bounds)[0]
    uses = uses_of(system, result.analysis.graph.elements) if look.code else {}
    made = proposals(
        evidence(result.analysis, result.bound, KnownOfSystem(rules, tuple(packages), libraries, ()), uses)
    )
    asked = unsaid(made, result.analysis.graph, result.bound, vocabulary.hierarchy)
    found: dict[Pair, Confidence] = {}
    for one in asked:
        if (role := ROLES.get(one.label.role)) is None:
            continue
        kind = {LEAK: "", DERIVES: one.label.to}.get(role, one.label.kind)
        pair = Pair(system.name, one.label.element.name, role, kind)
        found[pair] = min(one.confidence, found.get(pair, one.confidence), key=tuple(Confidence).index)
    return found


def uses_of(system: System, elements: Iterable[Element]) -> Mapping[int, tuple[NodeUse, ...]]:
    """Return what the code of a system's nodes uses, by vertex."""
    nodes = {at: system.nodes.get(element.name, {}) for at, element in enumerate(elements) if element.is_node}
    return {
        at: tuple(NodeUse(name, PYTHON, Place(node["file"], 0)) for name in node["uses"])
        for at, node in nodes.items()
        if node.get("uses")
    }


def policy_text(system: System) -> str:
    """Write a system as a policy: an enclave for each node."""
    return "".join(
        [
            '<policy version="0.2.0"><enclaves>\n',
            *(_enclave(node, ends) for node, ends in sorted(system.nodes.items())),
            "</enclaves></policy>\n",
        ]
    )


def types_text(system: System) -> str:
    """Write the types of a system's channels as a label file."""
    said: dict[str, dict[str, set[str]]] = {"topics": {}, "services": {}, "actions": {}}
    for ends in system.nodes.values():
        for leg in (*LEGS, *ENDS):
            for name, type_ in ends.get(leg, {}).items():
                if type_ and FOLDED not in name and (leg in LEGS) == ("/msg/" in type_):  # code may name a wrong one
                    section = "topics" if leg in LEGS else "actions" if "/action/" in type_ else "services"
                    said[section].setdefault(name, set()).add(type_)
    lines = ["labels: 1\n"]
    for section, names in said.items():
        lines += [f"{section}:\n"] if names else []
        lines += [f"  {name}: {{types: [{', '.join(sorted(types))}]}}\n" for name, types in sorted(names.items())]
    return "".join(lines)


def _enclave(node: str, ends: Mapping[str, Mapping[str, str]]) -> str:
    lines = []
    for leg, role in LEGS.items():
        lines += [
            f'<topics {role}="ALLOW"><topic>{name}</topic></topics>' for name in ends.get(leg, ()) if FOLDED not in name
        ]
    for leg, (service, action) in ENDS.items():
        for name, type_ in ends.get(leg, {}).items():
            kind, role = ("action", action) if "/action/" in type_ else ("service", service)
            lines.append(f'<{kind}s {role}="ALLOW"><{kind}>{name}</{kind}></{kind}s>')
    space, _, own = node.rpartition("/")
    profile = f'<profile ns="{space or "/"}" node="{own}">{"".join(lines)}</profile>'
    return f'<enclave path="{node}"><profiles>{profile}</profiles></enclave>\n'


def _precision(
    own: Iterable[Pair], truth: Judged, overlaps: Mapping[str, Collection[str]]
) -> tuple[Share, Sequence[Pair]]:
    right, wrong = 0, []
    for pair in own:
        if met(pair, truth.agreed, overlaps):
            right += 1
        elif not met(pair, truth.disputed, overlaps):
            wrong.append(pair)
    return Share(right, right + len(wrong)), sorted(wrong)
