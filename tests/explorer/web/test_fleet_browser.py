"""A fleet in a real Chromium, by keys alone: an answer for a model, and one for a single robot; both are saved."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest

from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet
from tests.helpers import browser as chrome
from tests.helpers.browser import WIDTHS
from tests.helpers.page_reader import Reader, served
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.usefixtures("quiet")]


@pytest.fixture
def hospital(tmp_path: Path) -> Path:
    """The fleet file of the example, with a question of a model."""
    shutil.copytree(ROOT / "examples" / "fleet", tmp_path / "fleet")
    model = tmp_path / "fleet" / "carrier.labels.yaml"
    model.write_text(model.read_text("utf-8").replace("  /recorder: conduit\n", ""), "utf-8")
    return tmp_path / "fleet" / "fleet.yaml"


def for_one_robot(reader: Reader) -> None:
    """Say with keys that the next answer is of one robot and not of its model."""
    from selenium.webdriver.common.keys import Keys

    reader.focus("#answers [name=whose]:checked")
    reader.press(Keys.ARROW_DOWN)
    checked = "return document.querySelector('#answers [name=whose]:checked').value"
    assert reader.browser.execute_script(checked) == "robot"


def test_only_the_label_files_that_were_answered_for_are_written(browser: WebDriver, hospital: Path) -> None:
    model, own = (hospital.parent / f"{name}.labels.yaml" for name in ("carrier", "carrier_lent"))
    before = {file: file.read_bytes() for file in hospital.parent.rglob("*") if file.is_file()}
    with served(browser, hospital, hospital, fleet=True) as explorer:
        reader = Reader(browser, explorer)
        assert reader.current == "carrier_lent:/recorder"  # the robot that is not as its model comes first
        for_one_robot(reader)
        reader.answer("carrier_lent:/recorder", "c")
        assert "stands for 23 robots" in reader.text("#element .facts")
        reader.answer("carrier_01:/recorder", "c")
        reader.save()
        assert explorer.session.result.to("json1") == answer_fleet(str(hospital), Settings()).to("json1")
    after = {file: file.read_bytes() for file in hospital.parent.rglob("*") if file.is_file()}
    assert {file for file in after if after[file] != before.get(file)} == {model, own}
    for labels in (model, own):
        assert "  /recorder: {conduit: [Video]}" in labels.read_text("utf-8")


def test_an_answer_for_the_model_alone_leaves_the_file_of_one_robot_as_it_was(
    browser: WebDriver, hospital: Path
) -> None:
    own = hospital.parent / "carrier_lent.labels.yaml"
    before = own.read_bytes()
    with served(browser, hospital, hospital, fleet=True) as explorer:
        reader = Reader(browser, explorer)
        reader.answer("carrier_lent:/recorder", "l")  # of the model, as it is chosen beforehand
        reader.save()
        assert explorer.session.result.to("json1") == answer_fleet(str(hospital), Settings()).to("json1")
    assert own.read_bytes() == before
    assert "  /recorder: {leak: [Video]}" in (hospital.parent / "carrier.labels.yaml").read_text("utf-8")


@pytest.mark.parametrize("width", WIDTHS)
def test_axe_finds_nothing_in_any_pane_of_a_fleet(browser: WebDriver, hospital: Path, width: int) -> None:
    with served(browser, hospital, hospital, fleet=True) as explorer:
        reader = Reader(browser, explorer, width)
        assert reader.faults() == []
        for key in ("o", "p"):  # a finding, and what closes it
            reader.press(key)
            assert reader.faults() == []
        reader.press("w")
        assert reader.faults() == []
        assert chrome.wider(browser, "fieldset, .whose label, .row") == []
