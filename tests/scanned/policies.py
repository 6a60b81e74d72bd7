"""How much of systems with a public SROS 2 policy a scan finds: ``python -m tests.scanned.policies FOLDER``.

In: FOLDER with the checkouts of ``policies.jsonl``, each at ``<system>/<owner>+<name>``, and the policies of the corpus
(``ROSPRIVACY_CORPUS``), which were recorded from the running system or written by its developers: what they say is the
truth. Not counted: wildcards, DENY, the standard channels of every node (rule S13) and of every managed node. A node
that a library makes beside a node (``HELPERS``) counts as that node. ``--missed`` and ``--wrong`` list what differs.
"""

from __future__ import annotations

import argparse
import json
import os
from collections import Counter
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.policies.names import endpoints, is_pattern
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ingest.running.observed_names import plain_name
from rosprivacy.ingest.scan.checkout import read_checkout, systems_of
from rosprivacy.ingest.scan.scan_facts import BASES, ROLES
from rosprivacy.ingest.scan.systems import whole_system
from tests.scanned.measuring import WEAK
from tests.scanned.truth import HERE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Grant, Policy
    from rosprivacy.ingest.scan.checkout import Checkout
    from rosprivacy.ingest.scan.systems import ScannedSystem

CORPUS = Path(os.environ.get("ROSPRIVACY_CORPUS", HERE.parents[2] / "shared" / "corpus"))
STANDARD = (
    "*/rosout", "*/parameter_events", "*/clock", "*/describe_parameters", "*/get_parameter_types", "*/get_parameters",
    "*/list_parameters", "*/set_parameters", "*/set_parameters_atomically", "*/get_type_description",
    "*/change_state", "*/get_state", "*/get_available_states", "*/get_available_transitions", "*/get_transition_graph",
    "*/transition_event",
)  # fmt: skip
HELPERS = ("_rclcpp_node", "_service_client")  # of nav2_util's nodes, and of its lifecycle manager
LISTENER = "transform_listener_impl"  # of tf2; nothing tells whose
OF_LISTENER = {("subscribe", "/tf"), ("subscribe", "/tf_static")}
OF_ACTION = {"publish": "execute", "reply": "execute", "subscribe": "call", "request": "call"}
FOUND, UNSURE, NAMED, NODE, LOST = "found", "unsure", "named by a gap", "node not found", "lost without a word"


class Pair(NamedTuple):
    """A system with its policies.

    Attributes
    ----------
    policies
        Files of the corpus.
    launches
        What the policies' authors started; of other nodes the names in the code count.
    checkouts
        Repository and commit of each.
    """

    system: str
    policies: Sequence[str]
    launches: Sequence[str]
    checkouts: Sequence[Sequence[str]]


class Use(NamedTuple):
    """A node uses a channel."""

    node: str
    role: str
    name: str


class Scanned(NamedTuple):
    """What a scan says: uses with how each is known, nodes, and (node, role) of which it says that not all is known."""

    uses: Mapping[Use, str]
    nodes: frozenset[str]
    gaps: frozenset[tuple[str, str]]


class Measure(NamedTuple):
    """Uses of the truth by what becomes of them, and what the scan says of the same nodes and the policies do not."""

    true: Mapping[Use, str]
    wrong: frozenset[Use]

    def line(self, system: str) -> str:
        """Return the figures of a system, for people."""
        sorts, nodes = Counter(self.true.values()), {use.node for use in self.true}
        there = nodes - {use.node for use, sort in self.true.items() if sort == NODE}
        right = sorts[FOUND] / ((sorts[FOUND] + len(self.wrong)) or 1)
        missed = ", ".join(f"{sort} {sorts[sort]}" for sort in (UNSURE, NAMED, NODE, LOST))
        found = f"nodes {len(there)}/{len(nodes)}, uses {sorts[FOUND]}/{len(self.true)}, precision {right:.2f}"
        return f"{system}: {found}; {missed}"


def pairs() -> Sequence[Pair]:
    """Return the systems with a policy, sorted."""
    return [Pair(**json.loads(line)) for line in (HERE / "policies.jsonl").read_text("utf-8").splitlines()]


