"""The channels of a key expression are those with whose keys Zenoh says that it has one in common (rule S4)."""

from __future__ import annotations

from collections import Counter
from random import Random
from typing import TYPE_CHECKING

import pytest
import zenoh

from rosprivacy.ingest.deployed.zenoh_keys import HISTORY, MESSAGES, OTHERS, TOKENS, Keys, channels
from rosprivacy.ingest.policies.names import covers

if TYPE_CHECKING:
    from collections.abc import Iterator

NAMESPACES = ("", "robot", "fleet/r1", "@r")
NAMES = ("video", "video/raw", "my_video", "a/video")
TYPES = ("T::x/RIHS01_ab", "T::y/RIHS01_cd")
OTHER_KEYS = ("robot/raw", "@r/@cam", "ops/video/raw", "@r/raw", "robot/@cam/raw", "ops/@cam", "0/@adv/video")
CHUNKS = ("0", "0", "7", "video", "raw", "my_video", "a", "robot", "fleet", "r1", "ops", "@r", "@cam", "T::x")
WILD = ("*", "*", "**", "**", "$*video", "$*bot", "@adv", "RIHS01_ab", "@ros2_lv")


def written(random: Random) -> str:
    """A key expression that Zenoh takes: one of a channel in which something is wider, or any."""
    while True:
        if random.random() < 0.2:
            chunks = random.choices(CHUNKS + WILD, k=random.randint(1, 7))
        else:
            ending = random.choice(("*/*", "**", "T::x/*", "*/*/@adv/**", "T::x/RIHS01_ab/@adv/pub/*/*"))
            before = random.choice((*NAMESPACES, "*", "**", "fleet/*", "$*bot"))
            key = f"{before}/{random.choice('000*7')}/{random.choice((*NAMES, '*', '**', '$*video'))}/{ending}"
            chunks = (
                (key if random.random() < 0.8 else random.choice((*OTHER_KEYS, "@ros2_lv/0/**", "@ros2_lv/7/**")))
                .strip("/")
                .split("/")
            )
            if random.random() < 0.4:
                chunks[random.randrange(len(chunks))] = random.choice(WILD)
        one = "/".join(chunks)
        try:
            zenoh.KeyExpr(one)
        except zenoh.ZError:
            continue
        return one


def names(keys: Keys, space: str) -> Iterator[tuple[str, str, list[str]]]:
    """(what, name of a channel, keys that it has behind a namespace)."""
    before = f"{space}/" if space else ""
    for name in NAMES:
        yield MESSAGES, f"/{name}", [f"{before}0/{name}/{type_}" for type_ in TYPES]
        yield HISTORY, f"/{name}", [f"{before}0/{name}/{type_}/@adv/pub/a1/_" for type_ in TYPES]
    if space == keys.namespaces[0]:
        for key in OTHER_KEYS:
            if key.startswith(before):
                yield OTHERS, f"zenoh{'@' * ('@' in key)}/{key}", [key]
    if not space:
        yield TOKENS, "zenoh@/@ros2_lv/0/a/0/0/NN/%/%/camera", ["@ros2_lv/0/a/0/0/NN/%/%/camera"]


@pytest.mark.slow
@pytest.mark.parametrize("spaces", [("",), ("robot",), ("@r",), ("", "robot", "fleet/r1", "@r")])
def test_channels_are_those_whose_keys_zenoh_says_an_expression_has(spaces: tuple[str, ...]) -> None:
    """And with ``whole`` it includes all keys that such a channel has, as a DENY has to (rule S5)."""
    random, counted = Random(str(spaces)), Counter[tuple[str, bool, bool]]()  # noqa: S311 - repeatable
    keys = Keys("0", spaces)
    for _ in range(4000):
        expression = written(random)
        theirs, ours = zenoh.KeyExpr(expression), list(channels(expression, keys))
        for space in spaces:
            for what, name, of_it in names(keys, space):
                said = [one for one in ours if one.sort == what and any(covers(had, name) for had in one.names)]
                meets = any(theirs.intersects(zenoh.KeyExpr(key)) for key in of_it)
                assert said or not meets, (expression, of_it, ours)
                if any(one.whole for one in said):
                    assert all(theirs.includes(zenoh.KeyExpr(key)) for key in of_it), (expression, of_it)
                counted[what, meets, bool(said)] += 1
    for what in {kind for kind, _, _ in counted}:
        assert counted[what, True, True] > 10, counted
        assert counted[what, False, False] > counted[what, False, True], counted
