"""Access lists as the known generator makes them of a policy, with its losses: each written anew from what is known."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from lxml import etree

if TYPE_CHECKING:
    from pathlib import Path

    Node = Any

ROLES = {"topics": ("subscribe", "publish"), "services": ("reply", "request")}
"""The first that an element states is read."""
RULES = {
    "publish": (("egress", ["put"]), ("ingress", ["declare_subscriber"])),
    "subscribe": (("egress", ["declare_subscriber"]), ("ingress", ["put"])),
    "reply": (("ingress", ["query"]), ("egress", ["declare_queryable", "reply"])),
    "request": (("egress", ["query"]), ("ingress", ["declare_queryable", "reply"])),
}


def lossy_lists(policy: str, folder: Path, tail: str = "/*/*") -> list[Path]:
    """Write a list for each node of the first enclave, as generated; of two with one base name the last stays.

    Parameters
    ----------
    tail
        Of keys: ``/**`` before Humble 0.1.6.
    """
    (enclave, *_) = etree.fromstring(policy.encode()).iter("enclave")
    files: dict[Path, None] = {}
    for profile in enclave.iter("profile"):
        file = folder / f"{profile.get('node')}.json5"
        file.write_text(json.dumps({"access_control": _section(profile, tail)}, indent=2))
        files[file] = None
    return list(files)


def _section(profile: Node, tail: str) -> dict[str, Any]:
    node, names = profile.get("node"), {role: set[str]() for role in RULES}
    for group in profile:
        if group.tag in ROLES:
            role = next(one for one in ROLES[group.tag] if group.get(one))
            if group.get(role) == "ALLOW" or role == "publish":
                names[role] |= {f"0/{one.text.replace('~', node, 1).lstrip('/')}{tail}" for one in group}
    rules = [
        {
            "id": f"{role} {flow}",
            "permission": "allow",
            "messages": messages,
            "flows": [flow],
            "key_exprs": sorted(names[role]),
        }
        for role, both in RULES.items()
        if names[role]
        for flow, messages in both
    ]
    tokens = {
        "id": "liveliness_tokens",
        "permission": "allow",
        "messages": ["liveliness_token", "liveliness_query", "declare_liveliness_subscriber", "reply"],
        "flows": ["ingress", "egress"],
        "key_exprs": ["@ros2_lv/0/**"],
    }
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [*rules, tokens],
        "subjects": [{"id": "router"}, {"id": node}],
        "policies": [
            {"rules": [tokens["id"]], "subjects": ["router"]},
            {"rules": [*(rule["id"] for rule in rules), tokens["id"]], "subjects": [node]},
        ],
    }
