"""``rosprivacy categories``: the kinds of personal data that there are, and what the law says of each."""

from __future__ import annotations

from typing import Annotated

import typer

from rosprivacy.analysis.errors import InputErrors, OntologyError, shown
from rosprivacy.cli.options import Language, Ontologies, Output, complete_category
from rosprivacy.cli.output import emit


def categories(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            autocompletion=complete_category,
            show_default=False,
            help="Category to describe: name, title in any language, IRI or DPV term; without it, all are listed.",
        ),
    ] = None,
    tree: Annotated[bool, typer.Option("--tree", help="Print the category with all narrower ones.")] = False,
    lang: Annotated[Language, typer.Option(help="Language of names and texts.")] = Language.en,
    ontology: Ontologies = None,
    output: Output = None,
) -> None:
    """Print the kinds of personal data as a tree, or what is said of one: definition, Article 9, data types, label."""
    from rosprivacy.ontology.vocabulary import TOP, load
    from rosprivacy.report.text import categories as report

    vocabulary = load(ontologies=tuple(ontology or ()))
    found = vocabulary.find(name or TOP)
    if found is None:
        what = f"unknown category {shown(name or TOP)!r}"
        raise InputErrors([OntologyError("NAME", 0, what, vocabulary.hint(name or TOP))])
    if tree or name is None:
        emit(report.tree(vocabulary, found.name, lang.value), output)
    else:
        emit(report.details(vocabulary, found, lang.value), output)
