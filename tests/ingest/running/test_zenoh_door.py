"""Liveliness tokens behind a real Zenoh router: what is declared is what is seen, and nothing of ours is declared."""

from __future__ import annotations

import json
import struct
import time
from typing import TYPE_CHECKING

import pytest
import zenoh.ext

from rosprivacy.analysis.errors import MiddlewareError, ObservationError
from rosprivacy.ingest.policies.observed_metadata import HIDDEN, REFUSED, STILL_CHANGING
from rosprivacy.ingest.running.observation import DDS_TYPE, Declared
from rosprivacy.ingest.running.zenoh_door import ZenohDoor
from rosprivacy.observing import now
from tests.helpers.zenoh_tokens import HASH, endpoint, free_endpoint, node, router, session

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from rosprivacy.ingest.running.observation import Observation

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("zenoh")]
IMAGE, TRIGGER = "sensor_msgs::msg::dds_::Image_", "std_srvs::srv::dds_::Trigger_"
DOMAIN = 3


@pytest.fixture(scope="module")
def where() -> Iterator[str]:
    with router() as one:
        yield one


def looked(where: str, seconds: float = 2, domain: int = DOMAIN) -> Observation:
    *_, last = ZenohDoor(now, domain, where).looks(seconds)
    return last


def test_what_is_declared_is_what_is_seen(where: str) -> None:
    with session(where) as one:
        tokens = [
            node(DOMAIN, "camera", "%robot%head"),
            endpoint(DOMAIN, "MP", "camera", "/camera/image_raw", IMAGE, enclave="%robot%head"),
            endpoint(DOMAIN, "SS", "camera", "/save", TRIGGER, enclave="%robot%head"),
            endpoint(DOMAIN, "MS", "viewer", "/camera/image_raw", IMAGE, space="%ui", hashed="TypeHashNotSupported"),
            endpoint(DOMAIN, "SC", "viewer", "/save", TRIGGER, space="%ui", after="/backends:cuda:a%253Bb"),
            node(DOMAIN + 1, "of_another_domain"),
        ]
        kept = [one.liveliness().declare_token(token) for token in tokens]
        seen = looked(where)
        assert kept
    assert {(node.name, node.enclave) for node in seen.nodes} == {("/camera", "/robot/head"), ("/ui/viewer", "")}
    assert {(one.node, one.role, one.name, one.type, one.hash) for one in seen.endpoints} == {
        ("/camera", "publish", "/camera/image_raw", "sensor_msgs/msg/Image", HASH),
        ("/camera", "reply", "/save", "std_srvs/srv/Trigger", HASH),
        ("/ui/viewer", "subscribe", "/camera/image_raw", "sensor_msgs/msg/Image", ""),
        ("/ui/viewer", "request", "/save", "std_srvs/srv/Trigger", HASH),
    }
    assert (seen.doors, seen.domains, seen.all_gaps, seen.remarks) == (("zenoh",), (DOMAIN,), {}, ())


def test_nothing_of_ours_is_declared(where: str) -> None:
    """``ros2 node list`` asks for the same tokens as we do."""
    with session(where) as one:
        told: list[str] = []
        watched = one.liveliness().declare_subscriber("@ros2_lv/**", lambda sample: told.append(str(sample.key_expr)))
        looked(where)
        watched.undeclare()
    assert told == []


def test_empty_and_connected_says_what_it_can_mean(where: str) -> None:
    seen = looked(where, domain=99)
    assert (bool(seen), seen.all_gaps) == (False, {HIDDEN: 1})
    assert "nothing runs in it, or the access list of the router does not let us look" in seen.remarks[0]


def test_behind_an_access_list_the_answer_is_empty_and_says_so() -> None:
    every = ["put", "delete", "declare_subscriber", "query", "declare_queryable", "reply"]
    allowed = {
        "id": "data",
        "messages": every,
        "flows": ["egress", "ingress"],
        "permission": "allow",
        "key_exprs": ["**"],
    }
    listed = {
        "enabled": True,
        "default_permission": "deny",
        "rules": [allowed],
        "subjects": [{"id": "all"}],
        "policies": [{"rules": ["data"], "subjects": ["all"]}],
    }
    with router(access_control=listed) as guarded, session(guarded) as one:
        kept = one.liveliness().declare_token(node(DOMAIN, "camera"))
        assert looked(guarded).all_gaps == {HIDDEN: 1}
        kept.undeclare()


def test_without_a_router_one_line_says_what_to_do() -> None:
    with pytest.raises(MiddlewareError) as error:
        looked(free_endpoint(), 1)
    assert str(error.value).startswith("no Zenoh router answers at tcp/127.0.0.1:")
    assert "\n" not in str(error.value)
    assert "(--zenoh tcp/HOST:7447)" in str(error.value)
    assert "certificates" not in str(error.value)


