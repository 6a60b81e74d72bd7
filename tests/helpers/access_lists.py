"""Random access lists of Zenoh, and what two sessions on loopback hear of each other."""

from __future__ import annotations

import json
import time
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

Samples = set[tuple[str, str]]
"""(message, key)."""


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


def heard(sender: Any, receiver: Any, expected: Samples, mark: str) -> Samples:
    """What a session hears when the other one puts and deletes every key, until all that is expected is there.

    Parameters
    ----------
    mark
        What these messages carry, so that no others are taken for them.
    """
    samples: Samples = set()

    def hear(sample: Any) -> None:
        if sample.attachment and sample.attachment.to_string() == mark:
            samples.add(("put" if sample.kind == zenoh.SampleKind.PUT else "delete", str(sample.key_expr)))

    kept = [receiver.declare_subscriber(key, hear, allowed_origin=zenoh.Locality.REMOTE) for key in KEYS]
    time.sleep(0.05)  # until the subscribers are known, or else it is asked again
    end = time.monotonic() + 10
    _send(sender, mark)
    while not expected <= samples and time.monotonic() < end:
        time.sleep(0.02)
        _send(sender, mark)
    _send(sender, mark)  # now that subscribers are known, whatever else could come
    time.sleep(0.1)
    for one in kept:
        one.undeclare()
    return set(samples)


def _send(sender: Any, mark: str) -> None:
    for key in KEYS:
        sender.put(key, b"", attachment=mark)
        sender.delete(key, attachment=mark)
