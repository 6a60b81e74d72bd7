"""Policies by enclaves, and the enforced view written out: the brute force of rule S6."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Mapping

    from rosprivacy.analysis.model import Profile

Right = tuple[str, str, str, str]  # role, kind, name, rule
Enclaves = dict[str, dict[str, list[Right]]]  # path -> node -> rights


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
