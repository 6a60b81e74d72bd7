"""Key expressions and decisions against the real thing: ``eclipse-zenoh``, a router and sessions on loopback."""

from __future__ import annotations

import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from random import Random
from typing import TYPE_CHECKING

import pytest
import zenoh
from zenoh import ext

from rosprivacy.ingest.deployed.access_file import MESSAGES, read_access
from rosprivacy.ingest.deployed.zenoh_grants import keys_of, policy_of
from rosprivacy.ingest.deployed.zenoh_keys import includes, problem_of
from rosprivacy.ingest.policies.names import covers
from tests.helpers.access_lists import access_list, expression, text_of
from tests.helpers.access_messages import IN, OF, OUT, THROUGH, exchanged, with_all_messages
from tests.helpers.access_oracle import Link, passes
from tests.helpers.zenoh_tokens import router, session

if TYPE_CHECKING:
    from pathlib import Path
    from typing import Any

    from rosprivacy.ingest.deployed.access_file import AccessFile

pytestmark = pytest.mark.xdist_group("zenoh")
LOOPBACK = Link(interfaces=frozenset({"lo"}), link_protocols=frozenset({"tcp"}))


def test_expressions_are_those_that_zenoh_takes() -> None:
    random, taken = Random(20), Counter[bool]()  # noqa: S311 - repeatable
    for _ in range(20_000):
        written = "".join(random.choices("ab/*$@#? ", (3, 3, 4, 4, 2, 1, 1, 1, 1), k=random.randint(0, 7)))
        try:
            zenoh.KeyExpr(written)
        except zenoh.ZError:
            right = False
        else:
            right = True
        assert right == (problem_of(written) is None), written
        taken[right] += 1
    assert min(taken.values()) > 1000


def test_expressions_include_others_as_those_of_zenoh() -> None:
    random, said = Random(5), Counter[bool]()  # noqa: S311 - repeatable
    pool = [expression(random) for _ in range(2000)]
    parsed = {one: zenoh.KeyExpr(one) for one in pool}
    for _ in range(40_000):
        one, other = random.choice(pool), random.choice(pool)
        theirs = parsed[one].includes(parsed[other])
        assert includes(one, other) == theirs, (one, other)
        said[theirs] += 1
    assert min(said.values()) > 200


def through(access: AccessFile, needed: dict[str, str]) -> set[tuple[str, str]]:
    """What passes, as we say it: each message that something needs."""
    return {
        (what, key)
        for what, needs in needed.items()
        for key in OF[what]
        if all(passes(access, LOOPBACK, flow, message, key) for flow, message in map(str.split, needs.split(", ")))
    }


def compared(folder: Path, seed: int) -> Counter[str]:
    """Put an access list to Zenoh, of a session or of each fourth time of a router; counts of what passed and not."""
    said, random = Counter[str](), Random(seed)  # noqa: S311 - repeatable
    written = with_all_messages(random, access_list(random))
    file = folder / f"{seed}.json5"
    file.write_text(text_of(written), "utf-8")
    access = read_access(str(file))
    at_router = seed % 4 == 0
    off = {"enabled": False}
    with (
        router(access_control=written if at_router else off) as where,
        session(where) as free,
        session(where, access_control=off if at_router else written) as held,
    ):
        for way, sender, receiver, needed in (("out", held, free, OUT), ("in", free, held, IN)):
            ours = through(access, THROUGH if at_router else needed)
            theirs = exchanged(sender, receiver, ours, f"{seed} {way}")
            assert theirs == ours, (sorted(theirs ^ ours), file.read_text("utf-8"), way, at_router)
            for what in needed:
                number = len([one for one in ours if one[0] == what])
                said[f"{way} {what} passes"] += number
                said[f"{way} {what} does not"] += len(OF[what]) - number
    return said


def test_what_gets_through_is_what_we_say(tmp_path: Path) -> None:
    with ThreadPoolExecutor(2) as both:
        assert all(both.map(lambda seed: compared(tmp_path, seed), (400, 401, 402)))


