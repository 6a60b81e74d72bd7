"""``rosprivacy why-not``: why data of one element does not get to another, and on whose word."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import ASKED, Output, TextOrJson, complete_category
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.findings.why_not import WhyNot
    from rosprivacy.result import Result


@reads_system("policies, saved graphs or a fleet", without=("from_database", "neo4j", "decisions"))
def why_not(
    source: Annotated[
        str, typer.Argument(metavar="SOURCE", help="Where data comes in: a name; of a fleet robot:name.")
    ],
    leak: Annotated[
        str, typer.Argument(metavar="LEAK", help="Where it should not get: a name; of a fleet robot:name.")
    ],
    inputs: Inputs,
    categories: Annotated[
        list[str] | None,
        typer.Option(
            "--categories",
            "-c",
            metavar="NAME",
            autocompletion=complete_category,
            show_default=False,
            help="Ask about this kind only.",
            rich_help_panel=ASKED,
        ),
    ] = None,
    format: Annotated[TextOrJson, typer.Option("--format", "-f", help="Of the answer.")] = TextOrJson.text,  # noqa: A002 - the option's name
    output: Output = None,
) -> None:
    """Tell why data of one element does not get to another: where its way ends, and on whose word."""
    from rosprivacy.report.document.analysis import as_text
    from rosprivacy.report.document.why_not import document
    from rosprivacy.report.terminal.why_not import lines

    result = inputs.result(inputs.settings)
    answers = list(_answers(result, source, leak, tuple(categories or ())))
    text = as_text(document(answers)) if format is TextOrJson.json else "".join(f"{line}\n" for line in lines(answers))
    emit(text, output)


def _answers(result: Result, source: str, leak: str, asked: tuple[str, ...]) -> Iterator[WhyNot]:
    from rosprivacy.analysis.findings.why_not import why_not as explained

    found = result.analysis.spread
    ends = [_vertices(result, name) for name in (source, leak)]
    names = [category.name if (category := result.vocabulary.find(name)) else name for name in asked]
    unknown = [name for name in names if name not in found.categories]
    if unknown:
        emitted = ", ".join(found.categories) or "none"
        raise InputError("-c", 0, f"no source or derivation emits {shown(unknown[0])!r}", f"emitted are: {emitted}")
    begun = [name for name in found.categories if any(found.begins(v) & found.both(name) for v in ends[0])]
    for name in names or begun or found.categories:
        yield explained(result.analysis, ends[0], ends[1], name)
    if not found.categories:
        raise InputError(
            "labels", 0, "no label names a source", "say where data comes in: nodes: {/x: {source: [Video]}}"
        )


def _vertices(result: Result, written: str) -> list[int]:
    """The vertices that a name means; a node before a channel of the same name."""
    known: dict[str, list[int]] = {}
    elements = result.analysis.graph.elements
    for vertex, element in enumerate(elements):
        known.setdefault(element.full_name, []).append(vertex)
    if written not in known:
        close = get_close_matches(written, known, n=3, cutoff=0.5)
        hint = (
            f"did you mean {' or '.join(map(shown, close))}?"
            if close
            else "see the names with rosprivacy labels --init"
        )
        raise InputError("why-not", 0, f"no element is called {shown(written)!r}", hint)
    nodes = [vertex for vertex in known[written] if not elements[vertex].is_channel]
    return nodes or known[written]
