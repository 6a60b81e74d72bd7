"""Analysis -> the two views as pictures: the ROS graph, and where personal data can go.

In: an ``Analysis``, with its paths to leaks. Out: a ``Picture``, with nothing of it left out in silence: of a whole
view, of one finding, of the shortest paths of several. What the enforced view adds is drawn dashed, along the paths of
findings that it adds, not all that the middleware lets through (rule S6).

Source: the paper, section II-B, for what the views hold and for their colours. Two things differ. A sanitizer is gone
from the privacy view only where it ends all that comes to it: one that pseudonymises passes data on (rule S8). And all
flows on paths to leaks are marked, not only of paths that share no edge, since which of these are found is chance.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.findings.beyond import granted
from rosprivacy.analysis.many_flows import one_by_one
from rosprivacy.analysis.model import GOES_NOWHERE, NO_LEAK_NAMED
from rosprivacy.analysis.text import shortened
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, plain
from rosprivacy.report.finding_facts import making
from rosprivacy.report.naming import count_elements
from rosprivacy.report.pictures.looks import ALLOWED, BEYOND, DENIED, MATCHES, ONWARD, SHORTEST
from rosprivacy.report.pictures.phrases import Phrases, listed
from rosprivacy.report.pictures.picture import (
    PRIVACY,
    ROS,
    Box,
    Picture,
    PictureLine,
    order,
    sorted_boxes,
    sorted_lines,
)
from rosprivacy.report.pictures.privacy import FlowLines, ReachedElements, data_lines, ends_of_flow

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.beyond import Added
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
    from rosprivacy.analysis.model import FlowGraph, Grant
    from rosprivacy.report.pictures.picture import Key

PER_BOX = 12  # flows that are looked at for each box: channels with the same ends will be one
LACKING = (GOES_NOWHERE, NO_LEAK_NAMED)
BOTH_WAYS = {"request", "reply", "call", "execute"}


def ros_view(
    analysis: Analysis,
    denials: Iterable[Grant] = (),
    words: Words = IN_ENGLISH,
    *,
    standard: bool = False,
    robots_not_shown: Collection[str] = (),
) -> Picture:
    """Return the whole system: every element and every grant.

    Parameters
    ----------
    denials
        Grants of the policies; those that deny are drawn even where nothing allows what they deny.
    words
        Of the reader's language.
    standard
        Whether to draw the standard ROS channels too (rule S13).
    robots_not_shown
        Robots that stand beside others like them (``fleet_view.represented`` draws one for both): none of them counts.
    """
    graph = analysis.graph
    hidden = set() if standard else {graph.elements[vertex].identity for vertex in analysis.spread.standard}
    boxes = {e.identity: Box.of(e, e.kind) for e in graph.elements if e.identity not in hidden}
    for element, types in analysis.types.items():
        if element.identity in boxes:
            boxes[element.identity] = replace(boxes[element.identity], types=types)
    covered: dict[Key, set[Key]] = defaultdict(set)
    lines = FlowLines(boxes)
    for flow in graph.flows:
        if flow.role == "matches":
            one, other = ends_of_flow(analysis, flow)
            covered[one].add(other)
            covered[other].add(one)
        lines.add(*ends_of_flow(analysis, flow), MATCHES if flow.role == "matches" else ALLOWED, flow.role, flow.grants)
    for flow in graph.denied:
        lines.add(*ends_of_flow(analysis, flow), DENIED, flow.role, flow.denials)
    effective = {grant for flow in graph.denied for grant in flow.denials}
    denying = [grant for grant in denials if not grant.allow and not grant.dead]
    undrawn = sum(not _deny(lines, grant, graph, hidden) and grant not in effective for grant in denying)
    for key in boxes.keys() & covered.keys():
        if boxes[key].pattern:
            boxes[key] = replace(boxes[key], words=(words.count(len(covered[key] - {key}), "picture.covers"),))
    kinds = _inventory([key for key in boxes if key[0] not in robots_not_shown], words)
    title = plain(words("picture.ros", view=str(graph.view), kinds=kinds))
    hidden = {key for key in hidden if key[0] not in robots_not_shown}
    notes = _left_out(hidden, undrawn, words, robots=len({element.robot for element in graph.elements}))
    return Picture(ROS, title, sorted_boxes(boxes.values()), lines.drawn_lines(), notes, words=words)


def _deny(lines: FlowLines, grant: Grant, graph: FlowGraph, hidden: Collection[Key]) -> bool:
    """A DENY by itself is no flow; it is drawn where there is a channel of that name. Return whether it was."""
    robots = {element.robot for element in graph.elements}
    if len(robots) > 1:  # a policy line does not say whose it is
        return False
    robot = next(iter(robots), "")
    node, channel = (robot, "node", grant.node), (robot, grant.kind, grant.name)
    if grant.role in BOTH_WAYS or grant.role == "publish":
        lines.add(node, channel, DENIED, grant.role, (grant,))
    if grant.role in BOTH_WAYS or grant.role == "subscribe":
        lines.add(channel, node, DENIED, grant.role, (grant,))
    return channel in lines.boxes or channel in hidden


def _inventory(keys: Iterable[Key], words: Words) -> str:
    kinds: dict[str, int] = defaultdict(int)
    for key in sorted(keys, key=order):
        kinds[key[1]] += 1
    counts = ", ".join(words.count(number, f"picture.kind.{kind}") for kind, number in kinds.items())
    return counts or words("picture.empty")


def _left_out(hidden: Collection[Key], undrawn: int, words: Words, *, robots: int) -> tuple[str, ...]:
    notes = [words.count(len(hidden), "picture.standard")] if hidden else []
    if undrawn:
        notes.append(words.count(undrawn, "picture.denies.idle" if robots > 1 else "picture.denies"))
    return tuple(map(plain, notes))


def privacy_view(
    paths: PathsToLeaks, robots_not_shown: Collection[str] = (), say: Phrases | None = None, drawn: Collection[Key] = ()
) -> Picture:
    """Return what some category reaches, with the paths to leaks marked.

    Parameters
    ----------
    robots_not_shown
        As in ``ros_view``.
    say
        The words, and what kinds of data are called.
    drawn
        What the caller draws beside it: it is not told as left out.

    Notes
    -----
    Besides what the analysis took: per category with a finding O(flows), see ``flows_to_leaks``.
    """
    say, analysis = say or Phrases(), paths.analysis
    words, reached = say.words, ReachedElements(analysis, say=say)
    if not reached.sources():
        return Picture(PRIVACY, plain(words("picture.nothing")), (), (), words=words)
    boxes = {box.key: box for box in reached.boxes()}
    open_findings = [finding for finding in analysis.findings if not finding.dismissed]
    flows = range(len(one_by_one(analysis.graph.flows)))
    lines = data_lines(reached, boxes, flows, paths.shortest, pairs(open_findings))
    what = listed(map(say.title, analysis.emitted), limit=6, words=words)
    unreviewed = count_elements(q.element for q in analysis.open if q.element.robot not in robots_not_shown).elements
    findings, elements = words.count(len(open_findings), "terminal.finding"), words.count(unreviewed, "element")
    title = words("picture.privacy", what=what, view=str(analysis.graph.view), verdict=_verdict(analysis, words))
    notes = (
        words("picture.count", findings=findings, elements=elements),
        *reached.left_out(words, robots_not_shown, drawn),
    )
    shown = tuple(in_words(finding, say) for finding in open_findings)
    boxes_drawn, told = sorted_boxes(boxes.values()), tuple(map(plain, notes))
    return Picture(PRIVACY, plain(title), boxes_drawn, lines.drawn_lines(), told, shown, core(open_findings), words)


def _verdict(analysis: Analysis, words: Words) -> str:
    lacks = analysis.verdict is Verdict.UNDETERMINED and not analysis.open and analysis.lacking in LACKING
    return words(f"picture.lacking.{analysis.lacking}" if lacks else f"picture.verdict.{analysis.verdict}")


class FindingViews:
    """Pictures of findings; what they share is made once.

    Parameters
    ----------
    say
        The words on the boxes.

    Notes
    -----
    O(flows) to begin with, and per finding what ``flows_to_leaks`` takes.
    """

    def __init__(self, paths: PathsToLeaks, say: Phrases | None = None) -> None:
        self._paths, self._analysis, self._say = paths, paths.analysis, say or Phrases()
        self._reached: dict[str, ReachedElements] = {}

    def of(self, finding: Finding, about: int | None = None) -> Picture:
        """Return the paths of one finding, from its source to its leak: the shortest, and the longer ones.

        A dismissed one shows its paths through other leaks. What else the data reaches is in the privacy view.

        Parameters
        ----------
        about
            Take only the shorter paths, with about so many flows: on a large graph much quicker. None for all.
        """
        category, graph = finding.category, self._analysis.graph
        if category not in self._reached:
            self._reached[category] = ReachedElements(self._analysis, {category}, self._say)
        reached = self._reached[category]
        found = self._paths.of(finding, about)
        lengths = found.flows
        keys = {element.identity for element in finding.witness}
        for index in lengths:
            keys |= set(ends_of_flow(self._analysis, graph.flows[index]))
        boxes = {box.key: box for box in reached.boxes(keys)}
        lines = data_lines(reached, boxes, lengths, lengths, pairs([finding]))
        words = self._say.words
        title = self._title(finding)
        notes = [words("picture.finding", id=finding.id)]
        if finding.dismissed:
            through = listed((element.name for element in finding.through), longest=60, words=words)
            notes.append(words("picture.through", names=through))
        if (n := finding.number_of_paths or 1) > 1:
            notes.append(words("picture.disjoint", n=n))
        if not found.complete:
            notes.append(words("picture.longer", steps=words.count(max(lengths.values()), "step")))
        ways = (in_words(finding, self._say),)
        told = tuple(map(plain, notes))
        ordered = sorted_boxes(boxes.values())
        return Picture(PRIVACY, plain(title), ordered, lines.drawn_lines(), told, ways, core([finding]), words)

    def _title(self, finding: Finding) -> str:
        """How its data can get there; what is made on the way, its source never has."""
        of, by = making(finding)
        made = {"of": self._say.title(of), "makers": listed((e.name for e in by), longest=60, words=self._say.words)}
        return self._say.words(
            "picture.finding.made" if by else "picture.finding.of",
            data=_data(finding, self._say),
            source=shortened(finding.source.name, 60),
            leak=shortened(finding.leak.name, 60),
            view=str(self._analysis.graph.view),
            **(made if by else {}),
        )


def is_cut(note: str, words: Words) -> bool:
    """Return whether a note says that longer paths are not drawn."""
    return note.startswith(plain(words.places("picture.longer")).partition("{")[0])


def finding_view(
    paths: PathsToLeaks, finding: Finding, about: int | None = None, say: Phrases | None = None
) -> Picture:
    """Return the paths of one finding, see ``FindingViews``."""
    return FindingViews(paths, say).of(finding, about)


def bounded(picture: Picture, limit: int) -> Picture:
    """Return the privacy view with the shorter paths to leaks only, so that it has no more boxes than asked for.

    The shortest path of each finding is always there; what was left out is said.
    """
    if len(picture.boxes) <= limit:
        return picture
    lines = [line for line in picture.lines if line.look == SHORTEST]
    what = picture.say("picture.shortest")
    for length in sorted({line.length for line in picture.lines if line.length}):
        longer = [line for line in picture.lines if 0 < line.length <= length or line.look == SHORTEST]
        if len(_joined(longer) | picture.core) > limit:
            break
        lines, what = longer, picture.say("picture.up.to", steps=picture.count(length, "step"))
    kept = _joined(lines) | picture.core
    left = len(picture.boxes) - len(kept)
    if not left and len(lines) == len(picture.lines):
        return picture
    notes = tuple(note for note in picture.notes if not is_cut(note, picture.words))
    known = left and len(notes) == len(picture.notes)
    undrawn = picture.count(left, "element") if known else picture.say("picture.what.is")
    note = picture.say("picture.beside", what=undrawn, paths=what)
    return replace(picture, notes=notes, lines=tuple(lines)).part(kept, note)


def _joined(lines: Iterable[PictureLine]) -> set[Key]:
    return {key for line in lines for key in (line.source, line.target)}


def pairs(findings: Iterable[Finding]) -> set[tuple[Key, Key]]:
    """Return the steps of the shortest paths."""
    return {(step.source.identity, step.target.identity) for finding in findings for step in finding.steps}


def core(findings: Iterable[Finding]) -> frozenset[Key]:
    """Return the elements of the shortest paths."""
    return frozenset(element.identity for finding in findings for element in finding.witness)


def in_words(finding: Finding, say: Phrases | None = None) -> str:
    """Return a finding's shortest path as a sentence."""
    say = say or Phrases()
    names = say.words("picture.to").join(shortened(element.name, 60) for element in finding.witness)
    return plain(say.words("picture.way", data=_data(finding, say), names=names))


