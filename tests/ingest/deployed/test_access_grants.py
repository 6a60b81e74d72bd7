"""Whatever passes is granted: grants of random access lists against the decision on each key (rules S5, S11)."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.deployed.access_file import read_access
from rosprivacy.ingest.deployed.zenoh_grants import LEGS, ROLES, keys_of, policy_of
from rosprivacy.ingest.policies.names import covers
from tests.helpers.access_lists import text_of
from tests.helpers.access_oracle import Link, passes

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path
    from typing import Any

    from rosprivacy.analysis.model import Policy

NAMES = ("video", "video/raw", "video/raw/x", "my_video", "voice", "a/video")
OTHERS = ("robot/raw", "robot/raw/x", "ops/0raw", "robot/@cam/raw", "@cam/raw", "raw/@cam")
WIDE = ("robot/*", "robot/**", "*/raw/**", "robot/@cam/**", "*/@cam/*", "$*bot/raw")
LATE = ("*/video/*/*/@adv/**", "0/a/video/*/*/@adv/**", "0/**/@adv/pub/*/*")
Message = tuple[str, str, str]
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
        keys += random.sample(
            [*OTHERS, "robot/*", "robot/**", "*/raw/**", "robot/@cam/**", "*/@cam/*", "$*bot/raw", *LATE], 2
        )
        behind = [f"robot/{key}" if random.random() < 0.3 and key[0] != "@" else key for key in keys]
        right = [key.replace("**/**", "**").replace("**/*/*", "*/*/**") for key in behind]
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


def sent(namespace: str) -> Iterator[tuple[str, str, list[tuple[Message, ...]]]]:
    """(role, DDS topic, what has to pass for one of its messages to be sent or to arrive)."""
    behind = f"{namespace}/" if namespace else ""
    for flow, role in ROLES.items():
        for message, (begins, ends) in LEGS.items():
            for name in NAMES:
                keys = (f"{behind}0/{name}/T::x/RIHS01_ab", f"{behind}0/{name}/T::y/RIHS01_cd")
                yield role, f"{begins}/{name}{ends}", [((flow, message, key),) for key in keys]
            for other in OTHERS:
                if not namespace or other.startswith(behind):
                    yield role, _other(other), [((flow, message, other),)]
        for name in NAMES:  # late joiners
            key, back = f"{behind}0/{name}/T::x/RIHS01_ab", next(one for one in ROLES if one != flow)
            yield role, f"rt/{name}", [((back, "query", f"{key}/@adv/pub/a1/_"), (flow, "reply", key))]


def read(file: Path) -> Policy:
    """In domain 0, beside a session with a namespace."""
    access = read_access(str(file))
    return policy_of(access, keys_of(access, 0, ["robot"]))


def _other(key: str) -> str:
    return f"zenoh{'@' * ('@' in key)}/{key}"


def granted(policy: Policy, role: str, dds: str) -> bool:
    said = {one.allow for one in policy.grants if one.role == role and covers(one.name, dds)}
    return said == {True}


@pytest.mark.parametrize(
    "seeds",
    [
        range(10),
        pytest.param(range(10, 100), marks=pytest.mark.slow),
        pytest.param(range(100, 300), marks=pytest.mark.thorough),
    ],
)
def test_whatever_passes_is_granted(seeds: range, tmp_path: Path) -> None:
    """And little else: what a grant has too much is told, or narrower than a channel."""
    file, counted = tmp_path / "node.json5", {(True, True): 0, (False, True): 0, (False, False): 0}
    for seed in seeds:
        random = Random(seed)  # noqa: S311 - repeatable
        namespace = random.choice(["", "", "robot"])
        file.write_text(text_of(access_list(random), namespace), "utf-8")
        access = read_access(str(file))
        policy = read(file)
        for role, dds, ways in sent(namespace):
            through = any(all(passes(access, link, *one) for one in way) for link in LINKS for way in ways)
            ours = granted(policy, role, dds)
            assert ours or not through, (file.read_text("utf-8"), role, dds, ways)
            if len(ways[0]) == 1:  # the messages themselves are granted by other lines too
                counted[through, ours] += 1
    assert counted[False, False] > 2 * counted[False, True]


@pytest.mark.parametrize(
    ("key", "names"),
    [
        ("robot/0/video/*/*", {"rt/video"}),
        ("0/video/T/RIHS01_ab/@adv/**", set()),  # numbers
        ("0/@adv/**", {"zenoh@/0/@adv", "zenoh@/0/@adv/*"}),
        ("0", {"zenoh/0"}),
        ("0/a/b", {"rt/a/b"}),
        ("@ros2_lv/0/**", {"zenoh@/@ros2_lv/0", "zenoh@/@ros2_lv/0/*"}),
        ("7/video/*/*", set()),
    ],
)
def test_each_key_has_a_channel(key: str, names: set[str], tmp_path: Path) -> None:
    """What is no key of ROS is a channel with the name of its key."""
    assert {grant.name for grant in one_rule(tmp_path, key, "put").grants} == names


def one_rule(folder: Path, key: str, message: str, namespace: str = "") -> Policy:
    rule = {"id": "r", "permission": "allow", "messages": [message], "key_exprs": [key]}
    lists = {"rules": [rule], "subjects": [{"id": "s"}], "policies": [{"rules": ["r"], "subjects": ["s"]}]}
    file = folder / "node.json5"
    file.write_text(text_of({"enabled": True, **lists}, namespace), "utf-8")
    return read(file)


def test_replies_about_tokens_carry_no_data_and_a_session_has_no_keys_without_its_namespace(tmp_path: Path) -> None:
    """Every session of rmw_zenoh needs such replies; as measured, rules are matched with the namespace before."""
    assert not one_rule(tmp_path, "@ros2_lv/0/**", "reply").grants
    policy = one_rule(tmp_path, "0/video/*/*", "put", "robot")
    assert not policy.grants
    assert any("they begin with its namespace 'robot'" in one.message for one in policy.diagnostics)
