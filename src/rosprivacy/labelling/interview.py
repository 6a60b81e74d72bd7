"""A language model is asked about the elements that nobody has labelled: what is sent, and what is left of its answers.

In: an answer of ours with its graph, and what a user wants of a model. Out: evidence for suggestions, and what to tell.
Who carries a question to the model is given: a server, or a file in which the answers stand already.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.asked_elements import asked_elements
from rosprivacy.analysis.suggesting.masking import Mask, common_words
from rosprivacy.analysis.suggesting.model_answers import judged
from rosprivacy.analysis.suggesting.traffic import traffic
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.language_model.answer_text import answers_in
from rosprivacy.ingest.language_model.exchange_file import Exchange
from rosprivacy.ingest.language_model.model_questions import questions
from rosprivacy.ingest.suggestions.name_file import read_name_rules
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.analysis.suggesting.evidence import Evidence
    from rosprivacy.ingest.language_model.model_questions import Question
    from rosprivacy.labelling.basis import Basis
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.contract.suggested import ModelEntry

NOTHING_ASKED = "no element is without a label: nothing to ask a language model"


class Asking(NamedTuple):
    """What a user wants of a language model.

    Attributes
    ----------
    model
        Its name, as its server knows it.
    url
        Where questions go.
    masked
        Whether names are masked.
    most
        How many requests there may be.
    recorded
        When the answers were recorded, ``YYYY-MM-DD``; empty if the model is asked now.
    """

    model: str
    url: str
    masked: bool
    most: int
    recorded: str = ""


@dataclass
class Interview:
    """The questions to one model in one run, and what came of them.

    Attributes
    ----------
    carry
        Takes a question to the model and brings its answer back.
    told
        Is told what is sent, before it is, and what was dropped.
    rests_on
        (file, SHA-256) of the file in which the answers stand already.
    exchanges
        What was sent, each with its answer; none where an error came instead.
    """

    asking: Asking
    carry: Callable[[bytes], bytes]
    told: Callable[[str], None]
    rests_on: tuple[tuple[str, str], ...] = ()
    exchanges: list[Exchange] = field(default_factory=list)
    unread: Counter[str] = field(default_factory=Counter)
    dropped: Counter[str] = field(default_factory=Counter)

    def evidence(self, basis: Basis) -> Iterator[Evidence]:
        """Ask everything, and yield what is left of the answers.

        Raises
        ------
        InputError
            If it would take too many requests.
        ModelError
            If the model cannot be reached, or does not answer as such servers do.
        """
        mask = mask_of(basis.result.vocabulary) if self.asking.masked else None
        asked = asked_of(basis, self.asking, mask)
        self.told(what_is_sent(asked, self.asking) if asked else NOTHING_ASKED)
        kinds, found = basis.result.vocabulary.categories, 0
        unheard: Counter[str] = Counter()  # elements of which nothing was heard
        for question in asked:
            self.exchanges.append(Exchange(question.body, None))
            data = self.carry(question.body)
            self.exchanges[-1] = Exchange(question.body, data)
            answered = answers_in(data, f"model {self.asking.model}")
            if answered.unread:
                self.unread[answered.unread] += 1
                unheard[answered.unread] += len(question.asked)
            shown = mask.unmasked if mask else str
            said = judged(answered.answers, question.asked, kinds, self.asking.model, shown)
            self.dropped += said.dropped
            found += len(said.evidence)
            yield from said.evidence
        for line in self._left_out(found, unheard) if asked else ():
            self.told(line)

    def _left_out(self, found: int, unheard: Counter[str]) -> Iterator[str]:
        yield f"model {self.asking.model}: {counted(found, 'answer')} taken, each as 'may'"
        for reason, times in sorted(self.unread.items()):
            lost = f"{counted(times, 'request')} with {counted(unheard[reason], 'element')}"
            yield f"model {self.asking.model}: {lost} without an answer that can be read: {reason}"
        for reason, times in sorted(self.dropped.items()):
            yield f"model {self.asking.model}: {counted(times, 'answer')} dropped: {reason}"

    def entry(self) -> ModelEntry:
        """Return what the document tells of it."""
        return {
            "name": self.asking.model,
            "url": self.asking.url,
            "masked": self.asking.masked,
            "recorded": self.asking.recorded,
            "requests": len(self.exchanges),
            "unread": dict(sorted(self.unread.items())),
            "dropped": dict(sorted(self.dropped.items())),
        }


def asked_of(basis: Basis, asking: Asking, mask: Mask | None = None) -> tuple[Question, ...]:
    """Return the requests that would be sent.

    Raises
    ------
    InputError
        If there are more than the user allows.
    """
    graph, bound = basis.result.analysis.graph, basis.bound
    elements = asked_elements(graph, bound, traffic(graph, bound), basis.places, basis.comments)
    told = [one.changed(mask.masked) for one in elements] if mask else elements
    return questions(told, tuple(basis.result.vocabulary.categories.values()), asking.model, asking.most)


def what_is_sent(asked: tuple[Question, ...], asking: Asking) -> str:
    """Return how much goes where, in one line.

    >>> from rosprivacy.ingest.language_model.model_questions import Question
    >>> what_is_sent((Question({}, b"{}"),), Asking("m", "http://localhost/v1/chat/completions", True, 9))
    'model m at http://localhost/v1/chat/completions: 1 request with 0 elements, 2 bytes, names masked'
    """
    size = sum(len(one.body) for one in asked)
    elements = counted(sum(len(one.asked) for one in asked), "element")
    names = "names masked" if asking.masked else "names as they are"
    much = f"{counted(len(asked), 'request')} with {elements}, {counted(size, 'byte')}, {names}"
    when = f", recorded on {asking.recorded}: nothing is sent" if asking.recorded else ""
    return f"model {asking.model} at {asking.url}: {much}{when}"


def mask_of(vocabulary: Vocabulary) -> Mask:
    """Return what leaves the words of the shipped rules and types, and none of a user's own files."""
    names, _ = read_name_rules((), vocabulary)
    table = read_table(TABLE, vocabulary)
    types = {name for name, _ in (*table.suggestions, *table.limits.of)}
    return Mask(common_words(names, types), types)
