"""Choices -> policies, whole and in pieces that are included, and saved graphs."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape, quoteattr

from tests.fuzzing.words import ACTIONS, NODES, ODD_TEXT, SERVICES, TOPICS, with_fault

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

XI = ' xmlns:xi="http://www.w3.org/2001/XInclude"'
GROUPS = {
    "topics": ("topic", ("publish", "subscribe"), (*TOPICS, "image", "~/raw", "*", "/*", "im?ge[a-z]", "/x[!a]*")),
    "services": ("service", ("request", "reply"), (*SERVICES, "~/get", "/s*", "/spin/_action/send_goal")),
    "actions": ("action", ("call", "execute"), (*ACTIONS, "turn", "/sp*")),
}
INCLUDES = (
    '<xi:include href="node.xml" xpointer="xpointer(/profile/*)"/>',
    '<xi:include href="node.xml" xpointer="xpointer(/*/topics)"/>',
    '<xi:include href="nowhere.xml"><xi:fallback><services request="ALLOW"/></xi:fallback></xi:include>',
    '<xi:include href="" xpointer="xpointer(/policy/enclaves/enclave/profiles/profile/services)"/>',
    '<xi:include href="link.xml" xpointer="xpointer(/profile/*)"/>',
    '<xi:include href="../outside/secret.xml" xpointer="xpointer(/profile/*)"/>',
)
BETWEEN = ("", "", "", "", "\n", "<!-- x -->", "<?x y?>", "<metadata><any/></metadata>", "\n  ")
PATHS = ("/robot", "/", "/other", "/robot/arm")
SPACES = ("/", "/robot", "", "/robot/", "robot")
OUTSIDE = 4  # of the includes above: allowed ones before it
SAVED_ROLES = ("publish", "subscribe", "request", "reply", "call", "execute")


def policy_files(choices: Choices) -> dict[str, str]:
    """A policy, and a fragment that it may include."""
    return {"policy.xml": policy(choices), "node.xml": f"<profile{XI}>{_groups(choices, most=2)}</profile>"}


def policy(choices: Choices) -> str:
    """The text of a policy."""
    old = choices.once_in(8)
    head = '<?xml version="1.0" encoding="UTF-8"?>\n' if choices.once_in(3) else ""
    inner = (
        _profiles(choices)
        if old
        else "".join(
            f"<enclave path={quoteattr(choices.pick(PATHS))}>{_profiles(choices)}</enclave>{choices.pick(BETWEEN)}"
            for _ in range(1 + choices.below(3))
        )
    )
    body = inner if old else f"<enclaves>{inner}</enclaves>"
    return f'{head}<policy version="0.{1 if old else 2}.0"{XI}>\n{body}</policy>'


def _profiles(choices: Choices) -> str:
    profiles = "".join(_profile(choices) for _ in range(1 + choices.below(3)))
    again = f"<profiles>{_profile(choices)}</profiles>" if choices.once_in(10) else ""
    return f"<profiles>{profiles}</profiles>{again}"


def _profile(choices: Choices) -> str:
    space, node = choices.pick(SPACES), choices.pick(("n0", "n1", "n2", "arm", "eye"))
    if choices.once_in(24):
        node = _xml(choices.pick(ODD_TEXT)) or "x"
    return f"\n<profile ns={quoteattr(space)} node={quoteattr(node)}>{_groups(choices, most=4)}</profile>"


def _groups(choices: Choices, most: int) -> str:
    text = ""
    for _ in range(choices.below(most + 1)):
        if choices.once_in(9):
            text += choices.pick(INCLUDES[: len(INCLUDES) if choices.once_in(5) else OUTSIDE])
            continue
        tag = choices.pick(tuple(GROUPS))
        kind, roles, names = GROUPS[tag]
        said = " ".join(f'{role}="{choices.pick(("ALLOW", "ALLOW", "DENY"))}"' for role in choices.some(roles, 1, 2))
        listed = "".join(f"<{kind}>{_name(choices, names)}</{kind}>" for _ in range(1 + choices.below(3)))
        text += f"<{tag} {said}>{listed}</{tag}>{choices.pick(BETWEEN)}"
    return text


def _name(choices: Choices, names: tuple[str, ...]) -> str:
    how = choices.below(24)
    if how == 0:
        return escape(_xml(choices.pick(ODD_TEXT)))
    if how == 1:
        return "".join(choices.pick(("/", "*", "?", "[a-c]", "a", "_x", "~")) for _ in range(choices.below(9)))
    return choices.pick(names)


def _xml(text: str) -> str:
    """Without what XML cannot hold."""
    return "".join(sign for sign in text if sign >= " " and not "\ud800" <= sign <= "\udfff")


def saved_graph(choices: Choices) -> dict[str, str]:
    """A graph as ``--save-graph`` writes it, now and then with one odd place."""
    policies = [_saved_policy(choices, number) for number in range(1 + choices.below(2))]
    whole: Any = {"format": "rosprivacy.graph/1", "policies": policies}
    if choices.once_in(4):
        whole["not_read"] = [_diagnostic(choices)]
    if choices.once_in(3):
        whole = with_fault(choices, whole)
    return {"graph.json": json.dumps(whole, indent=1)}


def _saved_policy(choices: Choices, number: int) -> dict[str, Any]:
    file = f"p{number}.xml"
    owners = [(choices.pick(PATHS), choices.pick(NODES)) for _ in range(1 + choices.below(3))]
    grants = []
    for line in range(choices.below(6)):
        enclave, node = choices.pick(owners)
        role, allow = choices.pick(SAVED_ROLES), not choices.once_in(4)
        fitting = next(names for _, roles, names in GROUPS.values() if role in roles)
        name = choices.pick([name for name in fitting if name.startswith("/")])
        grant: dict[str, Any] = {
            "rule": "ALLOW" if allow else "DENY",
            "role": role,
            "name": name,
            "absolute": choices.once_in(2),
        }
        grant |= {"enclave": enclave, "node": node, "file": file, "line": line}
        grants.append(grant | ({} if allow or choices.once_in(3) else {"dead": choices.once_in(2)}))
    return {
        "file": file,
        "sources": {file: "0" * 64},
        "profiles": [{"enclave": enclave, "node": node, "file": file, "line": 1} for enclave, node in owners],
        "grants": grants,
        "diagnostics": [_diagnostic(choices)] if choices.once_in(3) else [],
    }


def _diagnostic(choices: Choices) -> dict[str, Any]:
    said = (
        "several <profiles> in enclave /robot: DDS uses the first grant only",
        "enclave /robot again (first at p:1)",
    )
    code = choices.pick(("", "not-read", "unread-file"))
    severity = choices.pick(("warning", "notice", "error"))
    return {"severity": severity, "message": choices.pick((*said, "x")), "file": "p0.xml", "line": 1, "code": code}
