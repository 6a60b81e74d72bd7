"""The answer to a question about a system, as facts: findings, open questions, what arrives where, the verdict."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import DISCLOSURE, Rank
from rosprivacy.analysis.python_311 import StrEnum

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Diagnostic, Element, FlowGraph, Grant, NonRosFacts, Place, Reason, UnknownEnd


class Step(NamedTuple):
    """One hop of a witness: what goes along it, and the policy lines that allow it."""

    source: Element
    target: Element
    role: str
    category: str
    pseudonymised: bool
    grants: tuple[Grant, ...]


@dataclass(frozen=True, slots=True, repr=False)
class Finding:
    """A category reaches a place that it should not, rule S10.

    Attributes
    ----------
    id
        16 hexadecimal digits made from category, source and leak, of other kinds than disclosure from the kind, and
        from ``plain_also`` where it holds; stable as long as these are.
    kind
        ``DISCLOSURE``: it reaches a leak. ``STORAGE_LIMITATION``: a storage that keeps it without a stated end or
        longer than allowed. ``THIRD_COUNTRY``: an element outside the EEA without a stated basis.
        ``UNPROTECTED``: a channel that who is on the network can read.
    leak
        The leak, the storage, the element abroad or the channel.
    pseudonymised
        Whether the data arrives in pseudonymised form only; data that arrives as it is through another leak only is
        then a finding of its own, ``plain_also`` this one.
    witness
        One shortest path, source first.
    steps
        The flows of the witness, one fewer than its elements.
    number_of_paths
        How many paths share no flow, 1 for a finding of one element; None where nobody asked for it. Who tells it takes
        ``disjoint_paths``.
    through
        Other leaks of the category on the witness; not empty only if dismissed.
    dismissed
        Whether every path goes through another leak of the category, which has a finding of its own, not accepted.
    accepted
        Whether a person has decided that this may be; it then hides nothing behind it.
    plain_also
        Whether a finding of the same ends stands beside it that is pseudonymised; this one is then dismissed.
    paths
        Further paths if asked for, each source first.
    bounded
        Whether ``paths`` was cut at the bound that the user set.
    why
        Of other kinds than disclosure: what is wrong there.
    """

    id: str
    kind: str
    category: str
    pseudonymised: bool
    source: Element
    leak: Element
    witness: tuple[Element, ...]
    steps: tuple[Step, ...]
    number_of_paths: int | None
    through: tuple[Element, ...] = ()
    dismissed: bool = False
    paths: tuple[tuple[Element, ...], ...] = ()
    bounded: bool = False
    why: Reason | None = None
    accepted: bool = False
    plain_also: bool = False

    def __repr__(self) -> str:
        kind = "" if self.kind == DISCLOSURE else f"{self.kind} of "
        data = f"{'pseudonymised ' if self.pseudonymised else ''}{self.category}"
        ends = f"{shown(self.source.full_name)} -> {shown(self.leak.full_name)}"
        states = [state for state in ("dismissed", "accepted") if getattr(self, state)]
        return f"<Finding {', '.join([f'{self.id}: {kind}{data}: {ends}', *states])}>"

    @property
    def disjoint_paths(self) -> int:
        """How many paths share no flow.

        Raises
        ------
        ValueError
            If they were not counted: then there is no number to tell.
        """
        if self.number_of_paths is None:
            raise ValueError(f"nobody asked for the number of paths of finding {self.id}")
        return self.number_of_paths

    @property
    def reason(self) -> str:
        """``why`` in English; empty for a disclosure."""
        return str(self.why) if self.why else ""

    @property
    def stands(self) -> bool:
        """Whether the verdict is a leak because of it (rule S12): it is neither dismissed nor accepted."""
        return not self.dismissed and not self.accepted


class OpenQuestion(NamedTuple):
    """An element that a category reaches and that no label covers for it, rule S11.

    Attributes
    ----------
    categories
        Names, sorted.
    distance
        Flows from the nearest source.
    frontier
        Of a node: whether a category reaches it without another open node or a leak of it on the path.
    missing
        What has to be known of a non-ROS element and is not stated, such as ``country``.
    """

    element: Element
    categories: tuple[str, ...]
    distance: int
    frontier: bool
    missing: tuple[str, ...] = ()


class CarriedData(NamedTuple):
    """What an element carries: emitted categories, sorted; ``pseudonymised`` is a plane of its own (rule S8)."""

    element: Element
    categories: tuple[str, ...]
    pseudonymised: tuple[str, ...] = ()


class Verdict(StrEnum):
    """Rule S12. Never 'compliant' or 'safe': the labels are a person's word."""

    LEAK = "leak"
    UNDETERMINED = "undetermined"
    NO_LEAK_FOUND = "no-leak-found"

    @classmethod
    def of(cls, *, leak: bool, is_open: bool, grounded: bool) -> Verdict:
        """Decide: ``leak`` if a finding stands; ``grounded`` if it lacks no ground and all was read (S11, S12).

        >>> str(Verdict.of(leak=False, is_open=False, grounded=False))
        'undetermined'
        """
        if leak:
            return cls.LEAK
        return cls.NO_LEAK_FOUND if grounded and not is_open else cls.UNDETERMINED


