"""Random access lists of Zenoh."""

from __future__ import annotations

import json
from random import Random
from typing import Any

import zenoh

CHUNKS = ("a", "b", "ab", "ba", "aab", "@a", "a@")
WILD = ("*", "**", "a$*", "$*b", "a$*b", "$*a$*", "@$*", "$*ab$*")
SUBJECTS: tuple[dict[str, list[str]], ...] = (  # what the other end of a link on loopback is, and is not
    {},
    {"link_protocols": ["tcp"]},
    {"link_protocols": ["udp"]},
    {"link_protocols": ["udp", "tcp"]},
    {"interfaces": ["lo"]},
    {"interfaces": ["not_there"]},
    {"interfaces": ["lo"], "link_protocols": ["tcp"]},
    {"interfaces": ["lo"], "link_protocols": ["udp"]},
    {"usernames": ["nobody"]},
)
MESSAGES = ("put", "delete")
KEYS = tuple(dict.fromkeys("/".join(Random(seed).choices(CHUNKS, k=1 + seed % 3)) for seed in range(60)))  # noqa: S311 - repeatable


def expression(random: Random) -> str:
    """A key expression that Zenoh takes."""
    while True:
        one = "/".join(random.choices(CHUNKS + WILD, k=random.randint(1, 4)))
        try:
            zenoh.KeyExpr(one)
        except zenoh.ZError:
            continue
        return one


def access_list(random: Random) -> dict[str, Any]:
    """An access list; each of its subjects may declare a subscriber of each key."""
    declared = {"id": "declared", "permission": "allow", "messages": ["declare_subscriber"], "key_exprs": [*KEYS]}
    rules = [declared, *(_rule(random, f"r{number}") for number in range(random.randint(1, 6)))]
    subjects = [{"id": f"s{number}", **random.choice(SUBJECTS)} for number in range(random.randint(1, 3))]
    ids = [str(subject["id"]) for subject in subjects]
    policies = [{"rules": ["declared"], "subjects": ids}]
    for _ in range(random.randint(1, 3)):
        some = random.sample([rule["id"] for rule in rules], random.randint(1, len(rules)))
        policies.append({"rules": some, "subjects": random.sample(ids, random.randint(1, len(ids)))})
    return {
        "enabled": random.random() < 0.95,
        "default_permission": random.choice(["allow", "deny"]),
        "rules": rules,
        "subjects": subjects,
        "policies": policies if random.random() < 0.95 else [],
    }


def _rule(random: Random, name: str) -> dict[str, Any]:
    rule = {
        "id": name,
        "permission": random.choice(["allow", "deny"]),
        "messages": random.sample(MESSAGES, random.randint(1, 2)),
        "key_exprs": [expression(random) for _ in range(random.randint(1, 4))],
    }
    flows = random.choice([[], ["egress"], ["ingress"], ["egress", "ingress"]])
    return {**rule, "flows": flows} if flows else rule


def text_of(access: dict[str, Any], namespace: str = "") -> str:
    """A configuration with comments, as people write it."""
    space = f"namespace: '{namespace}', " if namespace else ""
    section = json.dumps(access, indent=1)
    return f"// of one session\n{{ mode: 'client', {space}access_control: /* ours */ {section}, }}\n"
