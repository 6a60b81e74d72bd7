"""The documentation says what is true: its commands run, its label files are read, its option tables are the code's.

``python -m tests.test_docs`` writes what is generated anew: ``docs/reference/``, the JSON schemas of the documents, and
the tables of ``docs/labels.md`` that stand between marks.
"""

from __future__ import annotations

import doctest
import json
import re
import shlex
import shutil
from functools import partial
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.model import NON_ROS
from rosprivacy.analysis.python_311 import tomllib
from rosprivacy.cli.project_file import project_schema
from rosprivacy.ingest.fleet.fleet_schema import fleet_schema
from rosprivacy.ingest.labels.keywords import CHANNEL, KEYWORDS, NODE, rows
from rosprivacy.ingest.labels.label_file import read_labels
from rosprivacy.ingest.labels.label_schema import label_schema
from rosprivacy.ontology.vocabulary import load
from tests.fuzzing.targets import TARGETS
from tests.helpers import contract, reference
from tests.helpers.docs import blocks
from tests.helpers.house import MODULES
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.helpers.command import Cli

ARCHITECTURE = ROOT / "docs" / "architecture.md"
LABELS = ROOT / "docs" / "labels.md"
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]
SECURITY = ROOT / "docs" / "security.md"
PAGES.append(ROOT / "SECURITY.md")


def with_parts(text: str, **parts: str) -> str:
    """A page with its generated parts anew."""
    for name, part in parts.items():
        before, after = text.split(f"<!-- {name}: written by python -m tests.test_docs -->\n")
        text = f"{before}<!-- {name}: written by python -m tests.test_docs -->\n{part}<!-- end -->\n"
        text += after.split("<!-- end -->\n", 1)[1]
    return text


def labels_page(text: str) -> str:
    """The page with the tables of keywords: of nodes, of channels, and the facts of elements outside ROS."""
    head = ["| label | meaning |", "| --- | --- |"]
    nodes, channels = (
        "\n".join([*head, *(f"| {written} | {meaning} |" for one in KEYWORDS if where in one.where
                           for written, meaning in rows(one.docs)), ""])
        for where in (NODE, CHANNEL)
    )  # fmt: skip
    facts = ["| fact | of | meaning |", "| --- | --- | --- |"]
    for one in (one for one in KEYWORDS if set(one.where) <= set(NON_ROS)):
        of = "all" if one.where == NON_ROS else ", ".join(one.where).replace("-", " ")
        facts += [f"| {written} | {of} | {meaning} |" for written, meaning in rows(one.docs)]
    return with_parts(text, nodes=nodes, channels=channels, facts="\n".join([*facts, ""]))


def page_text(make: Callable[[], str], earlier: str) -> str:
    """A page of the reference, whatever stood there before."""
    del earlier
    return make()


def schema_text(document: Any, earlier: str) -> str:
    """The schema of a document, whatever stood there before."""
    del earlier
    return contract.text(document)


def editor_schema(name: str, earlier: str) -> str:
    """The schema of a file that users write, with the address that a catalogue of schemas names it by."""
    del earlier
    address = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["urls"]["Repository"]
    schema = EDITOR_SCHEMAS[name]()
    identified = {"$schema": schema.pop("$schema"), "$id": f"{address}/raw/main/docs/{name}.schema.json", **schema}
    return json.dumps(identified, ensure_ascii=False, indent=1) + "\n"


EDITOR_SCHEMAS: dict[str, Callable[[], dict[str, Any]]] = {
    "labels": lambda: label_schema(load().categories.values()),
    "fleet": lambda: fleet_schema(load().categories.values()),
    "project": project_schema,
}
GENERATED: dict[Path, Callable[[str], str]] = {
    LABELS: labels_page,
    **{file: partial(page_text, make) for file, make in reference.pages().items()},
    **{contract.file_of(name): partial(schema_text, document) for name, document in contract.DOCUMENTS.items()},
    **{contract.file_of(name): partial(editor_schema, name) for name in EDITOR_SCHEMAS},
}


@pytest.mark.parametrize("file", GENERATED, ids=lambda file: str(file.name))
def test_what_is_generated_is_that_of_the_program(file: Path) -> None:
    text = file.read_text("utf-8")
    assert text == GENERATED[file](text), "python -m tests.test_docs"


def test_the_house_names_every_folder() -> None:
    folders = {f"`{file.parent.relative_to(ROOT)}/`" for file in MODULES.values()}
    assert folders <= set(re.findall(r"`[\w/]+/`", reference.house()))


def test_what_the_architecture_names_is_there() -> None:
    """Files, and after a colon what they define."""
    named = re.findall(r"`((?:[\w.-]+/)+[\w.-]+\.\w+)(?::(\w+))?`", ARCHITECTURE.read_text("utf-8"))
    assert len(named) > 30
    for file, name in named:
        assert (ROOT / file).is_file(), file
        assert not name or re.search(rf"\b(def|class) {name}\b", (ROOT / file).read_text("utf-8")), (file, name)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.name))
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text("utf-8")):
        assert target.startswith("http") or (page.parent / target).exists(), target


