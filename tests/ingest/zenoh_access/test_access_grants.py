"""Whatever passes is granted: grants of random access lists against the decision on each key (rules S5, S11)."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.policies.names import covers
from rosprivacy.ingest.zenoh_access.access_decision import Link, passes
from rosprivacy.ingest.zenoh_access.access_file import read_access
from rosprivacy.ingest.zenoh_access.access_grants import LEGS, ROLES, policy_of
from tests.helpers.access_lists import text_of

if TYPE_CHECKING:
    from pathlib import Path
    from typing import Any

    from rosprivacy.analysis.model import Policy

NAMES = ("video", "video/raw", "video/raw/x", "my_video", "voice", "a/video")
CHUNKS = ("0", "0", "*", "**", "video", "raw", "my_video", "$*video", "T::x", "*", "*", "RIHS01_ab", "voice", "a")
LINKS = (Link(), Link(link_protocols=frozenset({"tcp"})), Link(usernames=frozenset({"ann"})))


def access_list(random: Random) -> dict[str, Any]:
    rules: list[dict[str, Any]] = []
    for number in range(random.randint(1, 5)):
        keys = []
        for _ in range(random.randint(1, 3)):
            name = random.choice((*NAMES, "*", "**", "$*video", "video/**"))
            keys.append(
                random.choice((f"0/{name}/*/*", f"0/{name}/**", f"*/{name}/T::x/*", f"0/{name}/T::x/RIHS01_ab"))
            )
        right = [key.replace("**/**", "**").replace("**/*/*", "*/*/**") for key in keys]
        rule = {"id": f"r{number}", "permission": random.choice(["allow", "deny"]), "key_exprs": right}
        rules.append({**rule, "messages": random.sample([*LEGS], 2), "flows": random.choice([["egress"], [*ROLES]])})
    known: list[dict[str, Any]] = [
        {"id": "s"},
        {"id": "t", "link_protocols": ["tcp"]},
        {"id": "u", "usernames": ["ann"]},
    ]
    subjects = random.sample(known, random.randint(1, 3))
    policies = [
        {"rules": [random.choice(rules)["id"]], "subjects": [random.choice(subjects)["id"]]}
        for _ in range(random.randint(1, 6))
    ]
    return {
        "enabled": random.random() < 0.95,
        "default_permission": random.choice(["allow", "deny"]),
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


def granted(policy: Policy, flow: str, dds: str) -> bool:
    said = {one.allow for one in policy.grants if one.role == ROLES[flow] and covers(one.name, dds)}
    return said == {True}


@pytest.mark.parametrize("seeds", [range(60), pytest.param(range(60, 400), marks=pytest.mark.slow)])
def test_whatever_passes_is_granted(seeds: range, tmp_path: Path) -> None:
    """And little else: what a grant has too much is told, or narrower than a channel."""
    file, counted = tmp_path / "node.json5", {(True, True): 0, (False, True): 0, (False, False): 0}
    for seed in seeds:
        file.write_text(text_of(access_list(Random(seed))), "utf-8")  # noqa: S311 - repeatable
        access = read_access(str(file))
        policy = policy_of(access, 0)
        for flow in ROLES:
            for message, (begins, ends) in LEGS.items():
                for name in NAMES:
                    keys = (f"0/{name}/T::x/RIHS01_ab", f"0/{name}/T::y/RIHS01_cd")
                    through = any(passes(access, link, flow, message, key) for link in LINKS for key in keys)
                    ours = granted(policy, flow, f"{begins}/{name}{ends}")
                    assert ours or not through, (file.read_text("utf-8"), flow, message, name)
                    counted[through, ours] += 1
    assert counted[False, False] > 2 * counted[False, True]


@pytest.mark.parametrize("key", ["robot/0/video/*/*", "0/@adv/**", "0", "0/a/b"])
def test_what_is_no_key_of_ros_is_told(key: str, tmp_path: Path) -> None:
    rule = {"id": "r", "permission": "allow", "messages": ["put"], "key_exprs": [key]}
    lists = {"rules": [rule], "subjects": [{"id": "s"}], "policies": [{"rules": ["r"], "subjects": ["s"]}]}
    file = tmp_path / "node.json5"
    file.write_text(text_of({"enabled": True, **lists}), "utf-8")
    policy = policy_of(read_access(str(file)), 0)
    assert not policy.grants
    assert [one.message for one in policy.diagnostics if "is not read" in one.message]
