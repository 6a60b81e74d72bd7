"""``rosprivacy graph``: the two views as pictures, or as graphs for other programs."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import Language, Output, ViewOrBoth, ViewOrBothChosen
from rosprivacy.cli.output import emit, not_for_a_terminal
from rosprivacy.report.pictures.picture import LEGIBLE

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from rosprivacy.analysis.model import Profile
    from rosprivacy.report.pictures.phrases import Phrases
    from rosprivacy.report.pictures.picture import Key, Picture
    from rosprivacy.result import Result


class Shown(StrEnum):
    """Which of the two views."""

    ros = "ros"
    privacy = "privacy"


class PictureFormat(StrEnum):
    """Of the picture."""

    dot = "dot"
    svg = "svg"
    png = "png"
    graphml = "graphml"
    mermaid = "mermaid"


class Cluster(StrEnum):
    """What to draw together."""

    none = "none"
    enclave = "enclave"
    namespace = "namespace"
    robot = "robot"


class Direction(StrEnum):
    """Where the data goes on the paper."""

    right = "right"
    down = "down"


DRAWN = "What is drawn of it"  # panels of help
LAYOUT = "How it is drawn"
SUFFIXES = {".gv": PictureFormat.dot, ".mmd": PictureFormat.mermaid}


class PictureOptions(NamedTuple):
    """Which picture, and where it goes."""

    view: ViewOrBothChosen = ViewOrBoth.declared
    show: Annotated[
        Shown | None,
        typer.Option(
            show_default=False,
            help="The whole ROS graph, which is the default, or where personal data can go under the labels.",
        ),
    ] = None
    format: Annotated[
        PictureFormat | None,
        typer.Option("--format", "-f", show_default=False, help="Of the picture; by default what --output ends in."),
    ] = None
    output: Output = None


class DrawnPart(NamedTuple):
    """What is drawn of a view."""

    finding: Annotated[
        str | None,
        typer.Option(
            metavar="ID",
            show_default=False,
            help="Draw the paths of this finding only: a privacy view.",
            rich_help_panel=DRAWN,
        ),
    ] = None
    robot: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", show_default=False, help="Draw this robot and what it is joined to.", rich_help_panel=DRAWN
        ),
    ] = None
    around: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            show_default=False,
            help="Draw what is near this element; may be repeated.",
            rich_help_panel=DRAWN,
        ),
    ] = None
    steps: Annotated[
        int, typer.Option(min=0, help="How near, in lines, whatever their direction.", rich_help_panel=DRAWN)
    ] = 2
    largest: Annotated[
        int | None,
        typer.Option(
            "--most",
            min=1,
            show_default=False,
            help="Draw the shorter paths to leaks only, up to so many elements.",
            rich_help_panel=DRAWN,
        ),
    ] = None
    fold: Annotated[
        bool, typer.Option("--fold", help="Draw channels with the same ends as one.", rich_help_panel=DRAWN)
    ] = False
    loose_ends: Annotated[
        bool | None,
        typer.Option(
            "--loose-ends/--no-loose-ends",
            show_default=False,
            help="Draw channels that only one node names.",
            rich_help_panel=DRAWN,
        ),
    ] = None
    everything: Annotated[
        bool,
        typer.Option(
            "--all",
            help=f"Draw all of it. Without this, and where nothing else here is chosen, a picture of more than "
            f"{LEGIBLE} elements is drawn smaller and says what it leaves out; GraphML always has all.",
            rich_help_panel=DRAWN,
        ),
    ] = False

    @property
    def is_chosen(self) -> bool:
        """Whether a user chose any of it."""
        chosen = self.finding or self.robot or self.around or self.largest or self.fold
        return bool(chosen) or self.loose_ends is not None


class LayoutOptions(NamedTuple):
    """How it is drawn."""

    cluster: Annotated[Cluster, typer.Option(help="Draw together what belongs together.", rich_help_panel=LAYOUT)] = (
        Cluster.none
    )
    direction: Annotated[
        Direction | None,
        typer.Option(
            show_default=False,
            help="Where data goes on the paper. By default what can be drawn larger on a page; as text, right.",
            rich_help_panel=LAYOUT,
        ),
    ] = None
    seconds: Annotated[
        float,
        typer.Option(min=0.1, help="For the layout; when time runs out, this is an error.", rich_help_panel=LAYOUT),
    ] = 45.0


@reads_system("policies, saved graphs or a fleet", without=("from_database", "neo4j", "decisions"))
def graph(
    inputs: Inputs,
    options: PictureOptions,
    part: DrawnPart,
    layout: LayoutOptions,
    draw_standard_channels: Annotated[
        bool,
        typer.Option("--draw-standard-channels", help="Draw the standard ROS channels too.", rich_help_panel=DRAWN),
    ] = False,
    lang: Annotated[Language, typer.Option(help="Language of titles, notes and legend.")] = Language.en,
) -> None:
    """Draw the ROS graph, or where personal data can go in it. Gives no verdict: exit code 0 once it is drawn."""
    show, output = _shown(options.show, part), options.output
    form = _format(options.format, output)
    not_for_a_terminal(form.upper() if form is not PictureFormat.mermaid else "a drawing", output)
    result, own = _drawn_of(inputs.viewed(options.view), both_views=options.view is ViewOrBoth.both)
    picture = _view(result, show, part, lang, carried_only=bool(inputs.categories), standard=draw_standard_channels)
    if result.fleet and not part.finding:
        from rosprivacy.report.pictures.narrow import label, represented

        picture, likeness = represented(picture, result.fleet.likeness), result.fleet.likeness
        own = {label(name, likeness, picture.words): profiles for name, profiles in own.items()}
        part = part._replace(robot=label(part.robot, likeness, picture.words) if part.robot else None)
    picture = _narrowed(picture, part)
    if not part.everything and not part.is_chosen and form is not PictureFormat.graphml:
        picture = _legible(picture)
    if layout.cluster is not Cluster.none:
        from rosprivacy.report.pictures.narrow import grouped

        picture = grouped(picture, layout.cluster.value, result.analysis.graph.profiles, own)
    _write(picture, form, output, layout.direction, layout.seconds)


def _shown(show: Shown | None, part: DrawnPart) -> Shown:
    """The view that is asked for; some options are of one view only."""
    of_privacy = bool(part.finding or part.largest)
    if show is Shown.ros and of_privacy:
        raise typer.BadParameter("--finding and --most are for --show privacy")
    if part.everything and part.largest:
        raise typer.BadParameter("--all draws everything, --most does not: choose one of them")
    return show or (Shown.privacy if of_privacy else Shown.ros)


def _drawn_of(inputs: Inputs, *, both_views: bool) -> tuple[Result, dict[str, tuple[Profile, ...]]]:
    """The analysis, and of a fleet the profiles of each robot."""
    settings = inputs.settings
    if not inputs.fleet:
        return inputs.result(settings, both_views=both_views), {}
    from rosprivacy.answering import answer
    from rosprivacy.question import question_of
    from rosprivacy.systems.fleet_system import fleet_system

    question = question_of(settings)
    system = fleet_system(inputs.fleet, question)
    result = inputs.result(settings, both_views=True) if both_views else answer(system, question)
    return result, dict(system.placed.profiles)


def _format(option: PictureFormat | None, output: Path | None) -> PictureFormat:
    """Of the option, else of the file's name; DOT where there is neither."""
    if option or output is None:
        return option or PictureFormat.dot
    suffix = output.suffix.lower()
    if suffix[1:] in set(PictureFormat):
        return PictureFormat(suffix[1:])
    if suffix in SUFFIXES:
        return SUFFIXES[suffix]
    raise typer.BadParameter(f"what format is {output.name}? Name it with --format: {', '.join(PictureFormat)}")


