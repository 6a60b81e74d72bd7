"""The guide robot of the examples: its ways out, as its README lists them, are named from the code alone."""

from __future__ import annotations

import re
from pathlib import Path  # noqa: TC003 - a fixture's type

from tests.helpers.command import Cli  # noqa: TC001 - a fixture's type
from tests.helpers.paths import ROOT

ROBOT = "examples/scan_robot"
WAYS = {"/guide/uploader", "/guide/door_sign", "/guide/face_recogniser", "/guide/building_bridge", "~/.ros/log"}
UNDETERMINED = 4


def test_a_trial_names_each_way_out_and_no_other(cli: Cli) -> None:
    done = cli("try", ROBOT, cwd=ROOT)
    assert done.returncode == UNDETERMINED
    more = re.search(r"^\d+ more places: (.*)$", done.stdout, re.MULTILINE)
    assert more
    assert {*re.findall(r"^\d+\. (\S+), to ", done.stdout, re.MULTILINE), *more[1].split(", ")} == WAYS


def test_the_lines_of_its_list_are_where_data_leaves(cli: Cli) -> None:
    scanned = cli("scan", ROBOT, cwd=ROOT).stdout
    table = (ROOT / ROBOT / "README.md").read_text("utf-8")
    places = set(re.findall(r"`(\w+\.\w+:\d+)` \|$", table, re.MULTILINE))
    assert len(places) == len(WAYS)
    unseen = {place for place in places if not re.search(rf"/{re.escape(place)}$", scanned, re.MULTILINE)}
    assert unseen == {"door_sign.py:21"}  # told where its client is made


def test_namespace_remaps_parameters_and_includes_are_in_the_names(cli: Cli, tmp_path: Path) -> None:
    policy = tmp_path / "guide.policy.xml"
    cli("scan", ROBOT, "-o", str(policy), cwd=ROOT)
    text = policy.read_text("utf-8")
    for name in ("front/image_raw", "listener/speech", "laser/scan", "people", "visitor", "audio"):
        assert f"<topic>/guide/{name}</topic>" in text
