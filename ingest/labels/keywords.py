"""The keywords of label files: where each may stand, how it is read, its JSON schema, what it means.

A new keyword is a row of ``KEYWORDS``. The reader, the JSON schema, the head of a first label file, the tables in
``docs/labels.md`` and what the explorer takes for a role are made of these rows.

Source: the paper, section II-A, for the roles; rules S7, S8 and S9 for what they mean.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model import BY_TYPE, CLEANS, CONTEXTS, NO_BASIS, NON_ROS
from rosprivacy.analysis.non_ros import RECIPIENTS, TRANSFERS
from rosprivacy.ingest.labels.entries import BAG, END_KINDS
from rosprivacy.ingest.labels.keyword_readers import (
    LONGEST_GROUP,
    read_absent,
    read_all_kinds,
    read_backups,
    read_bag,
    read_between,
    read_contexts,
    read_country,
    read_derives,
    read_each_kind,
    read_encrypted,
    read_only,
    read_retention,
    read_sanitizer,
    read_source,
    read_subjects,
    read_text,
    read_types,
)
from rosprivacy.ingest.labels.stated_facts import LONGEST_TEXT, read_processing

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from rosprivacy.analysis.model import Statement
    from rosprivacy.ingest.labels.keyword_readers import Item
    from rosprivacy.ingest.labels.name_reader import NameReader
    from rosprivacy.ingest.reading.yaml_values import Value

    Says = Callable[[NameReader, Value, Statement], Iterator[Statement]]
    States = Callable[[NameReader, Item], Mapping[str, Any]]

NODE, CHANNEL, FLOW = "node", "channel", "flow"
CARRIERS = ("shared-memory", "side-channel")
NO_KIND = "none"  # in place of categories: takes back what labels of lower rank say (rule S7)


class Keyword(NamedTuple):
    """One keyword.

    Attributes
    ----------
    where
        ``NODE`` (elements outside ROS take these too), ``CHANNEL``, ``FLOW``; of a fact about elements outside ROS the
        kinds of elements that have it.
    schema
        Of what stands behind it, with its description; None if it only stands alone as a ``word``.
    says
        Reads statements: what data does there. It is handed one without categories.
    states
        Reads facts that move no data, by the field that takes them: of ``Entry``, ``Processing`` or ``NonRosFacts``.
    word
        Whether it may stand in place of the whole map, about every kind of data.
    alone
        Whether nothing may stand beside it in the map.
    docs
        Rows of ``docs/labels.md``: how it is written | what it means.
    init
        Lines in the head of a first label file: how it is written | what it means.
    """

    name: str
    where: tuple[str, ...]
    schema: Mapping[str, Any] | None
    says: Says | None = None
    states: States | None = None
    word: bool = False
    alone: bool = False
    docs: str = ""
    init: str = ""


def by_category(value: Mapping[str, Any]) -> dict[str, Any]:
    """Return the schema of a map whose keys are kinds of data."""
    return {"type": "object", "minProperties": 1, "propertyNames": CATEGORY, "additionalProperties": value}


def map_of(properties: Mapping[str, Any]) -> dict[str, Any]:
    """Return the schema of a map with these keys and no others."""
    return {"type": "object", "additionalProperties": False, "properties": properties}


def several(value: Mapping[str, Any]) -> dict[str, Any]:
    """Return the schema of a list that is not empty."""
    return {"type": "array", "minItems": 1, "items": value}


def _of_processing(value: Mapping[str, Any], description: str) -> dict[str, Any]:
    """What data are processed for, or on which basis: for all kinds of data, or for each."""
    some = {"anyOf": [value, several(value)]}
    return {"description": f"{description} By kind of data where it differs.", "anyOf": [some, by_category(some)]}


CATEGORY = {"$ref": "#/$defs/category"}
CATEGORIES = several(CATEGORY)
DURATION = {"$ref": "#/$defs/duration"}
NAME = {"type": "string", "pattern": r"^[/=*?\[]", "description": "A name, a glob, or = and a name with glob signs."}
END = {"type": "string", "minLength": 1}
END_OF_KIND = {
    "type": "object",
    "additionalProperties": False,
    "minProperties": 1,
    "maxProperties": 1,
    "properties": dict.fromkeys(END_KINDS, END),
    "description": "Which of several of that name: {topic: /map} or {node: /map}.",
}
TEXT = {"type": "string", "pattern": "\\S", "maxLength": LONGEST_TEXT}
SHORT_TEXT = {"type": "string", "pattern": "\\S", "maxLength": LONGEST_GROUP}
BASIS = {"type": ["string", "integer"], "description": "Such as 6(1)(f), 9(2)(h), 46(2)(c)."}
CONTEXT = {"anyOf": [{"enum": list(CONTEXTS)}, several({"enum": list(CONTEXTS)})]}
_TYPE = {"type": "string", "pattern": "^[A-Za-z]\\w*/(msg|srv|action)/[A-Za-z]\\w*$"}
_NONE_OF = {"type": "object", "required": [NO_KIND], "additionalProperties": False, "properties": {NO_KIND: CATEGORIES}}

KEYWORDS: tuple[Keyword, ...] = (
    Keyword(
        "source",
        (NODE,),
        {
            "description": "Brings these in; as a map, only through the channels named; none takes labels back.",
            "anyOf": [
                CATEGORIES,
                {**by_category(several(NAME)), "properties": {NO_KIND: CATEGORIES}},
                {"const": NO_KIND},
            ],
        },
        read_source,
        docs="""
