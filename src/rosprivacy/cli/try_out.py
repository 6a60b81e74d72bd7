"""``rosprivacy try``: from a robot to its worst ways out in one command, if suggestions are right."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING, Any

import typer

from rosprivacy.cli.exit_code import LEAK, UNDETERMINED
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.what_runs import Ros2, as_policies

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.labelling.trying import Trial
    from rosprivacy.report.text.line_parts import Line
    from rosprivacy.settings import Settings

NOT_ANSWERED = "undetermined: nobody has said that the suggestions are so"


@reads_system(
    "what one robot grants or runs",
    without=("fleet", "from_database", "neo4j", "add", "categories", "decisions", "type_limits"),
)
def try_out(inputs: Inputs, ros2: Ros2 = False) -> None:
    """Show where personal data would get out of a robot, if what names, types and packages suggest is right.

    POLICY is a policy, a folder, a keystore, a text of `ros2 node info`, a folder of sources, or a launch file. Nothing
    is written. The verdict is that of what labels say, and at best undetermined: it ends with 4, or with 1 if a leak is
    stated.
    """
    from rosprivacy.cli.output import emit, on_console
    from rosprivacy.labelling.knowledge import UserFiles
    from rosprivacy.labelling.trying import tried
    from rosprivacy.report.text.line_parts import wrapped
    from rosprivacy.systems.granted import code_roots
    from rosprivacy.systems.robot_system import answer_robot
    from rosprivacy.terminal_width import terminal_width

    with as_policies(inputs, ros2=ros2) as read:
        there, settings = read.inputs, read.inputs.settings
        code = code_roots(there.required_policies)
        labels = (*(there.labels or ()), *_of_code(code.values(), settings))
        stated = answer_robot(there.required_policies, labels, settings)
        trial = tried(stated, settings, UserFiles(sources=[folder for folder, _ in code.values()]))
    lines = [(read.with_names(text), style) for text, style in _lines(trial)]
    lines.append((_next_command(inputs, ros2=ros2), "bold"))

    def write(console: Any) -> None:
        from rich.text import Text

        for text, style in wrapped(lines, terminal_width()):
            console.print(Text(text, style), soft_wrap=True)

    emit(on_console(write, colour=True), None)
    stands = any(finding.stands for finding in trial.stated.analysis.findings)
    raise typer.Exit(LEAK if stands else UNDETERMINED)


def _of_code(code: Iterable[tuple[str, str]], settings: Settings) -> Iterator[Labels]:
    """What code and files of a checkout state of the world outside ROS, as labels."""
    from rosprivacy.ingest.scan.code_roots import read_as_one

    for folders, launch in read_as_one(code):
        from rosprivacy.ingest.labels.label_file import parse_labels
        from rosprivacy.ontology.vocabulary import load
        from rosprivacy.scanning import scan

        text = scan(*folders, launch=launch).labels
        if text:
            name = f"what the code of {', '.join(folders)} states"
            yield parse_labels(text, load(ontologies=settings.ontologies), name=name)


def _lines(trial: Trial) -> Iterator[Line]:
    from rosprivacy.report.suggested_labels.trial_lines import trial_lines
    from rosprivacy.report.verdict import verdict_sentence

    stated = trial.stated
    nodes = sum(element.is_node for element in stated.analysis.graph.elements)
    yield from trial_lines(
        nodes, trial.supposed, trial.left_out, trial.unsure, trial.ways, trial.ends, trial.unreached, trial.unknown,
        stated.doubts, stated.vocabulary.categories,
    )  # fmt: skip
    yield "", ""
    if stated.analysis.verdict == "leak":
        yield verdict_sentence(stated.verdict_facts()), "bold red"
    else:
        yield NOT_ANSWERED, "bold yellow"


def _next_command(inputs: Inputs, *, ros2: bool) -> str:
    """What keeps the suggestions, to confirm or refuse each."""
    words = ["--ros2"] if ros2 else [shlex.quote(name) for name in inputs.policies or ()]
    words += [f"-l {shlex.quote(name)}" for name in inputs.labels or ()]
    return f"To keep them and answer them one by one: rosprivacy init --from-try {' '.join(words)}"
