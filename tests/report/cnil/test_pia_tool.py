"""The file for the CNIL's PIA tool, through the tool's own code: imported, shown in its states, exported, without loss.

The tool is no part of this repository: ``ROSPRIVACY_PIA`` names a copy of its own (LINCnil/pia), and without it these
tests are left out. ``npm ci --ignore-scripts --prefix tests/report/cnil/pia_tool`` installs what runs it (Node.js 20).
What ``test_cnil.py`` writes anew of the tool's import is held against it here.
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.documents import document_of
from rosprivacy.report.cnil.person_answers import SCALE, PersonAnswers
from rosprivacy.report.cnil.pia import cnil_pia
from tests.helpers.languages import SYSTEMS
from tests.helpers.office import LANGUAGES, OF_PATHS, answers_of, decided_office
from tests.helpers.paths import ROOT
from tests.helpers.pia_tool import CREATED, ITEMS, LIST, TEXT, imported

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

pytestmark = [pytest.mark.pia, pytest.mark.slow]
HARNESS = ROOT / "tests" / "report" / "cnil" / "pia_tool" / "round_trip.mjs"
PARTS = {
    "answers": ("reference_to", "data"),
    "measures": ("title", "content", "placeholder"),
    "evaluations": ("reference_to", "status", "action_plan_comment"),
    "comments": ("reference_to", "description", "for_measure"),
}
OF_THE_TOOL = {
    "id",
    "name",
    "progress",
    "created_at",
    "updated_at",
    "is_archive",
    "is_example",
}  # which it gives itself
PENDING = {"status": 0, "global_status": 0, "gauges": None, "created_at": CREATED, "updated_at": CREATED}
HANDED_IN = 4  # of an item: the evaluator's turn


def tool() -> Path:
    return Path(os.environ["ROSPRIVACY_PIA"])


def through(files: Iterable[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """What the tool exports of each file after its import, and the state in which it shows it."""
    texts = json.dumps([json.dumps(file, ensure_ascii=False) for file in files])
    command = ["node", str(HARNESS), str(tool())]
    run = subprocess.run(command, input=texts, capture_output=True, text=True, check=True, timeout=120)
    made: list[dict[str, Any]] = json.loads(run.stdout)
    return made


def told(file: Mapping[str, Any], part: str) -> list[dict[str, Any]]:
    """The rows of a part without ids and times, which the tool gives anew, in an order of their own."""
    rows = [{key: row.get(key) for key in PARTS[part]} for row in file[part]]
    return sorted(rows, key=lambda row: json.dumps(row, sort_keys=True))


def check_nothing_is_lost(given: Mapping[str, Any], exported: Mapping[str, Any]) -> None:
    for part in PARTS:
        assert told(exported, part) == told(given, part), part
    record, before = exported["pia"], given["pia"]
    assert record["name"] == f"(IMPORT) {before['name']}"
    lost = {key for key in before.keys() - OF_THE_TOOL if (record.get(key) or None) != (before[key] or None)}
    assert not lost
    (chosen,) = [row["data"]["list"] for row in exported["answers"] if row["reference_to"] == 324]
    assert sorted(chosen) == sorted(row["title"] for row in exported["measures"])


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, Any]]:
    """The file of each system in each language; of an office abroad with all that people can answer and decide."""
    made = {name: cnil_files(document) for name, document in ((n, document_of(s())) for n, s in SYSTEMS.items())}
    office = decided_office(tmp_path_factory.mktemp("office"))
    made["office"] = cnil_files(document_of(office), PersonAnswers(answers_of(office, OF_PATHS), "assessment.json"))
    return {f"{name}.{language}": file for name, some in made.items() for language, file in some.items()}


def cnil_files(document: Any, *answers: PersonAnswers) -> dict[str, dict[str, Any]]:
    return {language: cnil_pia(document, CREATED, language, *answers) for language in LANGUAGES}


@pytest.fixture(scope="module")
def exported(files: dict[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    return dict(zip(files, through(files.values()), strict=True))


def test_nothing_is_lost_between_import_and_export(files: dict[str, Any], exported: dict[str, Any]) -> None:
    assert len(files) == len(LANGUAGES) * (len(SYSTEMS) + 1)
    for name, file in files.items():
        check_nothing_is_lost(file, exported[name]["exported"])


def test_what_was_exported_can_be_imported_again(exported: dict[str, Any]) -> None:
    first = [one["exported"] for one in exported.values()]
    for before, after in zip(first, through(first), strict=True):
        check_nothing_is_lost(before, after["exported"])


def test_no_item_is_handed_to_the_evaluator(files: dict[str, Any], exported: dict[str, Any]) -> None:
    """Every answer can still be changed, and the states are those that ``test_cnil.py`` reckons."""
    for name, file in files.items():
        status = {item: exported[name]["status"][item] for item in (*ITEMS, "3.1")}
        assert set(exported[name]["kept_open"]) == status.keys()
        assert status == {item: imported(file).status(item) for item in status}


def test_a_pending_evaluation_would_close_the_answers(files: dict[str, Any]) -> None:
    """So an action plan that nobody has evaluated stands in a measure."""
    file = files["office.en"]
    planned = next(row["id"] for row in file["measures"] if "still to be done" in row["title"])
    evaluation = {"reference_to": f"3.1.{planned}", "action_plan_comment": "blur", **PENDING}
    (made,) = through([{**file, "evaluations": [evaluation]}])
    assert made["status"]["3.1"] == HANDED_IN
    assert "3.1" not in made["kept_open"]


def test_the_tools_own_example_goes_through_as_its_makers_left_it() -> None:
    """That what is asked here can fail: its items are evaluated."""
    example = json.loads((tool() / "src/assets/files/2018-02-21-pia-example.json").read_text("utf-8"))
    (made,) = through([example])
    assert min(made["status"][item] for item in ITEMS) > HANDED_IN
    assert not made["kept_open"]
    assert len(made["exported"]["evaluations"]) == len(example["evaluations"])


def test_questions_and_levels_are_those_of_the_tool() -> None:
    structure = json.loads((tool() / "src/assets/files/pia_architecture.json").read_text("utf-8"))
    kinds = {
        question["id"]: question["answer_type"]
        for section in structure["sections"]
        for item in section["items"]
        for question in item.get("questions", ())
    }
    assert {number for number, kind in kinds.items() if kind == "text"} == set(TEXT)
    assert {number for number, kind in kinds.items() if kind == "list"} == set(LIST)
    for at, language in enumerate(LANGUAGES):
        named = json.loads((tool() / f"src/assets/i18n/{language}.json").read_text("utf-8"))["summary"]["gauges"]
        assert {int(level): name.casefold() for level, name in named.items()} == {
            level: names[at].casefold() for level, names in SCALE.items()
        }