`source: [Video]` | all that the node sends carries the category, whatever comes in
`source: {Video: [/robot_video]}` | … but of the channels of ROS only through these; along a flow that you state it
  sends all, unless that flow's `only` or `never` says otherwise
""",
        init="""
{source: [Video]} | brings the data in
{source: {Video: [/robot_video]}} | … but only through these channels
{source: [Video], conduit: [Voice]} | … and passes on what it gets of another kind
""",
    ),
    Keyword(
        "leak",
        (NODE,),
        {
            "anyOf": [CATEGORIES, {"const": NO_KIND}, _NONE_OF],
            "description": "Lets these out; none takes labels of lower rank back, of all kinds or of some.",
        },
        read_each_kind,
        docs="""
`leak: [Voice]` | the node lets the category out: to a cloud, a log, a display
`leak: none`, `source: none` | takes back what a label of lower rank says, such as a glob or a robot's model: of every
  kind, or of some (`leak: {none: [Video]}`, `source: {none: [Video], Voice: [/audio]}`). Nothing else takes a source
  or a leak back. `leak: none` also says that somebody has asked whether data gets out there: without any `leak` or
  `leak: none` the verdict is `undetermined` at best
""",
        init="{leak: [Voice]} | lets it out: to a cloud, a display, a log",
    ),
    Keyword(
        "sanitizer",
        (NODE,),
        {
            "description": "Cleans these; a method that is not stated counts as pseudonymise.",
            "anyOf": [CATEGORIES, by_category({"enum": [*map(str, CLEANS), None]})],
        },
        read_sanitizer,
        docs="""
`sanitizer: {Video: anonymise}` | `anonymise`, `aggregate` and `drop` end the category; `pseudonymise` does not: the
  data goes on as pseudonymised, which is still personal data (GDPR, recital 26). It stands for *reduced and still
  personal*: whether it is pseudonymisation in the sense of Article 4(5), with the additional information kept
  separately, a person has to judge; blurring a picture usually is not. A method that is not stated (`sanitizer:
  [Video]`) counts as `pseudonymise`, and the report says so
""",
        init="{sanitizer: {Video: anonymise}} | ends it: anonymise, aggregate, drop; pseudonymise does not",
    ),
    Keyword(
        "conduit",
        (NODE,),
        {**CATEGORIES, "description": "Reviewed: passes these on."},
        read_each_kind,
        word=True,
        docs="""
`conduit`, `conduit: [Location]` | the node is reviewed and passes on what it gets, for every category or for these;
  it takes no source and no leak away
""",
        init="conduit  or  {conduit: [Location]} | reviewed: passes it on",
    ),
    Keyword(
        "derives",
        (NODE,),
        {
            "type": "array",
            "items": {**map_of({"from": CATEGORY, "to": CATEGORY}), "required": ["from", "to"]},
            "description": "Makes one kind of data of another.",
        },
        read_derives,
        docs="""
`derives: [{from: Video, to: FaceTemplate}]` | the node makes one kind of another; the first goes on too, unless the
  node is also a sanitizer of it