def _data(finding: Finding, say: Phrases) -> str:
    title = say.title(finding.category)
    return say.words("terminal.hidden", kind=title) if finding.pseudonymised else title


def overview(analysis: Analysis, findings: Sequence[Finding], say: Phrases | None = None) -> Picture:
    """Return the shortest paths of findings.

    Complexity: O(flows + elements).
    """
    reached = ReachedElements(analysis, {finding.category for finding in findings}, say)
    steps = {(step.source, step.target) for finding in findings for step in finding.steps}
    elements = analysis.graph.elements
    flows = [
        number
        for number, flow in enumerate(analysis.graph.flows)
        if (elements[flow.source], elements[flow.target]) in steps
    ]
    boxes = {box.key: box for box in reached.boxes(core(findings))}
    lines = data_lines(reached, boxes, flows, dict.fromkeys(flows, 1), pairs(findings))
    words = tuple(in_words(finding) for finding in findings)
    return Picture(PRIVACY, "", sorted_boxes(boxes.values()), lines.drawn_lines(), (), words, core(findings))


def drawable(findings: Sequence[Finding], limit: int) -> int:
    """Return how many findings, from the first on, have no more elements together than asked for; one at least."""
    count = min(len(findings), 1)
    while count < len(findings) and len(core(findings[: count + 1])) <= limit:
        count += 1
    return count


