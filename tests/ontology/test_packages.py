"""The shipped catalogue of packages: each entry names its sources, and says no more than they do."""

from __future__ import annotations

import re
from datetime import date
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.model import Confidence
from rosprivacy.ingest.known_packages.package_file import read_package
from rosprivacy.ingest.known_packages.package_folders import catalogue
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table
from rosprivacy.ontology.vocabulary import FOLDER, load

if TYPE_CHECKING:
    from pathlib import Path

FILES = sorted((FOLDER / "packages").glob("*"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_an_entry_is_read_and_names_its_sources(file: Path) -> None:
    package = read_package(str(file), load())
    assert file.name == f"{package.name}.yaml"
    assert package.about[0].isupper()
    assert package.about.endswith(".")
    for source in package.sources:
        assert re.fullmatch(r"https://[a-z0-9.]+/[\w./-]+", source.at)
        assert re.fullmatch(r"[0-9a-f]{40}", source.commit)
        assert source.files
        assert date.fromisoformat(source.read) >= date(2026, 11, 1)
    assert len({name for node in package.nodes for name in node.names}) == sum(
        len(node.names) for node in package.nodes
    )


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_an_entry_says_no_more_than_it_can_know(file: Path) -> None:
    package = read_package(str(file), load())
    for node in package.nodes:
        assert node.claims
        for claim in node.claims:
            assert claim.confidence in (Confidence.LIKELY, Confidence.MAY)
            assert claim.kind or claim.role == "conduit"
            assert len(claim.why.split()) >= 4
        ended = [claim for claim in node.claims if claim.role == "sanitizer"]
        assert not ended, "no documentation that was read is plain enough about a sanitizer"
        leaks = [claim for claim in node.claims if claim.role == "leak"]
        for claim in node.claims:
            if claim.role == "conduit":  # of a narrower kind it would outrank the leak (rule S7)
                above = {claim.kind, *load().hierarchy.broader(claim.kind)} if claim.kind else set()
                assert not [leak for leak in leaks if leak.kind in above or leak.confidence is Confidence.LIKELY]


def test_the_types_of_common_packages_are_spelled_as_the_table_of_types_has_them() -> None:
    table = read_table(TABLE, load())
    known = {name.rpartition("/")[0] for name, _ in table.suggestions}  # sensor_msgs/msg
    named = {one.type for package in catalogue(load()) for node in package.nodes for one in node.interfaces} - {""}
    common = sorted(name for name in named if name.rpartition("/")[0] in known)
    assert len(common) > 50
    assert [name for name in common if not table.knows(name)] == []


def test_there_are_many_and_each_is_of_one_package() -> None:
    found = catalogue(load())
    assert len(found) >= 40
    assert len({package.name for package in found}) == len(found) == len(FILES)


@pytest.mark.parametrize(
    ("package", "node", "role", "kind"),
    [
        ("realsense2_camera", "camera", "source", "Video"),
        ("audio_common", "audio_capture_node", "source", "Voice"),
        ("hri_face_identification", "hri_face_identification", "leak", "FaceTemplate"),
        ("foxglove_bridge", "foxglove_bridge", "leak", "PersonalData"),
        ("rosbag2", "rosbag2_recorder", "leak", "PersonalData"),
        ("nav2", "amcl", "derivation", "LaserScan"),
        ("ros2_whisper", "transcript_subscriber", "leak", "SpeechTranscript"),
        ("septentrio_gnss_driver", "septentrio_gnss", "leak", "GnssPosition"),
    ],
)
def test_what_everybody_knows_of_a_package_is_in_it(package: str, node: str, role: str, kind: str) -> None:
    (entry,) = (one for one in catalogue(load()) if one.name == package)
    claims = [claim for one in entry.nodes if node in one.names for claim in one.claims]
    assert (role, kind) in [(claim.role, claim.kind) for claim in claims]
