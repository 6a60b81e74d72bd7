"""``rosprivacy suggest``: what elements could be labelled as, each with its reasons."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from rosprivacy.analysis.text import counted, printable
from rosprivacy.cli.inputs import Inputs, reads_system, refuse
from rosprivacy.cli.model_options import ModelOptions
from rosprivacy.cli.options import NOT_USED, Output, TextOrJson
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rosprivacy.labelling.knowledge import UserFiles
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.result import Result


class EvidenceFiles(NamedTuple):
    """More that suggestions are made by."""

    rules: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE",
            help="More rules about names, in the format of ontology/names.yaml; may be repeated.",
            show_default=False,
        ),
    ] = None
    packages: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE|DIR|ament",
            help="More packages, in the format of ontology/packages; 'ament' for those that installed packages ship; "
            "may be repeated.",
            show_default=False,
        ),
    ] = None
    source: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SRC",
            help="Python and C++ source code of nodes, whose literal names and types, and uses of libraries, are "
            "evidence; may be repeated.",
            show_default=False,
        ),
    ] = None
    libraries: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE",
            help="More rules about libraries, in the format of ontology/libraries.yaml; may be repeated.",
            show_default=False,
        ),
    ] = None


class AnswerOptions(NamedTuple):
    """Where answers go."""

    into: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Write the suggestions into this label file, as comments that 'labels --accept' reads.",
            show_default=False,
        ),
    ] = None
    ask: Annotated[
        bool,
        typer.Option(
            "--ask",
            help="Ask at a terminal about one element a screen, answered by single keys, and write each answer into "
            "the file of --into. Standard input that is no terminal is keys that answer questions about several "
            "elements.",
        ),
    ] = False
    by: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Who answers with --ask; by default the author of the file."),
    ] = None


@reads_system("all kinds, types and findings", without=("categories", "decisions"))
def suggest(
    inputs: Inputs,
    evidence: EvidenceFiles,
    answers: AnswerOptions,
    model: ModelOptions,
    why: Annotated[
        str | None,
        typer.Option(metavar="NAME", show_default=False, help="Tell all reasons for what is suggested of an element."),
    ] = None,
    format: Annotated[TextOrJson, typer.Option("--format", "-f", help="Of the answer.")] = TextOrJson.text,  # noqa: A002 - the option's name
    output: Output = None,
) -> None:
    """Say what nodes and channels could be labelled as, with reasons: questions, in the order of review.

    Nothing is applied, in a database neither. 'rosprivacy labels --accept' makes labels of those that a person accepts.
    """
    from rosprivacy.labelling.by_type_lines import with_offer
    from rosprivacy.labelling.knowledge import UserFiles
    from rosprivacy.labelling.suggesting import suggested
    from rosprivacy.systems.granted import code_folders
    from rosprivacy.terminal_width import terminal_width

    into, stored = answers.into, inputs.given_options("fleet", "from_database")
    model.check(into)
    refuse("suggest", "the table of types", ["--type-limits none"] if inputs.type_limits == NOT_USED else [])
    refuse("suggest", "--by with --ask only", ["--by"] if answers.by and not answers.ask else [])
    unasked = into is None or output or format is TextOrJson.json or model.model or model.replay or model.dry_run
    if answers.ask and unasked:
        raise typer.BadParameter("--ask needs --into FILE; it takes neither --output, --format json nor a model")
    if why is not None:
        json_too = ["--format json"] if format is TextOrJson.json else []
        refuse("--why", "what is suggested", [*(["--into"] if into else []), *json_too])
    if model.model or model.replay:
        refuse("--model" if model.model else "--replay", "the policies of one robot", stored)
    if into:
        refuse("--into", "the label file of one robot (what you accept of a fleet's, write into its own)", stored)
    labels = _with_own(tuple(inputs.labels or ()), into)
    sources = [*(evidence.source or ()), *code_folders(inputs.policies or ())]
    files = UserFiles(evidence.rules or (), evidence.packages or (), sources, evidence.libraries or ())
    if answers.ask and into:
        _ask(into, inputs, files, answers.by)
        return
    if model.dry_run:
        emit(_would_be_sent(inputs, labels, files.sources, model), output)
        return
    with model.interview(output) as interview:

        def progress() -> Suggested:
            found = suggested(_result(inputs._replace(labels=list(labels))), inputs.settings, files, interview)
            return found if why is not None else with_offer(found, inputs.settings)

        if into:
            _write(into, progress)
        else:
            emit(_answer(progress(), format, why, terminal_width() if output is None else None), output)


def _answer(suggested: Suggested, format_: TextOrJson, why: str | None, width: int | None) -> str:
    from rosprivacy.report.json_text import as_text
    from rosprivacy.report.suggested_labels.suggestion_lines import of_element, suggestion_lines, why_lines
    from rosprivacy.report.text.line_parts import wrapped

    document = suggested.document()
    if format_ is TextOrJson.json:
        return as_text(document)
    lines = suggestion_lines(document) if why is None else why_lines(of_element(document, why))
    return "".join(f"{line}\n" for line, _ in wrapped(((line, "") for line in lines), width))


def _would_be_sent(inputs: Inputs, labels: tuple[str, ...], sources: Sequence[str], options: ModelOptions) -> str:
    """Every request as it would go out, but for the key."""
    from rosprivacy.labelling.model_interview import NOTHING_ASKED, asked_of, mask_of
    from rosprivacy.labelling.suggesting import basis_of
    from rosprivacy.systems.robot_system import answer_robot

    asking = options.asking
    basis = basis_of(answer_robot(inputs.required_policies, labels, inputs.settings), sources)
    asked = asked_of(basis, asking, mask_of(basis.result.vocabulary) if asking.masked else None)
    texts = (f"POST {asking.url}\n{one.body.decode('ascii')}\n" for one in asked)
    return "".join(texts) or f"{NOTHING_ASKED}\n"


def _result(inputs: Inputs) -> Result:
    """The answer about the system that is named; a database is read, and nothing is written there."""
    if not inputs.from_database:
        return inputs.result(inputs.settings)
    from rosprivacy.cli.driver import driver_of
    from rosprivacy.systems.stored_system import answer_unwritten

    with driver_of(inputs.neo4j) as driver:
        return answer_unwritten(driver, inputs.settings)


def _with_own(labels: tuple[str, ...], into: Path | None) -> tuple[str, ...]:
    """The label files, with the one that is written into: what it says already is not asked again."""
    if into is None or not into.is_file() or any(Path(one).exists() and into.samefile(one) for one in labels):
        return labels
    return (*labels, str(into))


def _write(file: Path, progress: Callable[[], Suggested]) -> None:
    """The suggestions into a label file, in place of those that an earlier run has written there."""
    from rosprivacy.labelling.suggested_lines import with_suggestions
    from rosprivacy.report.atomic import editing

    with editing(file):
        found = progress()
        written = with_suggestions(str(file), found)
        emit(written.text, file, edited=file)
    for notice in found.notices:
        typer.echo(f"{notice.place}: {printable(notice.message)}", err=True)
    typer.echo(f"{file}: {counted(written.added, 'suggestion')}, as comments", err=True)


def _ask(file: Path, inputs: Inputs, files: UserFiles, by: str | None) -> None:
    """Ask until nothing is left to ask; each answer is in the file before the next screen or question."""
    from rosprivacy.cli.asking.dialogue import ask
    from rosprivacy.labelling.suggesting import suggest_labels

    def progress() -> Suggested:
        labels = _with_own(tuple(inputs.labels or ()), file)
        return suggest_labels(inputs.required_policies, labels, inputs.settings, files)

    ask(file, progress, by, inputs.settings)
