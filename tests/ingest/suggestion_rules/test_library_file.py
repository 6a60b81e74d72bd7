"""Rules about libraries: what ships, which name speaks about a use, and what is wrong with a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from ruamel.yaml import YAML

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.library_rules import CPP, PYTHON, NodeUse
from rosprivacy.ingest.suggestion_rules.rule_files import SECTIONS, read_library_rules
from rosprivacy.ontology.vocabulary import FOLDER, load

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.suggesting.library_rules import RulesByName

VOCABULARY = load()
SHIPPED, FILES = read_library_rules((), VOCABULARY)
LEAST = 80  # rules
OWN = "library_rules: 1\nbrings_in:\n- {python: [%s], kinds: [Gesture], confidence: may, why: ours}\n"
NO_NAME = "write names such as cv2.VideoCapture, cv::VideoCapture, curl_easy_*, open(w), or a program"


def spoken(section: Mapping[str, RulesByName], name: str, language: str = PYTHON) -> tuple[str, ...]:
    rule = SHIPPED.spoken(section, NodeUse(name, language, Place("a", 1)))
    return (*rule.kinds, *rule.to, rule.where) if rule else ()


def test_every_shipped_rule_names_its_page_and_none_is_certain() -> None:
    top = YAML(typ="safe", pure=True).load(Path(str(FOLDER / "libraries.yaml")).read_text("utf-8"))
    rules = [rule for section in SECTIONS for rule in top[section]]
    assert len(rules) >= LEAST
    assert all(rule["source"] and rule["why"] for rule in rules)
    assert {rule["confidence"] for rule in rules} == {Confidence.LIKELY.value, Confidence.MAY.value}
    assert [file for file, _ in FILES] == ["rosprivacy:libraries"]


@pytest.mark.parametrize(
    ("section", "name", "said"),
    [
        ("brings_in", "cv2.VideoCapture.read", ("Video", "")),
        ("brings_in", "cv2.VideoCaptureModes", ()),
        ("brings_in", "pyaudio.PyAudio.open(input)", ("Voice", "")),
        ("lets_out", "pyaudio.PyAudio.open(input)", ()),
        ("lets_out", "pyaudio.PyAudio.open(output)", ("PersonalData", "loudspeaker")),
        ("lets_out", "open(w)", ("PersonalData", "file")),
        ("lets_out", "open", ()),
        ("lets_out", "requests.post", ("PersonalData", "network")),
        ("lets_out", "requests.exceptions.Timeout", ()),  # silent, and longer
        ("lets_out", "$ ros2 bag record", ("PersonalData", "file")),
        ("lets_out", "$ ros2 topic list", ()),
        ("brings_in", "@ rtsp://10.0.0.1/live", ("Video", "")),
        ("lets_out", "@ https://api.telegram.org/bot", ("PersonalData", "network")),
        ("lets_out", "@ https://example.org", ()),
        ("makes", "whisper.load_model", ("Voice", "CommunicationContent", "")),
        ("makes", "face_recognition.face_locations", ("Video", "FaceImage", "PersonDetection", "")),
    ],
)
def test_the_longest_name_speaks_about_a_use(section: str, name: str, said: tuple[str, ...]) -> None:
    assert spoken(getattr(SHIPPED, section), name) == said


def test_an_address_is_named_by_a_part(tmp_path: Path) -> None:
    file = tmp_path / "own.yaml"
    rule = "library_rules: 1\nlets_out:\n- {addresses: [%s], where: network, confidence: may, why: ours}\n"
    file.write_text(rule % "portal.example, example/own", "utf-8")
    own = read_library_rules((str(file),), VOCABULARY)[0].lets_out[PYTHON].of("@ wss://portal.example/own")
    assert own is not None
    assert (own[0], own[1].why) == ("portal.example", "ours")  # the longest part
    file.write_text(rule % "'a b'", "utf-8")
    with pytest.raises(InputErrors) as told:
        read_library_rules((str(file),), VOCABULARY)
    assert f"{file}:3: 'a b' is no part of an address" in str(told.value)


def test_stars_and_languages() -> None:
    assert spoken(SHIPPED.lets_out, "curl_easy_init", CPP) == ("PersonalData", "network")
    assert spoken(SHIPPED.lets_out, "curl_easy_init") == ()
    assert spoken(SHIPPED.brings_in, "rs2::pipeline", CPP) == ("Video", "DepthImage", "")
    assert spoken(SHIPPED.lets_out, "boost::asio::ip::tcp::socket", CPP) == ("PersonalData", "network")
    assert spoken(SHIPPED.lets_out, "boost::asio::serial_port", CPP) == ()


def test_a_users_rules_stand_before_ours(tmp_path: Path) -> None:
    file = tmp_path / "own.yaml"
    file.write_text(OWN % "cv2.VideoCapture, requests.exceptions" + "silent: [{python: [requests]}]\n", "utf-8")
    rules, files = read_library_rules([str(file)], VOCABULARY)

    def kinds(section: Mapping[str, RulesByName], name: str) -> tuple[str, ...]:
        rule = rules.spoken(section, NodeUse(name, PYTHON, Place("a", 1)))
        return rule.kinds if rule else ()

    assert kinds(rules.brings_in, "cv2.VideoCapture") == ("Gesture",)
    assert kinds(rules.brings_in, "requests.exceptions.Timeout") == ("Gesture",)
    assert kinds(rules.lets_out, "requests.post") == ()
    assert len(files) == 2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("- 1\n", "f.yaml:1: rules about libraries are a map, not a list; begin with 'library_rules: 1'"),
        ("brings_in: []\n", "f.yaml:1: no 'library_rules: 1'; say so on the first line: it is the format's version"),
        ("library_rules: 1\nbring_in: []\n", "f.yaml:2: unknown key 'bring_in'; did you mean 'brings_in'?"),
        (OWN % "a.b, a.b", "f.yaml:3: a.b again, first in line 3; say each once in a section"),
        (OWN % "12", f"f.yaml:3: '12' is no name of a library; {NO_NAME}"),
        (OWN % "'a(r)'", f"f.yaml:3: 'a(r)' is no name of a library; {NO_NAME}"),
        ("library_rules: 1\nbrings_in:\n- {kinds: [Video], confidence: may, why: x}\n",
         "f.yaml:3: a rule about no library; write python, c++, programs, addresses, or one of them"),
        ("library_rules: 1\nbrings_in:\n- {python: [a], kinds: [Vidoe], confidence: may, why: x}\n",
         "f.yaml:3: unknown category 'Vidoe'; did you mean Video or Voice?"),
        ("library_rules: 1\nmakes:\n- {c++: [a], kinds: [Video], confidence: may, why: x}\n",
         "f.yaml:3: a rule without to; write kinds, to, confidence, why"),
        ("library_rules: 1\nlets_out:\n- {programs: [a], where: moon, confidence: may, why: x}\n",
         "f.yaml:3: where 'moon'; write network, display, file, loudspeaker, device or domain"),
        ("library_rules: 1\nlets_out:\n- {programs: [a], where: file, confidence: certain, why: x}\n",
         "f.yaml:3: confidence 'certain'; write likely or may"),
        ("library_rules: 1\nbrings_in:\n- {c++: [a], kinds: [Video], confidence: may, why: x, any_type: 1}\n",
         "f.yaml:3: any_type '1'; write true or leave it out"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_its_line(
    text: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "f.yaml").write_text(text, "utf-8")
    with pytest.raises(InputErrors) as raised:
        read_library_rules(["f.yaml"], VOCABULARY)
    assert str(raised.value.errors[0]) == message
