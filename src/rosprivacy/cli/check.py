"""``rosprivacy check``: what a policy says and what is deployed; what descriptions say and what code does."""

from __future__ import annotations

from typing import Annotated

import typer

from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.cli.exit_code import LEAK, UNDETERMINED
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import Output, TextOrJson
from rosprivacy.cli.output import emit


class FailOnCheck(StrEnum):
    """What ends with exit code 1."""

    difference = "difference"
    exposure = "exposure"


@reads_system(
    "a policy and what is deployed",
    without=(
        "policies", "labels", "fleet", "from_database", "neo4j", "add", "ontology", "standard_channels",
        "types", "type_limits", "categories", "category", "view", "decisions", "project", "no_project",
    ),
)  # fmt: skip
def check(
    policy: Annotated[
        str,
        typer.Argument(
            metavar="POLICY",
            help="What is meant: an SROS 2 policy, or a folder of such; or descriptions of nodes (NoDL).",
        ),
    ],
    deployed: Annotated[
        list[str],
        typer.Argument(
            metavar="DEPLOYED",
            help="A keystore, permissions and governance files, or Zenoh configurations; or the folder of sources of "
            "described nodes.",
        ),
    ],
    inputs: Inputs,
    format: Annotated[TextOrJson, typer.Option("--format", "-f", help="Of the answer.")] = TextOrJson.text,  # noqa: A002 - the option's name
    fail_on: Annotated[
        FailOnCheck,
        typer.Option(
            "--fail-on", help="End with 1 on a difference; with exposure also if the governance leaves anything open."
        ),
    ] = FailOnCheck.difference,
    output: Output = None,
) -> None:
    """Compare a policy with what is deployed: which rights only one of them has, by enclave, each with its line.

    With descriptions of nodes and a folder of sources (the same one may be named twice): what only one of them says.

    Ends with 1 if there is a difference, with 4 if there is none but more may be allowed than can be compared.
    """
    from rosprivacy.checking import check_document
    from rosprivacy.report.compare.deployment_lines import deployment_lines
    from rosprivacy.report.json_text import as_text

    document = check_document(policy, tuple(deployed), inputs.settings)
    lines = "".join(f"{line}\n" for line in deployment_lines(document))
    emit(as_text(document) if format is TextOrJson.json else lines, output)
    if document["differences"] or (fail_on is FailOnCheck.exposure and document["exposed"]):
        raise typer.Exit(LEAK)
    if document["undetermined"]:
        raise typer.Exit(UNDETERMINED)
