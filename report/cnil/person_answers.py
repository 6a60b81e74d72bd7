"""What people answered in the fields of a report, as the CNIL's tool takes it: levels and texts of a risk, opinions.

In: answers by the key of their field, and the findings. Out: ``Html`` for questions of the tool, levels for its gauges,
the keys of answers that its questions have no place for. A level is one that people wrote for every path in the tool's
own words; nothing here estimates one.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.report.cnil.told import Html, bullets, escaped, harmless, joined, paragraph, prose, strong

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.report.cnil.told import Told

SEVERITY, LIKELIHOOD = 325, 326  # questions about illegitimate access: the risk that an analysis of flows speaks of
OF_ALL = {112: ("controller",), 211: ("purpose",), 212: ("basis",), 213: ("necessity",),
          SEVERITY: ("risks", "residual", "consultation")}  # fmt: skip
OF_A_PATH = {SEVERITY: ("severity", "whom", "residual", "decision"), LIKELIHOOD: ("likelihood",)}
LEVELS = {SEVERITY: "severity", LIKELIHOOD: "likelihood"}  # the field that can begin with a level
MEASURES, ADVICE, VIEWS = "measures", "advice", "views"
UNDEFINED = 0
# The levels of a gauge, as the tool calls them in each language: 'summary.gauges' and 'evaluations.gauges' there.
SCALE = {
    1: ("negligible", "geringfügig", "négligeable"),
    2: ("limited", "überschaubar", "limitée"),
    3: ("important", "substantiell", "importante"),
    4: ("maximum", "groß", "maximale"),
}
LEVEL_OF = {name.casefold(): level for level, names in SCALE.items() for name in names}
ENDS_A_NAME = ".:,;("


class AssessedPath(NamedTuple):
    """A path that people may have answered about.

    Attributes
    ----------
    title
        What can get where, without anything that HTML reads.
    ids
        That the keys of answers name it by: of its findings, and on a fleet of their patterns.
    """

    title: str
    ids: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PersonAnswers:
    """The answers to the fields of a report.

    Attributes
    ----------
    texts
        Key of a field -> its text, lines kept.
    source
        The file that they come from, with its hash; empty without answers.
    """

    texts: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    source: str = ""

    def of_all(self, number: int, words: Told) -> Html:
        """Return what was answered about the whole to a question of the tool."""
        return self._signed(joined(*(self._field(name, words) for name in OF_ALL.get(number, ()))), words)

    def measures(self, paths: Sequence[AssessedPath], words: Told) -> Html:
        """Return the measures that people named, for the whole and for single paths."""
        return self._signed(joined(self._field(MEASURES, words), bullets(self._rows(paths, (MEASURES,), words))), words)

    def risk(self, number: int, paths: Sequence[AssessedPath], words: Told) -> Html:
        """Return how people justify the severity or the likelihood, for the whole and for single paths."""
        whole = (self._field(name, words) for name in OF_ALL.get(number, ()))
        return self._signed(joined(*whole, bullets(self._rows(paths, OF_A_PATH[number], words))), words)

    def level(self, number: int, paths: Sequence[AssessedPath]) -> int:
        """Return the level of a gauge: the one that people wrote for every path, else undefined."""
        levels = {level_of(text) for path in paths for text in self._of(path, LEVELS[number]) or [""]}
        return levels.pop() if len(levels) == 1 else UNDEFINED

    def opinion(self, name: str) -> str | None:
        """Return the advice of the data protection officer, or the views of the persons, as plain lines."""
        text = self.texts.get(f"sign.{name}", "")
        return "\n".join(map(harmless, text.splitlines())) or None

    def without_place(self, paths: Sequence[AssessedPath]) -> list[str]:
        """Return the keys of answers that no question of the tool asks for, or whose path is gone."""
        fields = {name for names in OF_A_PATH.values() for name in (*names, MEASURES)}
        taken = {f"sign.{name}" for names in OF_ALL.values() for name in names}
        taken |= {f"sign.{name}" for name in (MEASURES, ADVICE, VIEWS)}
        taken |= {f"risk.{one}.{name}" for path in paths for one in path.ids for name in fields}
        return [key for key in self.texts if key not in taken]

    def _signed(self, text: Html, words: Told) -> Html:
        """What people wrote, and where it stands: the program answers for none of it."""
        source = words.line("sign.file", escaped(self.source))
        return joined(text, Html(f"<p><em>{source}</em></p>")) if text and self.source else text

    def _field(self, name: str, words: Told) -> Html:
        text = self.texts.get(f"sign.{name}", "")
        lines = (paragraph(prose(line)) for line in text.splitlines() if line)
        return joined(paragraph(strong(words(f"sign.{name}"))), *lines) if text else Html("")

    def _rows(self, paths: Sequence[AssessedPath], names: Iterable[str], words: Told) -> Iterator[Html]:
        for path in paths:
            texts = {name: self._of(path, name) for name in names}
            lines = [words.line(f"risk.{name}", prose("; ".join(some))) for name, some in texts.items() if some]
            if lines:
                yield words.pair(prose(path.title), Html("; ".join(lines)))

    def _of(self, path: AssessedPath, name: str) -> list[str]:
        """What was answered about a path, under whichever of its ids, each on one line."""
        texts = dict.fromkeys(self.texts.get(f"risk.{one}.{name}", "") for one in path.ids)
        return ["; ".join(text.splitlines()) for text in texts if text]


def level_of(text: str) -> int:
    """Return the level of the tool's scale that an answer begins with, or undefined: no other word is taken for one.

    >>> level_of("Important: faces of residents"), level_of("2"), level_of("quite limited")
    (3, 2, 0)
    """
    end = min((at for sign in ENDS_A_NAME if (at := text.find(sign)) >= 0), default=len(text))
    if text.strip() in map(str, SCALE):
        return int(text)
    return LEVEL_OF.get(text[:end].strip().casefold(), UNDEFINED)


def assessed_paths(findings: Iterable[Finding], patterns: Mapping[str, str], words: Told) -> tuple[AssessedPath, ...]:
    """Return each way of a kind of data from a source to a place once, though it may be several findings.

    Parameters
    ----------
    patterns
        Of a fleet: id of a finding -> id of its pattern.
    """
    groups: dict[tuple[object, ...], list[Finding]] = {}
    for finding in findings:
        same = finding.category, finding.source, finding.leak, finding.pseudonymised
        groups.setdefault(same, []).append(finding)
    return tuple(
        AssessedPath(
            _title(group[0], words),
            tuple(dict.fromkeys(one for f in group for one in (f.id, patterns.get(f.id, f.id)))),
        )
        for group in groups.values()
    )


def _title(finding: Finding, words: Told) -> str:
    data = words.data(finding.category, pseudonymised=finding.pseudonymised)
    what = words.bare("cnil.threat", data=data, source=words.name(finding.source), leak=words.name(finding.leak))
    return f"{what} ({words.bare('cnil.threat.id', id=finding.id)})"
