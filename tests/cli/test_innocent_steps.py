"""Fewer than three innocent steps never end in 'nothing found' where there is a leak (rules S11, S12).

A leak is planted in a real policy: two nodes that the rules, word for word, join. A person begins with nothing or with
what is true, and accepts one or two of the lines that the program offers. Exit 0 is a wrong answer then, but where the
person has named the source and a leak, and labels by name close every way: then these labels stand under ``Assumed``.
"""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import pytest
import yaml

from rosprivacy.analysis.model import GOES_NOWHERE, NO_LEAK_NAMED
from rosprivacy.ingest.labels.label_template import header
from rosprivacy.labelling.label_lines import next_lines, updated
from rosprivacy.report.text.review import EXAMPLE, lacking_step
from rosprivacy.settings import Settings
from tests.helpers.daily import one_in
from tests.helpers.innocent_steps import CHANNEL_WORDS, INFRASTRUCTURE, NODE_WORDS, Line, Planted, plant

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.helpers.command import Cli

SMALL = (
    "ros2__sros2/sros2/test/policies/talker_listener.policy.xml",
    "ros2__sros2/sros2/test/policies/add_two_ints.policy.xml",
    "ros2__sros2/sros2/test/policies/minimal_action.policy.xml",
    "JonasWoh__ROS2PrivacyGraph/policies/thesis_initial/thesis_initial_policy.xml",
)
LEAK, UNDETERMINED = 1, 4
LARGE = 200  # elements; of such policies samples are tried


def wrong(planted: Planted, random: Random, singles: int, pairs: int) -> Iterator[str]:
    """Every sequence that ends in 'nothing found' and should not."""
    for start in ((), planted.truth[:1], planted.truth):
        for untouched in (False, True)[: 2 if not start else 1]:
            for steps in planted.steps(random, singles, pairs):
                lines = (*start, *steps)
                tried = planted.after(lines, untouched=untouched)
                if tried.code == 0 and (why := _why(planted, lines, steps, known=bool(start))):
                    yield f"{planted.file.name}: {', '.join(f'{one.name} {one.word}' for one in lines)}: {why}"


def _why(planted: Planted, lines: tuple[Line, ...], steps: tuple[Line, ...], *, known: bool) -> str:
    """Why 'nothing found' is wrong here; empty if it is right, and is said to rest on these lines."""
    tried = planted.after(lines)
    assert tried.result
    if not known:
        return "nobody knew of the leak"
    if not planted.closed_by(tried, lines):
        return "the data gets to the leak"
    assumed = tried.result.to("text").partition("\nAssumed\n")[2]
    if "warning: no-leak-found hangs on " not in assumed:
        return "nothing under Assumed"
    named = [step for step in steps if f"({step.name.removeprefix('=')} " in assumed or f"{step.name}:" in assumed]
    return "" if named else "the line that closed it is not named"


def planted_in(corpus: Path, names: tuple[str, ...]) -> list[Planted]:
    found = [plant(corpus / "policies" / name, Random(name)) for name in names]  # noqa: S311 - no secret
    return [planted for planted in found if planted]


def test_the_words_are_those_of_the_template() -> None:
    """What is tried is what is offered: by the template's header, and by what the program says to do next."""
    for word in (*NODE_WORDS, *CHANNEL_WORDS):
        assert any(word.format(kind) in header() for kind in ("Video", "Voice", "Location")), word
    assert NODE_WORDS[0].format("Video") in EXAMPLE
    assert all("{leak: [" in text or "{source: [" in text for text in map(lacking_step, (GOES_NOWHERE, NO_LEAK_NAMED)))


def test_what_is_planted_is_a_leak(corpus: Path) -> None:
    planted = planted_in(corpus, SMALL)
    assert len(planted) == len(SMALL)
    for one in planted:
        assert one.after(one.truth).code == LEAK
        assert one.after(()).code == one.after((), untouched=True).code == UNDETERMINED
        assert Line("", INFRASTRUCTURE, "") in one.offered


@pytest.mark.parametrize("name", one_in(len(SMALL), SMALL))
def test_no_two_innocent_steps_end_in_nothing_found(corpus: Path, name: str) -> None:
    (planted,) = planted_in(corpus, (name,))
    assert list(wrong(planted, Random(1), singles=30, pairs=20)) == []  # noqa: S311 - no secret


