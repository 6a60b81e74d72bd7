"""What an earlier run wrote is an observation again: nothing of it is lost when others add to it (S16)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.running.observation import Observation, ObservedNode, Span, added_up
from rosprivacy.ingest.running.observed_files import EarlierFiles, policy_xml, prepared, types_yaml
from rosprivacy.observing import declared_file
from tests.helpers.command import Cli, refused
from tests.helpers.observed import AT, at, endpoint, looked, node_info, saw

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.running.observation import ObservedEndpoint

IMAGE, BOOL = "sensor_msgs/msg/Image", "std_msgs/msg/Bool"


def written(folder: Path, seen: Observation, name: str = "robot") -> tuple[str, str]:
    ready = prepared(seen)
    policy, types = folder / f"{name}.policy.xml", folder / f"{name}.types.yaml"
    policy.write_bytes(policy_xml(ready))
    types.write_text(types_yaml(ready.observation), "utf-8")
    return str(policy), str(types)


def again(*files: tuple[str, str]) -> Observation:
    (seen,) = EarlierFiles(files).looks()
    return seen


def seen_whole(*endpoints: ObservedEndpoint, **gaps: int) -> Observation:
    """Endpoints, and the nodes that they are of, as a door tells them."""
    names = sorted({one.node for one in endpoints if one.node})
    return replace(
        saw(*endpoints, door="text", **gaps), nodes=tuple(ObservedNode(name, Span(AT, AT)) for name in names)
    )


def texts(seen: Observation) -> tuple[bytes, str]:
    ready = prepared(seen)
    return policy_xml(ready), types_yaml(ready.observation)


def full() -> Observation:
    """Everything that an observation can say."""
    seen = seen_whole(
        endpoint("/cam", "publish", "/image", IMAGE, hash="RIHS01_" + "ab" * 32, key="1"),
        endpoint("/cam", "reply", "/save", "std_srvs/srv/Trigger", key="2"),
        endpoint("/ui", "call", "/spin", "nav2_msgs/action/Spin", key="3"),
        endpoint("/ui", "subscribe", "/image", key="4"),
        endpoint("", "subscribe", "/image", IMAGE, key="5", participant="010f"),
        endpoint("/launch_ros_4711", "publish", "/log", BOOL, key="6"),
        still_changing=1,
        refused=3,
    )
    nodes = (
        *seen.nodes,
        ObservedNode("/cam", Span(AT, AT), "/robot/head"),
        ObservedNode("/cam", Span(AT, AT), "/robot/spare"),
        ObservedNode("/idle", Span(AT, AT)),
    )
    return replace(seen, nodes=nodes, domains=(0, 3))


def test_what_was_written_is_written_again_as_it_was(tmp_path: Path) -> None:
    files = written(tmp_path, full())
    assert texts(again(files)) == texts(full())


NODES, CHANNELS = ("/a", "/b/c", ""), ("/x", "/y/z")
ENDPOINTS = st.builds(
    lambda node, role, name, kind, participant: endpoint(
        node, role, name, kind, key=f"{node}{role}{name}{kind}{participant}", participant="" if node else participant
    ),
    st.sampled_from(NODES),
    st.sampled_from(["publish", "subscribe", "reply", "request", "call", "execute"]),
    st.sampled_from(CHANNELS),
    st.sampled_from(["", IMAGE, BOOL]),
    st.sampled_from(["0a", "0b"]),
)


@pytest.mark.slow
@given(st.lists(ENDPOINTS, min_size=1, max_size=8), st.lists(ENDPOINTS, min_size=1, max_size=8))
@settings(deadline=None, max_examples=40)
def test_to_add_to_what_was_written_is_to_have_seen_both(
    tmp_path_factory: pytest.TempPathFactory, first: list[ObservedEndpoint], second: list[ObservedEndpoint]
) -> None:
    """Beside names that a program makes up: two of one time are never folded (see below)."""
    folder = tmp_path_factory.mktemp("robot")
    files = written(folder, seen_whole(*first))
    assert texts(added_up((again(files), seen_whole(*second)))) == texts(seen_whole(*first, *second))


def test_a_name_that_was_folded_stays_folded_with_what_it_was(tmp_path: Path) -> None:
    earlier = again(written(tmp_path, looked("/launch_ros_1", "/cam", last=1)))
    ready = prepared(added_up((earlier, looked("/launch_ros_2", first=5, last=6))))
    ((name, names),) = [(one.name, one.names) for one in ready.folded]
    assert (name, names) == ("/launch_ros", ("/launch_ros_1", "/launch_ros_2"))
    assert set(ready.enclaves) == {"/launch_ros", "/cam"}
    assert (ready.observation.span.first, ready.observation.span.last) == (at(0), at(6))


def test_without_the_types_beside_it_none_are_known_and_that_is_said(tmp_path: Path) -> None:
    """S15: a writer with an unknown type, so nothing is limited."""
    policy, types = written(tmp_path, full())
    (tmp_path / "robot.types.yaml").unlink()
    seen = again((policy, types))
    assert {one.type for one in seen.endpoints} == {""}
    assert [remark for remark in seen.remarks if remark.endswith("of what was seen then no types are known")]


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("</topics>", "<topic>/more</topic></topics>", "no observation says that /more was seen"),
        ('publish="ALLOW"', 'publish="DENY"', "no observation says that /log was seen"),
        ("<observed version=", "<observed edition=", "no observation is in it"),
        ('from="2026', 'from="soon', "no observation says that "),
        ('domain="0 3"', 'domain="x"', "what it says was seen cannot be read: "),
    ],
    ids=["a line more", "a DENY", "no metadata", "a time that is none", "a domain that is none"],
)
def test_what_no_observation_says_is_not_lost_in_silence(tmp_path: Path, old: str, new: str, why: str) -> None:
    policy, types = written(tmp_path, full())
    text = (tmp_path / "robot.policy.xml").read_text()
    assert old in text
    (tmp_path / "robot.policy.xml").write_text(
        text.replace(old, new).replace("</observed>", f"</{new[1:5]}>" if old == "<observed " else "</observed>")
    )
    with pytest.raises(InputErrors) as error:
        again((policy, types))
    assert why in str(error.value)


def observed(cli: Cli, folder: Path, *words: str) -> str:
    done = cli("observe", "--at", AT, *words, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stderr


def test_one_run_adds_to_another_and_nothing_is_written_over(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text(node_info("/cam", publishers=f"/image: {IMAGE}"))
    (tmp_path / "b.txt").write_text(node_info("/up", subscribers=f"/image: {IMAGE}"))
    observed(cli, tmp_path, "--text", "a.txt", "-o", "a.policy.xml")
    before = (tmp_path / "a.policy.xml").read_bytes()
    for words in (["--text", "b.txt"], ["--text", "b.txt", "--earlier", "a.policy.xml"]):
        lines = refused(cli("observe", *words, "-o", "a.policy.xml", cwd=tmp_path))
        assert "a.policy.xml: is there already and would be lost; remove it, or write to another file" in lines[0]
        assert "a.types.yaml: is there already" in lines[1]
    assert (tmp_path / "a.policy.xml").read_bytes() == before
    observed(cli, tmp_path, "--text", "b.txt", "--earlier", "a.policy.xml", "-o", "both.policy.xml")
    observed(cli, tmp_path, "--text", "a.txt", "--text", "b.txt", "-o", "once.policy.xml")
    for kind in ("policy.xml", "types.yaml"):
        assert (tmp_path / f"both.{kind}").read_bytes() == (tmp_path / f"once.{kind}").read_bytes()


def test_several_earlier_ones_become_one_without_looking(cli: Cli, tmp_path: Path) -> None:
    files = [written(tmp_path, saw(endpoint(node, "publish", "/x", BOOL)), node[1:])[0] for node in ("/a", "/b")]
    words = [word for file in files for word in ("--earlier", file)]
    observed(cli, tmp_path, *words, "-o", "both.policy.xml")
    text = (tmp_path / "both.policy.xml").read_text()
    assert ('node="a"' in text, 'node="b"' in text) == (True, True)


def test_what_nodes_declared_before_stays(tmp_path: Path) -> None:
    policy = tmp_path / "robot.policy.xml"
    assert declared_file(policy).name == "robot.declared.labels.yaml"
    declared_file(policy).touch()
    assert declared_file(policy).name == "robot.declared-2.labels.yaml"