def policy_uses(policies: Iterable[Policy]) -> frozenset[Use]:
    """Return what policies state by name, with the parts of actions and made-up names folded (rules S3, S16)."""
    return frozenset(
        _use(grant)
        for policy in policies
        for grant in policy.grants
        if grant.allow and not is_pattern(grant.name) and not _is_standard(grant.name)
    )


def _use(grant: Grant) -> Use:
    end = endpoints(grant.role, grant.kind, grant.name)[0]
    node = plain_name(grant.node)[0]
    for helper in HELPERS:
        node = node.removesuffix(helper)
    return Use(node, OF_ACTION.get(grant.role, grant.role) if end.kind == "action" else grant.role, end.name)


def _is_standard(name: str) -> bool:
    return any(fnmatchcase(name, pattern) for pattern in STANDARD)


def scanned_uses(checkout: Checkout, launches: Sequence[str]) -> Scanned:
    """Return what a scan says of the systems of some launch files, and of the nodes that these do not start."""
    systems = [system for system in systems_of(checkout) if system.launch in launches]
    if absent := set(launches) - {system.launch for system in systems}:
        raise ValueError(f"no launch file: {', '.join(sorted(absent))}")
    started = {node.name for system in systems for node in system.nodes}
    uses: dict[Use, str] = {}
    for node, role, name, basis in _ends((*systems, whole_system(checkout.facts)), started):
        use = Use(node, role, name)
        uses[use] = min(basis, uses.get(use, basis), key=BASES.index)
    gaps = {
        (gap.text.partition(": ")[0], role)
        for system in systems
        for gap in system.gaps
        for role in ROLES
        if gap.sort == "name" and f"({role})" in gap.text
    }
    gaps |= {(node.name, role) for system in systems for node in system.nodes if not node.code for role in ROLES}
    return Scanned(uses, frozenset(started | {use.node for use in uses}), frozenset(gaps))


def _ends(systems: Iterable[ScannedSystem], started: set[str]) -> Iterator[tuple[str, str, str, str]]:
    for system in systems:
        for end in system.ends:
            if (system.launch or end.node not in started) and not _is_standard(end.name):
                node = end.node
                for helper in HELPERS:
                    node = node.removesuffix(helper)
                yield node, end.role, end.name, end.basis


def measured(true: frozenset[Use], scanned: Scanned) -> Measure:
    """Return what becomes of what policies state, and what a scan is sure of that they do not state."""
    nodes = {use.node for use in true}
    listens = any(node.endswith(LISTENER) for node in nodes)
    kept = {use: _sort(use, scanned) for use in true if not use.node.endswith(LISTENER)}
    wrong = {
        use
        for use, basis in scanned.uses.items()
        if use.node in nodes and basis not in WEAK and not (listens and use[1:] in OF_LISTENER)
    }
    return Measure(kept, frozenset(wrong - true))


def _sort(use: Use, scanned: Scanned) -> str:
    if basis := scanned.uses.get(use):
        return UNSURE if basis in WEAK else FOUND
    if use.node not in scanned.nodes:
        return NODE
    return NAMED if (use.node, use.role) in scanned.gaps else LOST


def main() -> None:
    """Print the figures of each system that is there."""
    parser = argparse.ArgumentParser(prog="python -m tests.scanned.policies")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--missed", action="store_true")
    parser.add_argument("--wrong", action="store_true")
    arguments = parser.parse_args()
    for pair in pairs():
        root = arguments.folder / pair.system
        if not root.is_dir():
            continue
        true = policy_uses(read_policy(str(CORPUS / "policies" / file)) for file in pair.policies)
        measure = measured(true, scanned_uses(read_checkout(str(root), launches=pair.launches), pair.launches))
        print(measure.line(pair.system))
        lost = [f"  {sort}: {' '.join(use)}" for use, sort in sorted(measure.true.items()) if sort != FOUND]
        print("".join(f"{line}\n" for line in lost if arguments.missed), end="")
        print("".join(f"  wrong: {' '.join(use)}\n" for use in sorted(measure.wrong) if arguments.wrong), end="")


if __name__ == "__main__":
    main()