def _view(
    result: Result, show: Shown, part: DrawnPart, language: Language, *, carried_only: bool, standard: bool
) -> Picture:
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.pictures import narrow, views
    from rosprivacy.report.pictures.phrases import Phrases

    words, kinds = Words(language.value), result.vocabulary.categories
    titles = {name: category.text("title", language.value) for name, category in kinds.items()}
    say = Phrases() if language is Language.en else Phrases.of_report(words, titles)
    beside = result.fleet.likeness.second if result.fleet else ()
    if show is Shown.privacy:
        if part.finding:
            return _finding(result, part.finding, views.PER_BOX * part.largest if part.largest else None, say)
        return _with_added(
            result, say, lambda also: views.privacy_view(PathsToLeaks(result.analysis), beside, say, also)
        )
    denials = [grant for policy in result.policies for grant in policy.grants if not grant.allow]
    picture = _with_added(
        result,
        say,
        lambda _: views.ros_view(result.analysis, denials, words, standard=standard, robots_not_shown=beside),
    )
    return narrow.carrying(picture, result.analysis) if carried_only else picture


def _with_added(result: Result, say: Phrases, draw: Callable[[Collection[Key]], Picture]) -> Picture:
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
    from rosprivacy.report.pictures.views import with_added

    if not result.enforced or not result.enforced.added:
        return draw(())
    return with_added(result.analysis, PathsToLeaks(result.enforced.answer.analysis), result.enforced.added, say, draw)


