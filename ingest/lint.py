"""The rules of ``rosprivacy lint``, each with an id, and what breaks them, each at its line (rules S4 to S6).

In: policies as they were read, their graph, what labels say of it. Out: ``RULES`` by name, in the order in which they
are documented; ``Breach``es. The files are read once more for includes, since a policy does not keep by which include a
line came.

Source: sros2's ``permissions.xsl`` for the size of permissions, with the signature that ``openssl`` makes; issue 228 of
ros2/sros2 for the bound: the handshake carries permissions in one message, and a message of UDP has at most 64 KiB.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputErrors, shown
from rosprivacy.analysis.model import DIALECT, FALLBACK_TAKEN, UNREAD_FILE, Breach, LintRule, Severity
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.policies.names import DDS, covers, endpoints, is_pattern, resolve
from rosprivacy.ingest.policies.policy_xml import ROLES
from rosprivacy.ingest.policies.xinclude import Documents

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Bound, Diagnostic, FlowGraph, Grant, Place, Policy, Profile
    from rosprivacy.ingest.policies.xinclude import Item

_E, _W, _N = Severity.ERROR, Severity.WARNING, Severity.NOTICE
_RULES = (
    LintRule("refused-policy", _E, "a form that sros2 refuses", "no permissions are made of it"),
    LintRule(
        "dead-deny", _E, "a DENY that sros2 does not read, or in permissions one after an ALLOW of the same",
        "what it should take away is allowed",
    ),
    LintRule("duplicate-enclave", _E, "an enclave path that is there twice", "sros2 uses the first one only"),
    LintRule(
        "several-profiles", _E, "several <profiles> in an enclave, or grants of a subject",
        "DDS uses the first grant only",
    ),
    LintRule("overridden-allow", _W, "an ALLOW that a DENY of its enclave takes back", "it grants nothing"),
    LintRule("wildcard-everything", _E, "a name that is * alone", "it grants every name there is, parameters too"),
    LintRule("wildcard", _W, "a name with *, ? or […]", "it also grants names that nobody thought of"),
    LintRule("mistaken-tilde", _W, "a name that begins with ~ and no /", "sros2 glues it to the node's name"),
    LintRule(
        "relative-standard-name", _W, "rosout, parameter_events or clock, relative in a namespace",
        "nodes use the name without the namespace, and get no permission for it",
    ),
    LintRule(
        "relative-shared-name", _W, "a relative name of a fragment, in several namespaces",
        "in some of them it is another name, which nobody else uses",
    ),
    LintRule("odd-namespace", _W, "a namespace that does not begin with /", "its names are those of no node"),
    LintRule("empty-group", _W, "a group without publish, subscribe, …", "it grants nothing"),
    LintRule("empty-include", _W, "an include that brings nothing", "what somebody meant to grant is not granted"),
    LintRule("repeated-include", _W, "an include that the same profile has already", "it brings nothing new"),
    LintRule(
        "needless-include", _W, "an include of which the profile has every line from elsewhere",
        "it brings nothing new, and who removes a line elsewhere may not think of it",
    ),
    LintRule("missing-include", _W, "an include of a file that is not there", "its fallback is read in its place"),
    LintRule("unused-file", _W, "a policy or a part of one that nothing reads", "what it grants is not granted"),
    LintRule("refused-name", _W, "a name that no ROS node can have", "the line meets no other, or the wrong ones"),
    LintRule("shared-enclave", _W, "an enclave that several files state", "sros2 makes permissions of one file"),
    LintRule(
        "mixed-enclave", _W, "an enclave with a source and a leak, in different nodes",
        "DDS lets each node of it do what any of them may, so nothing that stands between them protects",
    ),
    LintRule("crowded-enclave", _N, "an enclave of several nodes", "each of them may do what any of them may"),
    LintRule(
        "large-permissions", _E, "permissions of more than 64 KiB",
        "they do not fit into the handshake of DDS, so the enclave cannot join",
    ),
)  # fmt: skip
OF_LABELS = ("mixed-enclave",)
"""Those that are about sources and leaks."""
RULES = {rule.name: rule for rule in _RULES}
CHECK_NAMES = {DIALECT: "refused-policy", FALLBACK_TAKEN: "missing-include", UNREAD_FILE: "unused-file"}
"""Codes of what a reader says that are not called as the rule is."""
EVERYTHING = ("*", "/*", "rt/*", "rq/*", "rr/*")
SHOWN_AT_MOST = 3  # of the names that a line stands for
RELATIVE, WRITE_OUT = "relative-standard-name", "write out the names that are meant"
OTHER_END = {
    "publish": "subscribe", "subscribe": "publish", "request": "reply", "reply": "request", "call": "execute",
    "execute": "call",
}  # fmt: skip
OF_EVERY_NODE = ("rosout", "parameter_events", "clock")  # of every node, under one name in all namespaces
AROUND = ("enclaves", "contexts", "enclave", "context", "profiles")  # what profiles stand in
Line = tuple[str, str, str, str]
"""Kind, role, ALLOW or DENY, and name."""
BOUND = 64 * 2**10  # bytes
FRAME = 440  # of a grant: subject, validity, domains, default and what is around them
SECTION = 78  # <publish><topics> with their ends
TOPIC = 28  # <topic></topic> with its indent and the end of its line
SIGNATURE = 1_700


def read_breaches(diagnostics: Iterable[Diagnostic]) -> Iterator[Breach]:
    """Yield the rules that are broken, of what was said of policies as they were read."""
    for one in diagnostics:
        if rule := RULES.get(CHECK_NAMES.get(one.code, one.code)):
            yield Breach(rule, one.place, one.message)


def grant_breaches(grants: Iterable[Grant], graph: FlowGraph) -> Iterator[Breach]:
    """Yield the rules that lines break, with the declared graph of the same policies; of several profiles, once.

    Notes
    -----
    Linear; beside that O(relative names of shared fragments, times the wildcards at the other end), and of permissions
    O(DENY times ALLOW lines of a subject).
    """
    grants = tuple(grants)
    of_line: dict[tuple[str, Place], list[Grant]] = defaultdict(list)
    for grant in grants:
        if rule := _rule(grant):
            of_line[rule, grant.place].append(grant)
    for (rule, place), some in of_line.items():
        roles, named = ", ".join(dict.fromkeys(grant.role for grant in some)), _few(grant.name for grant in some)
        base = some[0].name.rpartition("/")[2]
        hint = f"nodes use /{base}, whatever their namespace; write it so" if rule == RELATIVE else WRITE_OUT
        yield Breach(RULES[rule], place, f"{roles} {named}: {hint}")
    yield from _overridden(graph)
    yield from _alone_in_a_namespace(grants)
    yield from _too_late(grants)


def _rule(grant: Grant) -> str:
    """The rule that a line breaks by its name alone; empty if none."""
    base = grant.name.rpartition("/")[2]
    if grant.allow and is_pattern(grant.name):
        return "wildcard-everything" if grant.name in EVERYTHING else "wildcard"
    if grant.kind == "topic" and not grant.absolute and base in OF_EVERY_NODE and grant.name != f"/{base}":
        return RELATIVE
    return ""


def _overridden(graph: FlowGraph) -> Iterator[Breach]:
    taken: dict[tuple[Place, str, str], dict[str, Place]] = defaultdict(dict)
    for flow in graph.denied:
        for grant in flow.grants:
            taken[grant.place, grant.role, grant.name].setdefault(grant.node, flow.denials[0].place)
    for (place, role, name), nodes in taken.items():
        message = f"{role} {shown(name)} of {_few(nodes)} is allowed here and denied at {next(iter(nodes.values()))}"
        yield Breach(RULES["overridden-allow"], place, f"{message}: it grants nothing")


def _too_late(grants: Iterable[Grant]) -> Iterator[Breach]:
    """DENYs of permissions after an ALLOW of all that they name: the first rule that matches decides."""
    allowed: dict[tuple[str, str, str], list[Grant]] = defaultdict(list)
    for grant in grants:
        if grant.allow and grant.kind == DDS:
            allowed[grant.policy, grant.enclave, grant.role].append(grant)
    for grant in grants:
        if not (grant.allow or grant.dead):
            before = allowed.get((grant.policy, grant.enclave, grant.role), ())
            first = next((one for one in before if one.rank < grant.rank and covers(one.name, grant.name)), None)
            if first:
                message = f"{grant.role} {shown(grant.name)} is allowed at {first.place}, and the first rule decides"
                yield Breach(RULES["dead-deny"], grant.place, f"{message}; move the deny_rule before it")


def _alone_in_a_namespace(grants: Iterable[Grant]) -> Iterator[Breach]:
    """Lines that are other names in other namespaces: at the other end of some somebody is, of others nobody."""
    ends: dict[tuple[str, str], list[str]] = defaultdict(list)
    shared: dict[tuple[Place, str, str], dict[str, None]] = defaultdict(dict)
    for grant in grants:
        if not grant.allow:
            continue
        ends[grant.role, grant.kind].append(grant.name)
        own = grant.name.startswith(f"{grant.node}/")  # ~/name
        standard = grant.name.rpartition("/")[2] in OF_EVERY_NODE
        if grant.place.file != grant.policy and not (grant.absolute or own or standard or is_pattern(grant.name)):
            shared[grant.place, grant.role, grant.kind][grant.name] = None
    plain = {key: set(names) for key, names in ends.items()}
    patterns = {key: [name for name in names if is_pattern(name)] for key, names in plain.items()}
    for (place, role, kind), names in shared.items():
        if len(names) == 1:
            continue
        other = OTHER_END[role], kind
        met = {
            name: None
            for name in names
            if name in plain.get(other, ()) or any(covers(pattern, name) for pattern in patterns.get(other, ()))
        }
        if lone := [name for name in names if name not in met] if met else []:
            message = f"{role} {_few(lone)}: no other end, as {_few(met)} has; write it absolute, if that one is meant"
            yield Breach(RULES["relative-shared-name"], place, message)


def _few(names: Iterable[str]) -> str:
    unlike = list(dict.fromkeys(names))
    return ", ".join(map(shown, unlike[:SHOWN_AT_MOST])) + (", …" if len(unlike) > SHOWN_AT_MOST else "")


class _Include(NamedTuple):
    """One that was read: where it stands, how deep, which fragment it names, and what it brings."""

    place: Place
    chain: tuple[tuple[str, str], ...]
    fragment: tuple[str, str]
    brought: tuple[Item, ...]


class _Traced(Documents):
    """Documents that note which includes they read."""

    def __init__(self, root: Path, bounds: Bounds) -> None:
        super().__init__(root, bounds)
        self.read: list[_Include] = []

    def took(self, include: Item, file: str, xpointer: str, brought: list[Item]) -> None:
        self.read.append(_Include(include.place, include.chain, (file, xpointer), tuple(brought)))


def include_breaches(files: Iterable[str], include_root: str | None, bounds: Bounds) -> Iterator[Breach]:
    """Yield the rules that includes break; what is no policy, or cannot be read, has none.

    Notes
    -----
    Linear in the lines that includes bring.
    """
    for file in files:
        documents = _Traced(Path(include_root) if include_root else Path(file).parent, bounds)
        try:
            root = documents.open(file)
        except InputErrors:
            continue
        if root.tag == "policy":
            yield from _below(documents, root)


def _below(documents: _Traced, item: Item) -> Iterator[Breach]:
    for child in documents.children(item):
        if child.tag == "profile":
            yield from _of_profile(documents, child)
        elif child.tag in AROUND:
            yield from _below(documents, child)


def _of_profile(documents: _Traced, profile: Item) -> Iterator[Breach]:
    before = len(documents.read)
    children = documents.children(profile)
    read = documents.read[before:]
    if not read:
        return
    repeated: set[Place] = set()
    first: dict[tuple[str, str], Place] = {}
    for one in read:
        if one.fragment in first and one.chain == profile.chain:
            repeated.add(one.place)
            message = f"{shown(one.fragment[0])} is included at {first[one.fragment]} already; remove this include"
            yield Breach(RULES["repeated-include"], one.place, message)
        first.setdefault(one.fragment, one.place)
    own = [one for one in read if one.chain == profile.chain and one.brought and one.place not in repeated]
    lines = [_lines(documents, profile, one.brought) for one in own]
    brought = {id(item.element) for one in read for item in one.brought}
    left = _lines(documents, profile, [child for child in children if id(child.element) not in brought])
    times = Counter(chain(left, *lines))
    for one, said in zip(reversed(own), reversed(lines), strict=True):
        if not said:
            if all(item.tag != "metadata" for item in one.brought):
                message = f"what the include brings of {shown(one.fragment[0])} grants and denies nothing"
                yield Breach(RULES["empty-include"], one.place, message)
        elif all(times[line] > 1 for line in said):
            message = f"the profile has all that it brings of {shown(one.fragment[0])} from elsewhere; remove it"
            yield Breach(RULES["needless-include"], one.place, message)
            times.subtract(said)


def _lines(documents: Documents, profile: Item, groups: Sequence[Item]) -> set[Line]:
    """What some groups of a profile say."""
    namespace, node = (str(profile.element.get(name) or "") for name in ("ns", "node"))
    return {
        (kind, role, str(group.element.get(role)), resolve(name.element.text or "", namespace, node))
        for group in groups
        if group.tag in ROLES
        for kind, roles in [ROLES[group.tag]]
        for name in documents.children(group)
        for role in roles
        if group.element.get(role) is not None
    }


def enclave_breaches(policies: Sequence[Policy], graph: FlowGraph, bound: Bound) -> Iterator[Breach]:
    """Yield the rules that enclaves break, by the policies and by what labels say of the graph (rule S6)."""
    profiles: dict[str, dict[str, Profile]] = defaultdict(dict)
    for policy in policies:
        for profile in policy.profiles:
            profiles[profile.enclave].setdefault(profile.node, profile)
    roles = _labelled(graph, bound)
    for enclave, members in sorted(profiles.items()):
        place = min((profile.place for profile in members.values()), key=lambda at: (at.file, at.line))
        if len(members) > 1:
            what = f"enclave {shown(enclave)} has {counted(len(members), 'node')} ({_few(sorted(members))}): "
            yield Breach(RULES["crowded-enclave"], place, f"{what}each may do what any of them may; split it")
        sources, leaks = (sorted(node for node in members if node in roles[role]) for role in ("source", "leak"))
        if sources and any([node] != sources for node in leaks):
            what = f"enclave {shown(enclave)} has a source ({_few(sources)}) and a leak ({_few(leaks)})"
            yield Breach(RULES["mixed-enclave"], place, f"{what}; give them enclaves of their own")
    for policy in policies:
        for enclave, size in sorted(permissions_sizes(policy.grants).items()):
            if size > BOUND:
                place = next(profile.place for profile in policy.profiles if profile.enclave == enclave)
                what = f"the permissions of enclave {shown(enclave)} will have some {size:,} bytes, more than {BOUND:,}"
                yield Breach(RULES["large-permissions"], place, f"{what}; split it, or use fewer names")


def permissions_sizes(grants: Iterable[Grant]) -> dict[str, int]:
    """Return how many bytes the signed permissions of each enclave will have, as sros2 writes them; an estimate."""
    topics: dict[str, set[tuple[bool, bool, str]]] = defaultdict(set)
    for grant in grants:
        for end in endpoints(grant.role, grant.kind, grant.name):
            topics[grant.enclave].add((grant.allow, end.writes, end.dds))
    return {
        enclave: SIGNATURE
        + FRAME
        + 2 * len(enclave)
        + SECTION * len({(allow, writes) for allow, writes, _ in lines})
        + sum(TOPIC + len(dds.encode()) for _, _, dds in lines)
        for enclave, lines in topics.items()
    }


def _labelled(graph: FlowGraph, bound: Bound) -> dict[str, set[str]]:
    """By role, the nodes that labels call sources and leaks."""
    found: dict[str, set[str]] = {"source": set(), "leak": set()}
    for vertex, statements in bound.elements.items():
        for statement in statements:
            if graph.elements[vertex].is_node and statement.role in found:
                found[statement.role].add(graph.elements[vertex].name)
    return found
