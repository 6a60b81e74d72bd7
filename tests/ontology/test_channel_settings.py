"""The shipped settings of bridges and recorders: of packages of the catalogue, each with what was read."""

from __future__ import annotations

import re
from datetime import date

import pytest

from rosprivacy.analysis.mitigation.channel_settings import (
    COMMAND,
    FILE,
    LEFT_OUT,
    OTHERS,
    PARAMETER,
    PROGRAMS,
    SET,
    TAKE_OUT,
    Program,
)
from rosprivacy.analysis.model import CHANNELS
from rosprivacy.ingest.known_packages.package_folders import catalogue
from rosprivacy.ingest.known_packages.program_settings import programs
from rosprivacy.ontology.vocabulary import load


@pytest.mark.parametrize("program", programs(), ids=lambda program: program.package)
def test_a_program_is_an_exit_of_the_catalogue(program: Program) -> None:
    (package,) = (one for one in catalogue(load()) if one.name == program.package)
    (node,) = (one for one in package.nodes if program.node in one.names)
    leaks = [claim.where for claim in node.claims if claim.role == "leak"]
    assert leaks
    assert (program.kind == "recorder") == (leaks == ["file"])
    assert program.kind in PROGRAMS


@pytest.mark.parametrize("program", programs(), ids=lambda program: program.package)
def test_a_setting_is_of_what_was_read(program: Program) -> None:
    for setting in program.settings:
        assert setting.channels in CHANNELS
        assert setting.where in (PARAMETER, FILE, COMMAND)
        assert setting.action in (SET, TAKE_OUT)
        assert setting.names in (LEFT_OUT, OTHERS)
        assert setting.text.count("{names}") == 1
        assert setting.name_form.count("{name}") == 1
        assert len(setting.note) <= 68
    for source in program.sources:
        assert re.fullmatch(r"https://[a-z0-9.]+/[\w./-]+", source.at)
        assert re.fullmatch(r"[0-9a-f]{40}", source.commit)
        assert source.files
        assert date.fromisoformat(source.read) >= date(2026, 11, 1)
    assert program.sources


def test_each_stands_once() -> None:
    nodes = [(program.package, program.node) for program in programs()]
    assert len(set(nodes)) == len(nodes)
    assert {"foxglove_bridge", "rosbridge_suite", "mqtt_client", "domain_bridge", "rosbag2"} <= {p for p, _ in nodes}