@pytest.mark.slow
def test_what_gets_through_many_lists_is_what_we_say(tmp_path: Path, *, thorough: bool) -> None:
    """Data, queries, replies, declarations and liveliness, on lists of sessions and of routers."""
    seeds = range(500, 720 if thorough else 560)
    with ThreadPoolExecutor(4) as several:  # most of the time is waiting
        said = sum(several.map(lambda seed: compared(tmp_path, seed), seeds), Counter[str]())
    assert len(said) == 4 * len(OUT)
    assert min(said.values()) > (100 if thorough else 25), said


def listed(file: Path, default: str, *rules: tuple[str, list[str], str, str], namespace: str = "") -> dict[str, Any]:
    """An access list of (permission, messages, flow, key expression), written to a file too."""
    named = [
        {"id": f"r{at}", "permission": may, "messages": messages, "flows": [flow], "key_exprs": [key]}
        for at, (may, messages, flow, key) in enumerate(rules)
    ]
    policies = [{"rules": [str(one["id"]) for one in named], "subjects": ["s"]}]
    access = {"enabled": True, "default_permission": default, "rules": named, "subjects": [{"id": "s"}]}
    access["policies"] = policies
    file.write_text(text_of(access, namespace), "utf-8")
    return access


KEY, LATE = "0/map/T/RIHS01_ab", "0/map/*/*/@adv/**"
DENY_PUT = ("deny", ["put"], "egress", "0/map/**")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("default", "rules", "gets"),
    [
        ("allow", [DENY_PUT], True),
        ("allow", [("deny", ["put", "reply"], "egress", "0/map/**")], False),
        ("allow", [DENY_PUT, ("deny", ["reply"], "egress", LATE)], True),
        ("deny", [("allow", ["reply", "put"], "egress", "0/map/*/*"), ("deny", ["put"], "egress", "0/map/**")], False),
        ("deny", [("allow", ["reply"], "egress", "0/map/*/*"), ("allow", [*MESSAGES], "ingress", LATE),
                  ("allow", ["declare_queryable", "liveliness_token"], "egress", LATE)], True),
    ],
)  # fmt: skip
def test_a_late_joiner_gets_what_a_deny_of_put_does_not_stop(
    tmp_path: Path, default: str, rules: list[tuple[str, list[str], str, str]], *, gets: bool
) -> None:
    """It asks for what it missed, as rmw_zenoh does of publishers that keep their messages."""
    file, got = tmp_path / "node.json5", list[str]()
    access = listed(file, default, *rules)
    with router() as where, session(where) as free, session(where, access_control=access) as held:
        kept = ext.declare_advanced_publisher(held, KEY, cache=ext.CacheConfig(max_samples=1), publisher_detection=True)
        kept.put(b"")
        time.sleep(0.2)
        history = ext.HistoryConfig(detect_late_publishers=True)
        late = ext.declare_advanced_subscriber(
            free, KEY, lambda sample: got.append(str(sample.key_expr)), history=history
        )
        time.sleep(0.5)
        del late
    assert got == [KEY] * gets
    read = read_access(str(file))
    lines = [one for one in policy_of(read, keys_of(read, 0, [])).grants if covers(one.name, "rt/map")]
    assert ({one.allow for one in lines if one.role == "publish"} == {True}) == gets


@pytest.mark.slow
@pytest.mark.parametrize(
    ("key", "through"), [("0/video/**", False), ("robot/0/video/**", True), ("*/0/video/**", True)]
)
def test_rules_are_about_keys_behind_the_namespace(tmp_path: Path, key: str, *, through: bool) -> None:
    file, heard_of = tmp_path / "node.json5", list[str]()
    access = listed(file, "deny", ("allow", ["put"], "egress", key), namespace="robot")
    with router() as where, session(where) as free:
        kept = free.declare_subscriber("**", lambda sample: heard_of.append(str(sample.key_expr)))
        with session(where, access_control=access, namespace="robot") as held:
            time.sleep(0.2)
            held.put("0/video/T/RIHS01_ab", b"")
            time.sleep(0.3)
        kept.undeclare()
    assert heard_of == ["robot/0/video/T/RIHS01_ab"] * through
    read = read_access(str(file))
    assert any(covers(one.name, "rt/video") for one in policy_of(read, keys_of(read, 0, [])).grants) == through