BOUND = 16  # boxes of the paths of one finding, unless the shortest is longer


def marking(analysis: Analysis) -> Callable[[Picture], Picture]:
    """Return what marks the steps of a picture that no profile allows, by the flows of the declared view."""
    declared = frozenset(key[:3] for key in granted(analysis.graph))  # a box is of both sides of a wildcard

    def marked(picture: Picture) -> Picture:
        lines = (replace(line, look=BEYOND) if _is_beyond(line, declared) else line for line in picture.lines)
        return replace(picture, lines=sorted_lines(lines))

    return marked


def _is_beyond(line: PictureLine, declared: Collection[tuple[Key, Key, str]]) -> bool:
    return bool(line.places) and all((line.source, line.target, role) not in declared for role in line.roles)


def with_added(
    declared: Analysis,
    enforced: PathsToLeaks,
    added: Collection[Added],
    say: Phrases,
    draw: Callable[[Collection[Key]], Picture],
) -> Picture:
    """Return a picture of the declared view with the paths of what the enforced view adds.

    In the ROS view these are the steps that no profile allows; in the privacy view also where data goes on then.

    Parameters
    ----------
    declared, enforced
        The system under both views, the enforced one with its paths to leaks.
    added
        What the enforced view adds.
    draw
        Draws the declared view; it gets what will be drawn beside it.
    """
    marked, views = marking(declared), FindingViews(enforced, say)
    more = [marked(views.of(one.finding, PER_BOX * BOUND)) for one in added]
    more_boxes: dict[Key, Box] = {box.key: box for each in more for box in each.boxes}
    picture = draw(more_boxes)
    boxes = {**(more_boxes if picture.view == PRIVACY else {}), **{box.key: box for box in picture.boxes}}
    there = {(line.source, line.target) for line in picture.lines}
    new = {line.sort_key()[:2]: line for each in more for line in _new(each.lines, there, picture.view)}
    lines = sorted_lines([*picture.lines, *(line for line in new.values() if {line.source, line.target} <= set(boxes))])
    note = plain(picture.words.count(len(added), "picture.added"))
    core = picture.core | (frozenset(key for one in added for key in _witness(one)) & set(boxes))
    return replace(picture, boxes=sorted_boxes(boxes.values()), lines=lines, core=core).noted(note)


def _new(lines: Iterable[PictureLine], present: Collection[tuple[Key, Key]], view: str) -> Iterable[PictureLine]:
    for line in lines:
        if line.look == BEYOND:
            yield line
        elif view == PRIVACY and (line.source, line.target) not in present:
            yield replace(line, look=ONWARD)


def _witness(added: Added) -> Iterable[Key]:
    return (element.identity for element in added.finding.witness)