class ClosedByTypes(NamedTuple):
    """What there would be if the types of channels limited nothing (rule S15).

    Attributes
    ----------
    flows
        How many flows end where a type cannot carry what comes along them.
    channels
        (channel or leg of one, kinds that get to it and stop there), sorted.
    findings
        Those that only a limit closes, sorted as findings are.
    """

    flows: int = 0
    channels: tuple[tuple[Element, tuple[str, ...]], ...] = ()
    findings: tuple[Finding, ...] = ()


class ClosedByShipped(NamedTuple):
    """What a statement of a shipped file alone keeps from a leak (rule S13).

    Attributes
    ----------
    channel
        Where data stops.
    categories
        What gets there, sorted.
    end
        The nearest labelled leak, storage or element outside ROS that it would get to; None where it was not worked
        out, since too much hangs on such lines.
    places
        The lines that say so, sorted.
    rank
        It breaks the verdict where the standard file speaks of a channel outside its standard place, and rides where
        only the file of infrastructure says it; None for a standard channel in its place, which is counted.
    """

    channel: Element
    categories: tuple[str, ...]
    end: Element | None
    places: tuple[Place, ...]
    rank: Rank | None

    @property
    def at(self) -> tuple[Element, ...]:
        """Where it counts: the channel, and what it would get to."""
        return (self.channel, self.end) if self.end else (self.channel,)


class ClosedByLine(NamedTuple):
    """A channel at which a line ``only: by-type`` alone closes a way on (rules S7, S11).

    Attributes
    ----------
    categories
        What would get there, and go on to a leak, an element outside ROS or a node that nobody reviewed, and does not.
    place
        The line.
    """

    channel: Element
    categories: tuple[str, ...]
    place: Place


class ByGlobs(NamedTuple):
    """An element, or a flow, that only globs answer for (rule S11).

    Attributes
    ----------
    element
        The start of a flow; of a service or action one of its legs.
    to
        The end of a flow; None of an element.
    categories
        Kinds that get there, as they are emitted, sorted; those that end there are among them.
    places
        The lines of the globs, sorted.
    """

    element: Element
    to: Element | None
    categories: tuple[str, ...]
    places: tuple[Place, ...]


