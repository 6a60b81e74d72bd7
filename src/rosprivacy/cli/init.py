"""``rosprivacy init``: the project file of a system, with a policy, types and a label file where there are none."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import replace
from pathlib import Path
from signal import SIGINT
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.text import blanked
from rosprivacy.cli.exit_code import FailOn
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import Language
from rosprivacy.cli.project_file import OWN_FILE, SHIPPED
from rosprivacy.cli.suggestions_to_answer import line_about
from rosprivacy.cli.what_runs import Ros2, as_policies
from rosprivacy.ingest.reading.bounded_file import leaves
from rosprivacy.ingest.types import named_after, types_path

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.cli.what_runs import Read
    from rosprivacy.labelling.label_lines import LabelLines

ROBOT = "robot.policy.xml"  # what is observed, and what others are named after where there are several
SOMETHING = "name a policy, a folder, a keystore, a text of `ros2 node info`, or --ros2"


class ProjectAnswers(NamedTuple):
    """What a person says of a project."""

    labels: str
    author: str = ""
    types: tuple[str, ...] = ()
    lang: Language = Language.en
    fail_on: FailOn = FailOn.undetermined


@reads_system(
    "what one robot grants or runs",
    without=(
        "fleet", "from_database", "neo4j", "add", "categories", "decisions", "type_limits", "project", "no_project",
        "view", "category", "standard_channels",
    ),
)  # fmt: skip
def init(
    inputs: Inputs,
    ros2: Ros2 = False,
    from_try: Annotated[
        bool, typer.Option("--from-try", help="Ask nothing: keep what `rosprivacy try` has shown, as suggestions.")
    ] = False,
    by: Annotated[
        str | None, typer.Option(metavar="NAME", help="Who answers, the author of the label file.", show_default=False)
    ] = None,
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON Schema of project files.")] = False,
) -> None:
    """Begin a project in this folder: a project file, and a label file with what brings data in or lets it out.

    POLICY is a policy, a folder, a keystore, or a text of `ros2 node info`. What runs is written as a policy with its
    types. No file that is there is changed.
    """
    if schema:
        from rosprivacy.cli.output import emit
        from rosprivacy.cli.project_file import project_schema
        from rosprivacy.report.json_text import as_text

        emit(as_text(project_schema()), None)
        return
    inputs = inputs if inputs.policies or ros2 else inputs._replace(policies=_policies_here())
    if not (ros2 or inputs.policies):
        from rosprivacy.cli.folder_notice import folder_notice

        raise typer.BadParameter(f"{SOMETHING}. Here {folder_notice(Path.cwd())}", param_hint="POLICY")
    with as_policies(inputs, ros2=ros2) as read:
        policies = [ROBOT] if read.observed else [*(inputs.policies or ())]
        answers = _defaults(inputs, read, policies)._replace(author=by or "")
        if not from_try:
            answers = _answers_of_person(answers)
        _check_here([*policies, answers.labels, *answers.types])
        suggestions = _label_file(read, answers)
        files = _files(read, policies, answers, suggestions.text)
        _check_free(files)
        from rosprivacy.report.atomic import write_texts

        write_texts([(Path(name), text) for name, text in files.items()])
    print(f"written: {', '.join(map(shown, files))}")
    if line := line_about(answers.labels, files.get(answers.labels, "").splitlines()):
        print(line)
    print("Then: rosprivacy analyze")


def _policies_here() -> list[str]:
    """The policies of this folder."""
    return sorted(str(file) for file in Path().glob("*.policy.xml"))


def _defaults(inputs: Inputs, read: Read, policies: list[str]) -> ProjectAnswers:
    one = Path(policies[0]) if len(policies) == 1 and policies[0].endswith(".xml") else Path(ROBOT)
    labels = (inputs.labels or [named_after(one, "labels").name])[0]
    types = tuple(inputs.types or ()) + ((str(types_path(Path(ROBOT))),) if read.observed else ())
    return ProjectAnswers(labels, types=types)


def _answers_of_person(answers: ProjectAnswers) -> ProjectAnswers:
    """What a person answers; Enter takes what stands there."""
    if not sys.stdin.isatty():
        raise typer.BadParameter("it asks on a terminal: give --from-try to take what it proposes")
    try:
        labels = typer.prompt("Label file", answers.labels)
        author = typer.prompt("Who says what is in it (your name)", answers.author or None)
        lang = typer.prompt("Language of reports", answers.lang.value, type=Language)
        fail_on = typer.prompt("What `rosprivacy analyze` fails on", answers.fail_on.value, type=FailOn)
    except typer.Abort:  # it would end with 1, which says 'leak'
        raise typer.Exit(128 + SIGINT) from None
    return answers._replace(labels=labels, author=author, lang=lang, fail_on=fail_on)


def _files(read: Read, policies: list[str], answers: ProjectAnswers, labels: str) -> dict[str, str]:
    """Name and text of each file that is made."""
    made = {}
    if read.observed:
        made = {ROBOT: read.observed.policy.decode(), str(types_path(Path(ROBOT))): read.observed.types}
    if not Path(answers.labels).exists():
        made[answers.labels] = read.with_names(labels, ROBOT, str(types_path(Path(ROBOT))))
    return made | {OWN_FILE: _project_text(policies, answers)}


def _label_file(read: Read, answers: ProjectAnswers) -> LabelLines:
    """A label file in which nothing is said yet, with the suggestions that count in a trial as comments."""
    from rosprivacy.analysis.suggesting.trial import opening
    from rosprivacy.ingest.labels.label_writer import NEW
    from rosprivacy.labelling.knowledge import UserFiles
    from rosprivacy.labelling.suggested_lines import with_suggestions
    from rosprivacy.labelling.suggesting import suggest_labels
    from rosprivacy.systems.granted import code_folders

    there = read.inputs
    files = UserFiles(sources=code_folders(there.policies or ()))
    suggestions = suggest_labels(there.required_policies, tuple(there.labels or ()), there.settings, files)
    sourced = bool(suggestions.result.analysis.emitted)
    shown_in_trial = replace(suggestions, proposals=opening(suggestions.proposals, sourced=sourced))
    lines = with_suggestions(answers.labels, shown_in_trial)
    author = f"author: {json.dumps(blanked(answers.author, '?'), ensure_ascii=False)}\n" if answers.author else ""
    return replace(lines, text=lines.text.replace(NEW, NEW + author, 1))


def _project_text(policies: list[str], answers: ProjectAnswers) -> str:
    values: Mapping[str, object] = {
        "policies": policies,
        "labels": [answers.labels],
        "types": [*answers.types],
        "lang": answers.lang.value,
        "fail-on": [answers.fail_on.value],
    }
    lines = [f"{key} = {json.dumps(value, ensure_ascii=False)}\n" for key, value in values.items() if value]
    lines += [
        f"# types = [{json.dumps(str(file))}]  # lies there: name it if it is of this system\n"
        for file in map(types_path, map(Path, policies))
        if file.is_file() and str(file) not in answers.types
    ]
    return "".join(lines)


def _check_free(files: Mapping[str, str]) -> None:
    there = [name for name in files if Path(name).exists()]
    if there:
        hint = "remove it, or begin in another folder"
        raise InputErrors([InputError(name, 0, "is there already, and is not written over", hint) for name in there])


def _check_here(names: Sequence[str]) -> None:
    """A project file names files below itself only, in printable UTF-8."""
    root = os.path.realpath(os.curdir)
    problems = [
        InputError(name, 0, "lies outside of this folder", "begin in the folder that has it")
        for name in names if not name.startswith(SHIPPED) and leaves(name, root)
    ]  # fmt: skip
    problems += [
        InputError(name, 0, "a project file cannot have such a name in it", "rename the file")
        for name in names if not name.isprintable()
    ]  # fmt: skip
    if problems:
        raise InputErrors(problems)