@pytest.mark.parametrize("endpoint_", ["rubbish", "tcp/", "robot.policy.xml"])
def test_what_is_no_endpoint_is_one_line(endpoint_: str) -> None:
    with pytest.raises(ObservationError) as error:
        looked(endpoint_, 1)
    assert str(error.value).startswith(f"--zenoh: '{endpoint_}' is no endpoint of Zenoh; write tcp/localhost:7447")
    assert "\n" not in str(error.value)


def test_a_session_file_of_the_user_is_taken(where: str, tmp_path: Path) -> None:
    file = tmp_path / "session.json5"
    file.write_text("// mine\n" + json.dumps({"mode": "peer", "connect": {"endpoints": [where]}}))
    with session(where) as one:
        kept = one.liveliness().declare_token(node(DOMAIN, "camera"))
        *_, seen = ZenohDoor(now, DOMAIN, "", file).looks(2)
        kept.undeclare()
    assert [node.name for node in seen.nodes] == ["/camera"]


@pytest.mark.parametrize("text", ["{", '{"no_such_key": 1}', ""])
def test_a_session_file_that_is_none_is_one_line(text: str, tmp_path: Path) -> None:
    file = tmp_path / "session.json5"
    file.write_text(text)
    with pytest.raises(ObservationError) as error:
        list(ZenohDoor(now, DOMAIN, "", file).looks(1))
    assert str(error.value).startswith(f"{file}: Zenoh does not accept it")
    assert "\n" not in str(error.value)


def test_tokens_that_are_none_are_told_and_the_others_kept(where: str) -> None:
    hostile = [
        f"@ros2_lv/{DOMAIN}/aa/0/7/XX/%/%/n",
        f"@ros2_lv/{DOMAIN}/aa",
        f"@ros2_lv/{DOMAIN}/aa/0/8/MP/%/%/n/%topic",
        endpoint(DOMAIN, "MP", "n", "/</topic>&\x1b[31m", "no::type"),
        node(DOMAIN, "n" * 4_000),
    ]
    with session(where) as one:
        kept = [one.liveliness().declare_token(token) for token in [*hostile, node(DOMAIN, "good")]]
        seen = looked(where)
        assert kept
    assert seen.all_gaps == {REFUSED: 3}
    assert {"/good", "/" + "n" * 4_000} <= {node.name for node in seen.nodes}
    assert not [remark for remark in seen.remarks if "\x1b" in remark]


def test_who_comes_and_who_leaves_is_told_and_late_comers_make_it_still_changing(where: str) -> None:
    with session(where) as one:
        looks = ZenohDoor(now, DOMAIN, where).looks(30)
        kept = one.liveliness().declare_token(node(DOMAIN, "first"))
        _until(looks, lambda seen: [node.name for node in seen.nodes] == ["/first"])
        kept.undeclare()
        begun = time.monotonic()
        _until(looks, lambda seen: not seen.nodes)
        assert time.monotonic() - begun < 20  # and not when the looks end; a loaded machine may take some
        short = ZenohDoor(now, DOMAIN, where).looks(0.6)
        kept = one.liveliness().declare_token(node(DOMAIN, "late"))
        *_, last = short
        kept.undeclare()
    assert last.all_gaps == {STILL_CHANGING: 1}


def _until(looks: Iterator[Observation], holds: Callable[[Observation], bool]) -> None:
    assert any(holds(seen) for seen in looks)


def test_what_nodes_declare_of_themselves_is_heard_also_if_they_said_it_before(where: str) -> None:
    texts = ("/head/camera", "the camera in the head", "to greet people by name", "")
    payload = b"\0\1\0\0"
    for text in texts:
        payload += b"\0" * (-(len(payload) - 4) % 4) + struct.pack("<I", len(text) + 1) + text.encode() + b"\0"
    key = f"{DOMAIN}/greeter/processing/{DDS_TYPE}/{HASH}"
    with session(where) as one:
        kept = one.liveliness().declare_token(node(DOMAIN, "greeter"))
        latched = zenoh.ext.declare_advanced_publisher(
            one, key, cache=zenoh.ext.CacheConfig(1), publisher_detection=True
        )
        latched.put(payload)
        seen = looked(where)
        latched.undeclare()  # type: ignore[no-untyped-call]
        kept.undeclare()
    assert seen.declared == (Declared("/greeter/processing", *texts),)


def test_two_thousand_topics_are_all_seen(where: str) -> None:
    with session(where) as one:
        tokens = [endpoint(DOMAIN, "MP", "many", f"/part{n}/value", IMAGE) for n in range(2_000)]
        kept = [one.liveliness().declare_token(token) for token in tokens]
        seen = looked(where, 6)
        assert kept
    assert {one.name for one in seen.endpoints} == {f"/part{n}/value" for n in range(2_000)}