""",
        init="{derives: [{from: Video, to: FaceTemplate}]} | makes one kind of another",
    ),
    Keyword(
        "subjects",
        (NODE,),
        {
            **several(SHORT_TEXT),
            "description": "Of a source: whom its data are about, such as residents or staff.",
        },
        states=read_subjects,
        docs="""
`subjects: [residents, staff]` | whom the data of a source are about, in your words; reports show it, no flow changes
  by it. Words of [the closed list](../ontology/persons.ttl) (children, patients, staff, Kinder, enfants, …) have a term
  of DPV in [linked data](linked-data.md), and children point at their law
""",
    ),
    Keyword(
        "context",
        (NODE,),
        {**CONTEXT, "description": "Of a source: where it works, beside what is said of its system."},
        states=read_contexts,
        docs="`context: [care]` | where a source works, beside what is said of its system (below)",
    ),
    Keyword(
        "purpose",
        (NODE,),
        _of_processing(TEXT, "What data are processed for."),
        states=read_processing,
        docs="""
`purpose: navigation`, `legal_basis: [6(1)(f), 9(2)(h)]` | what the data there are processed for, and on which basis:
  [below](#who-why-on-which-basis)
""",
    ),
    Keyword("legal_basis", (NODE,), _of_processing(BASIS, "Such as 6(1)(f), 9(2)(h), 10."), states=read_processing),
    Keyword(
        "absent",
        (NODE,),
        {"type": "string", "minLength": 1, "description": "Why it is not on this robot; stands alone."},
        read_absent,
        alone=True,
        docs="""
`absent: why` | the node has a profile, but is not on this robot: nothing gets to it, and nothing comes from it. It
  stands alone; reports show it with the reason. In the enforced view its grants still hold for the others in its
  enclave
""",
        init="{absent: why} | has a profile, but is not on this robot",
    ),
    Keyword(
        "mundane",
        (CHANNEL,),
        None,
        word=True,
        docs="`mundane` | the channel never carries personal data",
        init="mundane | never carries personal data",
    ),
    Keyword(
        "sensitive",
        (CHANNEL,),
        {**CATEGORIES, "description": "Reviewed: may carry these."},
        read_all_kinds,
        word=True,
        docs="""
`sensitive` | the channel is reviewed and may carry personal data (without a label it is taken to do so too, but it is
  not reviewed)
`{sensitive: [Video]}` | reviewed for these kinds: it may carry them; with room for a `note`
""",
        init="sensitive | reviewed: may carry it",
    ),
    Keyword(
        "only",
        (CHANNEL, FLOW),
        {
            "description": "Carries these at most; by-type of a channel by its full name: what its type is made for.",
            "anyOf": [CATEGORIES, {"const": BY_TYPE}],
        },
        read_only,
        docs="""
`only: [HomeMap]` | the channel carries these at most
`only: by-type` | it carries only what its message type is made for, of a full name: [below](#by-type)
""",
        init="{only: [HomeMap]}  or  {never: [Location]} |",
    ),
    Keyword(
        "never",
        (CHANNEL, FLOW),
        {**CATEGORIES, "description": "Does not carry these."},
        read_all_kinds,
        docs="`never: [Location]` | the channel does not carry these",
    ),
    Keyword(
        "types",
        (CHANNEL,),
        {**several(_TYPE), "description": "Message types of all who write it, such as sensor_msgs/msg/Image."},
        states=read_types,
        docs="`types: [std_msgs/msg/Bool]` | message types of all who write it: [types.md](types.md)",
    ),
    Keyword(
        "note",
        (NODE, CHANNEL, FLOW),
        {"type": "string", "description": "Why; stands in the report where the answer hangs on it."},
        docs="`note: text` | the reason, for people; the report shows it where the answer hangs on the label",
    ),
    Keyword(
        "author",
        (NODE, CHANNEL, FLOW),
        {**SHORT_TEXT, "description": "Who says it; of a file, of all that names nobody else."},
        docs="`author: name` | who says it; at the top of the file, of all its labels that name nobody else",
    ),
    Keyword(
        "country",
        NON_ROS,
        {"type": "string", "pattern": "^[A-Z]{2}$", "description": "ISO 3166-1; quote NO."},
        states=read_country,
        docs="`country` | ISO 3166-1 code",
    ),
    Keyword(
        "operator",
        NON_ROS,
        {"type": "string", "minLength": 1, "description": "Who runs it."},
        states=read_text,
        docs="""
`operator`, `recipient` | who runs it; as `controller`, `joint-controller`, `processor` or `third-party`
""",
    ),
    Keyword("recipient", NON_ROS, {"enum": list(RECIPIENTS)}, states=read_text),
    Keyword(
        "contract",
        NON_ROS,
        {"type": "string", "pattern": "\\S", "description": "Such as Article 28, with its date."},
        states=read_text,
        docs="`contract` | on what it is run for you, in your words: `Article 28, 2026-03-01`",
    ),
    Keyword(
        "transfer",
        NON_ROS,
        {"enum": [*TRANSFERS, NO_BASIS], "description": "Basis of a transfer out of the EEA."},
        states=read_text,
        docs="""
`transfer` | basis of a transfer out of the EEA: `adequacy`, `public-instrument`, `binding-corporate-rules`,
  `standard-clauses`, `code-of-conduct`, `certification`, `authorised-clauses`, `derogation`, `occasional-derogation`;
  `none` states that there is none
""",
    ),
    Keyword(
        "retention",
        ("storage",),
        {"anyOf": [DURATION, by_category(DURATION)], "description": "How long data is kept."},
        states=read_retention,
        docs="""
`retention` | how long data is kept, an ISO 8601 duration; or one for each kind: `{Video: P30D, PersonalData: P1Y}`
""",
    ),
    Keyword(
        "backups",
        ("storage",),
        {"anyOf": [DURATION, {"type": "boolean"}], "description": "How much longer backups keep it."},
        states=read_backups,
        docs="""
`backups` | how much longer backups keep it; `false` without backups, `true` if nobody knows how long
""",
    ),
    Keyword(
        "encrypted",
        ("storage",),
        {"type": "boolean", "description": "At rest."},
        states=read_encrypted,
        docs="`encrypted` | at rest: `true` or `false`",
    ),
    Keyword(
        BAG,
        ("storage",),
        {"type": "string", "minLength": 1, "description": "The recording that it is, relative to this file."},
        states=read_bag,
        docs="""
`bag` | the recording that it is: a bag or a folder of bags, relative to this file, inside its folder or that of
  `--include-root`. What was recorded flows into it from the channels of that name, retention and limits hold there,
  and no message is read. A topic that no policy names, and what is not known of a bag, makes the verdict
  `undetermined` at best ([bags.md](bags.md#bags-as-storages))
""",
    ),
    Keyword(
        "between",
        CARRIERS,
        {
            "type": "array",
            "minItems": 2,
            "items": {"anyOf": [NAME, END_OF_KIND]},
            "description": "Nodes that it joins.",
        },
        states=read_between,
        docs="`between` | nodes that it joins, in both directions",
    ),
)


def rows(text: str) -> list[tuple[str, str]]:
    r"""Return the rows of ``docs`` and ``init``; what is indented goes on the row above.

    >>> rows("a | b\n  c")
    [('a', 'b c')]
    """
    lines = " ".join(text.strip("\n").split("\n  ")).split("\n")
    return [
        (written.strip(), meaning.strip()) for line in lines if line for written, _, meaning in [line.partition(" |")]
    ]


@cache
def keywords_of(where: str) -> Mapping[str, Keyword]:
    """Return the keywords of a node, a channel, a flow or a kind of elements outside ROS, by name.

    >>> [*keywords_of("flow")]
    ['only', 'never', 'note', 'author']
    """
    return {keyword.name: keyword for keyword in KEYWORDS if where in keyword.where}


@cache
def words_of(where: str) -> tuple[str, ...]:
    """Return the keywords that may stand in place of a whole map.

    >>> words_of("node"), words_of("channel")
    (('conduit',), ('mundane', 'sensitive'))
    """
    return tuple(keyword.name for keyword in keywords_of(where).values() if keyword.word)


@cache
def keys_of(where: str) -> tuple[str, ...]:
    """Return the keywords that may be keys of a map."""
    return tuple(keyword.name for keyword in keywords_of(where).values() if keyword.schema is not None)


def moves_data(where: str) -> tuple[str, ...]:
    """Return the keywords that say what data does, and so may change a flow.

    >>> moves_data("node")
    ('source', 'leak', 'sanitizer', 'conduit', 'derives', 'absent')
    """
    return tuple(keyword.name for keyword in keywords_of(where).values() if keyword.says or keyword.word)