@pytest.mark.slow
def test_nor_on_any_policy_of_the_corpus(corpus: Path, thorough: bool) -> None:  # noqa: FBT001 - a fixture
    """Half of the policies for each change, few steps on each; all of them each week."""
    names = sorted(str(file.relative_to(corpus / "policies")) for file in (corpus / "policies").rglob("*.xml"))
    planted = planted_in(corpus, tuple(names if thorough else names[::2]))
    assert len(planted) > 5
    part = 1 if thorough else 8
    wrong_answers: list[str] = []
    for number, one in enumerate(planted):
        few = len(one.system.graph.elements) > LARGE
        singles, pairs = (20, 15) if few else (80, 80)
        wrong_answers += wrong(one, Random(number), singles // part, pairs // part)  # noqa: S311 - no secret
    assert wrong_answers == []


@pytest.mark.parametrize("name", SMALL[:2])
def test_what_the_program_writes_into_a_file_says_nothing_by_itself(corpus: Path, tmp_path: Path, name: str) -> None:
    """``labels --next`` and ``--update``, twice each: what they add is empty."""
    (planted,) = planted_in(corpus, (name,))
    file = tmp_path / "l.yaml"
    for start in ((), planted.truth[:1], planted.truth):
        said = {"labels": 1, "nodes": {line.name: yaml.safe_load(line.word) for line in start}}
        for write in (next_lines, updated):
            file.write_text(yaml.safe_dump(said), "utf-8")
            for _ in range(2):
                file.write_text(write((str(planted.file),), (str(file),), Settings()).text, "utf-8")
            sections = yaml.safe_load(file.read_text("utf-8"))
            added = tuple(
                Line(section, entry, yaml.safe_dump(word))
                for section, entries in sections.items()
                if isinstance(entries, dict)
                for entry, word in entries.items()
            )
            assert planted.after(added).code == planted.after(start).code != 0


def test_as_a_person_does_it(cli: Cli, tmp_path: Path, corpus: Path) -> None:
    """The real commands: the wrong node named, and the only channel called mundane before a leak is named."""
    policy = corpus / "policies" / SMALL[0]
    assert cli("analyze", policy, cwd=tmp_path).returncode == UNDETERMINED
    assert cli("labels", "--init", policy, "-o", "l.yaml", cwd=tmp_path).returncode == 0
    assert cli("analyze", policy, "-l", "l.yaml", cwd=tmp_path).returncode == UNDETERMINED
    template = (tmp_path / "l.yaml").read_text("utf-8")

    def after(*lines: tuple[str, str]) -> tuple[int, str]:
        text = template
        for name, word in lines:
            assert f"\n  {name}:" in text
            text = text.replace(f"\n  {name}:", f"\n  {name}: {word}", 1)
        (tmp_path / "l.yaml").write_text(text, "utf-8")
        done = cli("analyze", policy, "-l", "l.yaml", cwd=tmp_path)
        return done.returncode, done.stdout

    source, mundane = ("/talker", "{source: [Video]}"), ("/chatter", "mundane")
    code, text = after(("/listener", "{source: [Video]}"))
    assert code == UNDETERMINED
    assert text.startswith("undetermined: no data was followed, it goes nowhere, or to standard channels only\n")
    assert cli("analyze", policy, "-l", "l.yaml", "--fail-on", "leak", cwd=tmp_path).returncode == UNDETERMINED
    code, text = after(source, mundane)
    assert code == UNDETERMINED
    assert text.startswith(
        "undetermined: no label says where data gets out, so nothing that it gets to could be a leak\n"
    )
    assert text.splitlines()[-1] == f"Next: {lacking_step(NO_LEAK_NAMED)}"
    code, text = after(source, mundane, ("/listener", "{leak: [Video]}"))
    assert code == 0
    assert ": l.yaml:" in text
    assert "(/chatter mundane; without it data gets to the leak /listener)" in text
    assert after(source, ("/listener", "{leak: none}"), mundane)[0] == 0  # who says so has thought of it