def _finding(result: Result, id_prefix: str, about: int | None, say: Phrases) -> Picture:
    """One that only the enforced view has is drawn of that view, with what no profile allows marked."""
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
    from rosprivacy.report.pictures import narrow, views
    from rosprivacy.report.pictures.views import marking

    added = [one.finding for one in result.enforced.added] if result.enforced else []
    if result.enforced and any(finding.id.startswith(id_prefix) for finding in added):
        finding = narrow.the_finding(replace(result.analysis, findings=tuple(added)), id_prefix)
        return marking(result.analysis)(
            views.finding_view(PathsToLeaks(result.enforced.answer.analysis), finding, about, say)
        )
    return views.finding_view(PathsToLeaks(result.analysis), narrow.the_finding(result.analysis, id_prefix), about, say)


def _narrowed(picture: Picture, part: DrawnPart) -> Picture:
    from rosprivacy.report.pictures import narrow, views

    if part.robot:
        picture = narrow.of_robot(picture, part.robot)
    if part.around:
        picture = narrow.around(picture, part.around, part.steps)
    if part.fold:
        picture = narrow.folded(picture)
    if part.loose_ends is False:
        picture = narrow.without_loose_ends(picture)
    return views.bounded(picture, part.largest) if part.largest else picture


def _legible(picture: Picture) -> Picture:
    """The picture, smaller where it is too large to be read; what is left out is said."""
    from rosprivacy.report.pictures.narrow import legible

    picture, left = legible(picture)
    for said in left:
        print(said, file=sys.stderr)
    return picture


def _write(
    picture: Picture, form: PictureFormat, output: Path | None, layout_direction: Direction | None, seconds: float
) -> None:
    direction = "TB" if layout_direction is Direction.down else "LR"
    if form in (PictureFormat.svg, PictureFormat.png):
        from rosprivacy.report.pictures.graphviz import drawn

        done = drawn(picture, form.value, direction=direction if layout_direction else "", seconds=seconds)
        for said in done.remarks:
            print(said, file=sys.stderr)
        emit(done.data, output)
        return
    if form is PictureFormat.graphml:
        from rosprivacy.report.pictures.exports import graphml

        emit(graphml(picture).encode(), output)
        return
    if form is PictureFormat.dot:
        from rosprivacy.report.pictures.dot import dot

        emit(dot(picture, direction=direction).encode(), output)
        return
    from rosprivacy.report.pictures.exports import mermaid, too_large

    text = mermaid(picture, direction=direction)
    if too_large(picture, text):
        said = "Mermaid draws no more than 500 lines or 50,000 characters as it is usually set: draw less"
        print(said, file=sys.stderr)
    emit(text.encode(), output)