@dataclass(frozen=True, slots=True)
class Analysis:
    """The answer: what was found, what is open, what every element carries.

    Attributes
    ----------
    graph
        What was analysed.
    emitted
        Names of the categories that a source or a derivation emits, sorted.
    findings
        Sorted by category, source, leak; dismissed ones included.
    open
        Frontier first, then by distance and name.
    carried
        Every element that data arrives at or starts from, in the order of the graph.
    roles
        Per vertex and emitted category the roles of nodes that hold, sorted; what labels decided.
    standard_channels
        Channels taken as mundane by the shipped file (rule S13).
    standard_reached
        Of these, (channel, emitted categories that get to it and stop there).
    closed_by_shipped
        Of these, those that alone keep data from a leak, a storage or an element outside ROS, with the nearest.
    standard_unchanged
        Of these, those of which a glob of the user's says otherwise that does not count.
    spread
        The fixpoint itself: what is at every vertex and along every flow.
    unstated
        (element, category) of sanitizers whose method no label states.
    outside
        What is stated about non-ROS elements (rule S9).
    unknown_ends
        Channels with data that nobody known reads, elements outside ROS that no flow reaches; sorted (rule S11).
    types
        Names of the message types of each channel, sorted (rule S15).
    closed
        What only the types of channels close; None where no limits of types apply (rule S15).
    closed_by_lines
        Channels at which only a line ``only: by-type`` keeps data from a leak, an element outside ROS or a node that
        nobody reviewed.
    lacking
        What 'no leak found' needs and is missing, as the code of a diagnostic; empty if nothing is (rules S11, S12).
    """

    graph: FlowGraph
    verdict: Verdict
    emitted: tuple[str, ...]
    findings: tuple[Finding, ...]
    open: tuple[OpenQuestion, ...]
    carried: tuple[CarriedData, ...]
    roles: Mapping[Element, Mapping[str, tuple[str, ...]]]
    standard_channels: int
    spread: Spread
    unstated: tuple[tuple[Element, str], ...] = ()
    standard_reached: tuple[tuple[Element, tuple[str, ...]], ...] = ()
    closed_by_shipped: tuple[ClosedByShipped, ...] = ()
    standard_unchanged: tuple[Element, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()
    outside: Mapping[Element, NonRosFacts] = field(default_factory=dict)
    unknown_ends: tuple[UnknownEnd, ...] = ()
    lacking: str = ""
    closed: ClosedByTypes | None = None
    types: Mapping[Element, tuple[str, ...]] = field(default_factory=dict)
    closed_by_lines: tuple[ClosedByLine, ...] = ()


def writers_and_readers(graph: FlowGraph, elements: Iterable[Element]) -> Iterator[tuple[Element, Element]]:
    """Yield the channels among some elements, each with who writes or reads it. O(flows); no flow without a channel.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, FILTERED, factory
    >>> graph, _, _ = factory()
    >>> [other.name for _, other in writers_and_readers(graph, (graph.elements[FILTERED], graph.elements[CAMERA]))]
    ['/filter', '/archive']
    """
    channels = {element.shown_as for element in elements if element.is_channel}
    those = {vertex for vertex, element in enumerate(graph.elements) if channels and element.shown_as in channels}
    for flow in graph.flows if those else ():
        for channel, other in ((flow.source, flow.target), (flow.target, flow.source)):
            if channel in those:
                yield graph.elements[channel], graph.elements[other]


def robot_verdicts(
    analysis: Analysis,
    robots: Iterable[str],
    robot_of: Callable[[Element], str],
    not_read: Collection[str] = (),
    leaking: Collection[str] | None = None,
) -> dict[str, Verdict]:
    """Return the verdict on each robot (rule S12): what comes from it, gets out at it or is open on it counts.

    An open channel that robots share counts for each of them that writes or reads it.

    Parameters
    ----------
    robot_of
        Element -> name of its robot.
    not_read
        Robots of which grants were not read.
    leaking
        Robots at which a finding begins or ends, where it is known of more than this analysis.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> analysis = analyse(*factory("amr-1"))
    >>> verdicts = robot_verdicts(analysis, ["amr-1", "amr-2"], lambda element: element.robot)
    >>> [f"{robot}: {verdict}" for robot, verdict in verdicts.items()]
    ['amr-1: leak', 'amr-2: undetermined']
    """
    if leaking is None:
        leaking = {
            robot_of(e) for finding in analysis.findings if finding.stands for e in (finding.source, finding.leak)
        }
    open_at = {robot_of(question.element) for question in analysis.open}
    channels = writers_and_readers(analysis.graph, (question.element for question in analysis.open))
    open_at |= {robot_of(element) for _, element in channels}
    carrying = () if analysis.lacking else analysis.carried
    broken = {robot_of(e) for row in analysis.closed_by_shipped if row.rank is Rank.BREAKS for e in row.at}
    known = {robot_of(carried.element) for carried in carrying} - {*not_read, *broken}
    return {
        robot: Verdict.of(leak=robot in leaking, is_open=robot in open_at, grounded=robot in known) for robot in robots
    }
