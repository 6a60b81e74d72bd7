"""``rosprivacy decisions``: the log of decisions, shown, verified, joined with another, or begun from an old file."""

from __future__ import annotations

import re
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.errors import DecisionError, InputErrors, shown
from rosprivacy.cli.exit_code import LEAK
from rosprivacy.cli.help import HelpGroup
from rosprivacy.cli.options import Ontologies
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.ingest.decisions.decision_chain import ChainEntry

HEAD = re.compile(r"[0-9a-f]{16,64}")
UNKNOWN = (
    "without --head nobody can tell whether entries were removed from the end, or the whole log was written anew; "
    "give the head that a report printed, or that somebody signed"
)
app = typer.Typer(cls=HelpGroup, no_args_is_help=True)
Log = Annotated[Path, typer.Argument(metavar="LOG", help="The log of decisions.")]
DEFAULT = Path("decisions.jsonl")


@app.command()
def show(
    log: Log = DEFAULT,
    head: Annotated[
        bool, typer.Option("--head", help="Only the hash of the last entry, to be printed or signed.")
    ] = False,
) -> None:
    """Show the head of the log, and what was decided about each target, by whom, and when."""
    from rosprivacy.ingest.decisions.decision_chain import heads, read_chain

    entries = read_chain(str(log), _bytes(log))
    lines = [heads(entries)] if head else [f"head {heads(entries)}, {_count(entries)}", *_histories(entries)]
    emit("".join(f"{line}\n" for line in lines), None)


@app.command()
def verify(
    log: Log = DEFAULT,
    head: Annotated[
        str | None,
        typer.Option(metavar="HASH", show_default=False, help="The head of an earlier day, or its first 16 digits."),
    ] = None,
) -> None:
    """Name each entry that was changed, moved or removed; ends with 1 if there is one."""
    from rosprivacy.ingest.decisions.decision_chain import RESTORE, examine, heads

    if head is not None and not HEAD.fullmatch(head):
        raise typer.BadParameter(f"{head!r} is no head: give 16 to 64 digits and letters", param_hint="--head")
    entries, problems = examine(_bytes(log), head or "")
    for problem in problems:
        print(DecisionError(str(log), problem.line, problem.problem, RESTORE), file=sys.stderr)
    if problems:
        raise typer.Exit(LEAK)
    later = len(entries) - 1 - next((i for i, entry in enumerate(entries) if entry.hash.startswith(head or "")), 0)
    known = f"{later} written since the head that was given" if head else UNKNOWN
    answer = f"{shown(str(log))}: {_count(entries)}, each of which follows on the one before; {known}\n"
    emit(f"{answer}head {heads(entries)}\n", None)


@app.command()
def merge(
    ours: Annotated[Path, typer.Argument(metavar="OURS", help="The log that gets what both say.")],
    theirs: Annotated[Path, typer.Argument(metavar="THEIRS", help="A log that begins as the first one does.")],
) -> None:
    """Join two logs that begin alike, as branches of git do; where they decided differently, nothing is decided."""
    from rosprivacy.decision_record import provenance
    from rosprivacy.ingest.decisions.decision_log import merged
    from rosprivacy.report.atomic import editing

    with editing(ours):
        text, undecided = merged(str(ours), _bytes(ours), str(theirs), _bytes(theirs), provenance(ours.parent))
        for target in undecided:
            print(f"both decided differently, so nothing is decided; decide anew: {shown(target)}", file=sys.stderr)
        emit(f"{shown(str(ours))}: joined with {shown(str(theirs))}\n", None, {ours: text}, edited=ours)


@app.command()
def take_over(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A decisions file, such as decisions.yaml.")],
    log: Annotated[Path, typer.Option("--output", "-o", metavar="LOG", help="The new log.")] = DEFAULT,
    ontology: Ontologies = None,
) -> None:
    """Begin a log with what a decisions file says; the file stays, and is read no more where the log is named."""
    from rosprivacy.analysis.errors import InputError
    from rosprivacy.decision_record import provenance
    from rosprivacy.ingest.decisions.decision_log import is_log, parse_log, taken_over
    from rosprivacy.ingest.decisions.decisions_file import read_decisions
    from rosprivacy.ingest.reading.format_reader import read_values
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.report.atomic import editing

    if not is_log(str(log)):
        raise typer.BadParameter("the name of a log ends in .jsonl", param_hint="--output")
    vocabulary = load(ontologies=tuple(ontology or ()))
    before = read_decisions(str(file), vocabulary, "")
    top, _ = read_values(str(file), partial(DecisionError, str(file)))
    with editing(log):
        if log.exists():
            raise InputError(str(log), 0, "is there already", "name another log")
        text = taken_over(top, {"file": file.name, "sha256": before.sha256}, provenance(log.parent))
        count = len(parse_log(str(log), text.encode(), vocabulary, "").entries)
        if count != len(before.entries):
            raise InputErrors([DecisionError(str(file), 0, "cannot be taken over whole", "decide by hand, one by one")])
        answer = f"{shown(str(log))}: took over {count} of {shown(str(file))}; name the log where the file was named\n"
        emit(answer, None, {log: text}, edited=log)


def _bytes(log: Path) -> bytes:
    from rosprivacy.ingest.reading.bounded_file import read_regular
    from rosprivacy.ingest.reading.yaml_values import MAX_BYTES

    return read_regular(str(log), MAX_BYTES, partial(DecisionError, str(log)))


def _count(entries: Sequence[ChainEntry]) -> str:
    return "1 entry" if len(entries) == 1 else f"{len(entries)} entries"


def _histories(entries: Sequence[ChainEntry]) -> Iterator[str]:
    """Each target with its entries; what is decided about it now is the last of them, if it is decided at all."""
    from rosprivacy.ingest.decisions.decision_log import logged_step, standing

    for target, state in standing(entries).items():
        yield shown(target) + ("" if state.entry else ": nothing is decided now")
        for step in map(logged_step, state.steps):
            facts = ((key, getattr(step, key)) for key in ("owner", "condition", "expires", "reason"))
            words = "".join(f"; {key}: {shown(value)}" for key, value in (*facts, *step.answers) if value)
            yield f"  {step.hash[:16]}  {step.when}  {shown(step.decision)}{words}; written by {step.account}"
