"""Choices -> permissions, governance and Zenoh's access lists: whole, odd in one place, cut."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

from tests.fuzzing.words import ODD_TEXT, with_fault
from tests.helpers.keystores import governance, grant, permissions, rule, topic_rule

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

TOPICS = ("rt/a", "rt/*", "rq/aRequest", "rr/aReply", "rt/x/_action/status", "Square", "*", "rt/[ab]?")
DOMAINS = (
    "<id>0</id>",
    "<id>7</id>",
    "<id_range><min>0</min><max>9</max></id_range>",
    "<id_range><min>3</min></id_range>",
)
TAGS = ("allow_rule", "publish", "topic", "domains", "default", "validity", "topic_rule", "dds", "data_protection_kind")
KINDS = ("NONE", "SIGN", "ENCRYPT")
KEYS = (
    "0/a/*/*", "0/a/**", "**", "0/$*b/*/*", "7/a/T::x/RIHS01_ab", "0/@x/**", "a", "r/0/a/*/*", "**/a/**",
    "0/a/*/*/@adv/**", "@ros2_lv/0/**",
)  # fmt: skip
MESSAGES = ("put", "query", "reply", "delete", "declare_subscriber")


def permission_files(choices: Choices) -> dict[str, str | bytes]:
    """A permissions file of one or two grants."""
    grants = []
    for number in range(1 + choices.below(2)):
        rules = [
            rule(
                choices.pick(("allow", "deny")),
                tuple(map(escape, choices.some(TOPICS))),
                tuple(map(escape, choices.some(TOPICS))),
                choices.pick(DOMAINS) if choices.once_in(4) else DOMAINS[0],
            )
            for _ in range(choices.below(3))
        ]
        grants.append(grant(f"/n{number}", *rules, default=choices.pick(("DENY", "ALLOW"))))
    return {"permissions.xml": _damaged(choices, permissions(*grants))}


def governance_files(choices: Choices) -> dict[str, str | bytes]:
    """A governance file of up to two topic rules."""
    rules = [
        topic_rule(
            escape(choices.pick(TOPICS)), choices.pick(("true", "false", "TRUE")), choices.pick(("true", "0")),
            choices.pick(KINDS), choices.pick(KINDS),
        )
        for _ in range(1 + choices.below(2))
    ]  # fmt: skip
    return {"governance.xml": _damaged(choices, governance(*rules, rtps=choices.pick(KINDS)))}


def access_files(choices: Choices) -> dict[str, str | bytes]:
    """A configuration of Zenoh with an access list."""
    rules: list[dict[str, Any]] = [
        {
            "id": f"r{number}",
            "permission": choices.pick(("allow", "deny")),
            "messages": choices.some(MESSAGES, 1),
            "flows": choices.some(("egress", "ingress"), 1),
            "key_exprs": choices.some(KEYS, 1),
        }
        for number in range(1 + choices.below(2))
    ]
    subjects: list[dict[str, Any]] = [{"id": "s"}]
    if choices.once_in(2):
        subjects.append({"id": "t", "usernames": ["u"]})
    access: dict[str, Any] = {
        "enabled": not choices.once_in(5),
        "default_permission": choices.pick(("deny", "allow")),
        "rules": rules,
        "subjects": subjects,
        "policies": [{"rules": [one["id"] for one in rules], "subjects": [one["id"] for one in subjects]}],
    }
    whole = {"mode": "peer", "access_control": access}
    if choices.once_in(4):
        whole["namespace"] = choices.pick(("r", "r/0", "@r", "*", ""))
    if choices.once_in(3):
        whole = with_fault(choices, whole)
    text = json.dumps(whole, ensure_ascii=False, indent=1)
    if choices.once_in(4):
        text = text.replace('"enabled"', "/* x */ enabled", 1)
    return {"node.json5": text.encode("utf-8", "backslashreplace")}


def _damaged(choices: Choices, text: str) -> bytes:
    """The text, now and then with another word, without an element's beginning, or cut."""
    if choices.once_in(4):
        tag = choices.pick(TAGS)
        text = text.replace(f"<{tag}>", f"<{tag}>{escape(choices.pick(ODD_TEXT))}", 1)
    if choices.once_in(6):
        text = text.replace(f"<{choices.pick(TAGS)}>", "", 1)
    data = text.encode("utf-8", "backslashreplace")
    return data[: choices.below(256) * 4] if choices.once_in(8) else data
