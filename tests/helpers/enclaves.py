"""Policies by enclaves, and the enforced view written out: the brute force of rule S6."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING

from hypothesis import strategies as st

from tests.helpers.written_systems import ROLES

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Mapping

    from rosprivacy.analysis.model import Profile

Right = tuple[str, str, str, str]  # role, kind, name, rule
Enclaves = dict[str, dict[str, list[Right]]]  # path -> node -> rights
NODES = tuple(f"/n{i}" for i in range(5))
PATHS = ("/e", "/f")
TOPICS = ("/a", "/b", "/c/_action/feedback", "/a*", "/*", "/parameter_events")
RIGHTS = tuple(
    [(role, "topic", name, "ALLOW") for role in ("publish", "subscribe") for name in TOPICS]
    + [(role, "service", name, "ALLOW") for role in ("request", "reply") for name in ("/s", "/c/_action/send_goal")]
    + [(role, "action", "/c", "ALLOW") for role in ("call", "execute")]
    + [("publish", "topic", "/b", "DENY"), ("subscribe", "topic", "/a*", "DENY"), ("request", "service", "/s", "DENY")]
)
ALWAYS = {"/n0": RIGHTS[:1], "/n1": [("subscribe", "topic", "/b", "ALLOW")]}  # labels name these
CHANNEL = ("mundane", "sensitive", "{only: [Video]}", "{never: [Voice]}")
SOURCES = (ROLES[0], "{source: {Video: [/a]}}", "{source: {Video: [/a], Voice: ['/*']}}")


@st.composite
def systems(draw: st.DrawFn) -> tuple[Enclaves, str]:
    """Enclaves, some nodes of which stand in both; and the text of a label file."""
    enclaves: Enclaves = {}
    for node in NODES:
        for path in draw(st.sampled_from((PATHS[:1], PATHS[:1], PATHS[1:], PATHS))):
            some = draw(st.lists(st.sampled_from(RIGHTS), max_size=4, unique=True))
            enclaves.setdefault(path, {})[node] = [*ALWAYS.get(node, ()), *some]
    roles = {node: draw(st.sampled_from(ROLES)) for node in NODES[1:]}
    roles["/n0"] = draw(st.sampled_from(SOURCES))
    used = sorted({name for some in enclaves.values() for of in some.values() for _, _, name, _ in of})
    plain = [name for name in used if name in ("/a", "/b", "/s")]
    channels = {name: draw(st.sampled_from(CHANNEL)) for name in plain if draw(st.integers(0, 3)) == 0}
    lines = ["labels: 1", "nodes:", *(f"  {name}: {said}" for name, said in sorted(roles.items()))]
    lines += ["channels:", *(f'  "={name}": {said}' for name, said in channels.items())] if channels else []
    lines += ["elements:", "  disk: {kind: storage, country: US, retention: P3D}"]
    lines += ["flows:", f"  - {{from: {draw(st.sampled_from(NODES))}, to: disk}}"]
    limit = draw(
        st.sampled_from(("", "", '{from: "*", to: {topic: /a}, never: [Voice]}', "{from: /b, to: /n1, only: [Voice]}"))
    )
    return enclaves, "\n".join([*lines, *([f"  - {limit}"] if limit else []), ""])


def policy_of(enclaves: Mapping[str, Mapping[str, Iterable[Right]]]) -> str:
    """Return the text of a policy."""
    lines = ['<policy version="0.2.0"><enclaves>']
    for path, profiles in enclaves.items():
        lines.append(f'<enclave path="{path}"><profiles>')
        for node, rights in profiles.items():
            of: dict[tuple[str, str, str], list[str]] = defaultdict(list)
            for role, kind, name, rule in rights:
                of[kind, role, rule].append(name)
            namespace, _, name = node.rpartition("/")
            lines.append(f'<profile ns="{namespace or "/"}" node="{name}">')
            for (kind, role, rule), names in of.items():
                told = "\n".join(f"<{kind}>{name}</{kind}>" for name in names)
                lines.append(f'<{kind}s {role}="{rule}">\n{told}</{kind}s>')
            lines.append("</profile>")
        lines.append("</profiles></enclave>")
    return "\n".join([*lines, "</enclaves></policy>\n"])


def each_alone(profiles: Iterable[Profile], alone: Container[str]) -> dict[str, tuple[str, ...]]:
    """No node is like another: each has every grant of its enclaves as flows of its own."""
    del alone
    return {profile.node: (profile.node,) for profile in profiles}


def write(enclaves: Enclaves, labels: str = "") -> None:
    """Write p.xml and l.yaml."""
    Path("p.xml").write_text(policy_of(enclaves), "utf-8")
    Path("l.yaml").write_text(labels, "utf-8")