@pytest.mark.parametrize("page", [ROOT / "README.md", ROOT / "docs" / "labels.md"], ids=lambda page: str(page.name))
def test_the_label_files_that_are_shown_are_read(page: Path, tmp_path: Path) -> None:
    found = [block for block in blocks(page, "yaml") if block.startswith("labels:")]
    assert found
    for block in found:
        file = tmp_path / "labels.yaml"
        file.write_text(block)
        assert read_labels(str(file), load()).entries


@pytest.mark.slow
def test_what_is_shown_of_python_is_what_it_prints(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    page = ROOT / "docs" / "python.md"
    code = "".join(blocks(page, "pycon"))
    shown: list[str] = []
    runner = doctest.DocTestRunner()
    ran = runner.run(doctest.DocTestParser().get_doctest(code, {}, page.name, str(page), 0), out=shown.append)
    assert (ran.failed, "".join(shown)) == (0, "")
    assert ran.attempted > 20


def test_the_readmes_first_finding_is_what_is_printed(cli: Cli) -> None:
    (command,) = [line for line in blocks(ROOT / "README.md", "console")[1].splitlines() if line]
    program, *arguments = command.split()
    done = cli(*arguments, cwd=ROOT)
    assert (program, done.returncode) == ("rosprivacy", 1)
    (shown,) = [block for block in blocks(ROOT / "README.md", "text") if block.startswith("leak:")]
    for line in shown.splitlines():
        assert line == "…" or line in done.stdout.splitlines(), line


@pytest.mark.slow
def test_the_first_hour_goes_as_its_page_says(cli: Cli, tmp_path: Path) -> None:
    page = ROOT / "docs" / "first-hour.md"
    shutil.copy(ROOT / "examples" / "telepresence" / "graph.txt", tmp_path)
    codes, answers = {}, []
    for line in [line for block in blocks(page, "console") for line in block.splitlines()]:
        program, *words = shlex.split(line)
        done = cli(*words, cwd=tmp_path)
        assert program == "rosprivacy"
        codes[words[0]] = done.returncode
        answers.append(done.stdout)
    assert codes == {"try": 4, "init": 0, "labels": 0, "analyze": 1, "mitigate": 0, "report": 0, "diff": 0}
    (shown,) = blocks(page, "text")
    assert shown in answers[0]
    assert {file.name for file in tmp_path.iterdir()} >= {"robot.types.yaml", "rosprivacy.toml", "report.html"}


@pytest.mark.slow
def test_what_it_finds_is_what_its_commands_print(cli: Cli) -> None:
    page = ROOT / "docs" / "what-it-finds.md"
    commands, printed = blocks(page, "console"), blocks(page, "text")
    for command, shown in zip(commands, printed, strict=True):
        lines = iter(cli(*command.split()[1:], cwd=ROOT).stdout.splitlines())
        for line in shown.splitlines():  # in this order
            assert line == "…" or line in lines, line


def test_every_id_in_the_readme_is_of_the_system_that_it_analyses() -> None:
    folder = ROOT / "examples" / "factory"
    document = rosprivacy.analyze(str(folder / "before.policy.xml"), str(folder / "run2.labels.yaml")).document()
    known = [finding["id"] for finding in document["findings"]]
    named = re.findall(r"\b(?=[a-f]*\d)(?=\d*[a-f])[0-9a-f]{4,16}\b", (ROOT / "README.md").read_text("utf-8"))
    assert named
    assert not [one for one in named if not any(full.startswith(one) for full in known)]


@pytest.mark.slow
@pytest.mark.parametrize("block", blocks(ROOT / "docs" / "categories.md", "turtle"))
def test_the_ontologies_that_are_shown_are_read(block: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.ttl"
    file.write_text(block, "utf-8")
    found = load(tmp_path / "cache", [str(file)])
    assert len(found.categories) > len(load().categories)


def test_the_record_of_the_fuzzing_has_each_reader() -> None:
    targets = json.loads(reference.FUZZED.read_text("utf-8"))["targets"]
    assert {name for name, counts in targets.items() if counts["inputs"]} == TARGETS.keys()


def test_what_holds_a_promise_is_there() -> None:
    """docs/security.md names a test or a file for each promise."""
    named = re.findall(r"`((?:[\w.-]+/)+[\w.-]+\.\w+)(?:::(\w+))?`", SECURITY.read_text("utf-8"))
    assert len(named) > 20
    for file, test in named:
        assert not test or f"def {test}(" in (ROOT / file).read_text("utf-8"), (file, test)
        assert (ROOT / file).is_file(), file


def test_the_readme_is_for_a_person_in_a_hurry() -> None:
    assert len((ROOT / "README.md").read_text("utf-8").split()) <= 900


def test_the_page_of_labels_has_every_keyword() -> None:
    assert all(f"`{one.name}" in LABELS.read_text("utf-8") for one in KEYWORDS)


def test_no_registry_is_named() -> None:
    """Mirrors are the user's own configuration."""
    for page in PAGES:
        assert not re.search(r"pypi\.org|pythonhosted|repo1?\.maven|registry\.npmjs", page.read_text("utf-8"))


if __name__ == "__main__":
    for generated, anew in GENERATED.items():
        generated.parent.mkdir(exist_ok=True)
        earlier = generated.read_text("utf-8") if generated.exists() else ""
        generated.write_text(anew(earlier), "utf-8")
