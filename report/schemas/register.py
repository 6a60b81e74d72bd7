"""The register of processing in a document: the rows from which records, notices and tables of persons are made."""

from typing import Annotated

from rosprivacy.analysis.model.register_row import Cell, RowState
from rosprivacy.analysis.python_311 import NotRequired, TypedDict
from rosprivacy.report.schemas.notation import Article9, Context, Id, Keywords, Method, closed, one_of
from rosprivacy.report.schemas.records import ElementEntry

RowDerivation = TypedDict(  # 'from' is a word of Python
    "RowDerivation", {"element": ElementEntry, "from": str, "to": str}
)


@closed
class MeasureEntry(TypedDict):
    """Who cleans data on the way, of which kind."""

    element: ElementEntry
    category: str
    method: Method
    stated: Annotated[bool, "Whether a label states the method; otherwise it is taken as pseudonymise."]
    everywhere: Annotated[bool, "Whether every way of the row passes it; else some ways lead past it."]


@closed
class RowRobotsEntry(TypedDict):
    """How decisions name a row of a fleet, and its robots."""

    pattern: Annotated[Id, "Made from the kind and the place without its robot: what the row of a decision names."]
    robots: Annotated[
        list[str], "Those where findings of the row end; where the place is on no robot, those where data begin."
    ]
    from_robots: Annotated[list[str], "Where some data come from another robot, those where data begin."]


class RegisterEntry(TypedDict):
    """A kind of data at a place where it leaves or rests; without a place, the data that leave nowhere."""

    id: Annotated[Id, "Made from the kind and the places, or the sources where there is no place."]
    category: str
    places: Annotated[list[ElementEntry], "Of one kind and name; of several robots if all else is the same."]
    pseudonymised: Annotated[bool, "Whether the kind gets there in this form only."]
    article9: Article9
    sources: Annotated[list[ElementEntry], "Where the ways begin."]
    derivations: Annotated[list[RowDerivation], "Who makes one kind of another on the ways."]
    measures: Annotated[
        list[MeasureEntry], "Who cleans data on the ways; nobody who recognises or judges persons, whatever it drops."
    ]
    subjects: Annotated[list[str], "Groups of persons that labels name of the sources."]
    contexts: Annotated[list[Context], "In which the sources work."]
    countries: Annotated[list[str], "In which the sources work, ISO 3166-1."]
    purposes: list[str]
    controllers: list[str]
    officers: Annotated[list[str], "The data-protection officers."]
    bases: Annotated[list[str], "Legal bases under Article 6, as stated or as valid decisions record them."]
    special_bases: Annotated[list[str], "Grounds under Article 9(2) and (3)."]
    criminal_bases: Annotated[list[str], "Under Article 10."]
    safeguards: Annotated[list[str], "Articles of chapter V (45 to 49)."]
    operator: str
    recipient: Annotated[str, "The role of the operator; empty where it is not stated."]
    contract: Annotated[str, "Under Article 26 or 28, in a person's words."]
    country: Annotated[str, "Of the place, ISO 3166-1; empty where it is not stated."]
    area: Annotated[str, "Where that lies, as in outside; empty where it is not stated."]
    transfer: Annotated[str, "The stated basis of a transfer; 'none' where it is stated that there is none."]
    retention: Annotated[list[str], "How long the place keeps the kind (ISO 8601); empty where it is not stated."]
    backups: Annotated[
        bool | str | None,
        Keywords(type=["boolean", "string", "null"]),
        "How much longer data stay in backups; true where that is not known, null where nothing is stated.",
    ]
    encrypted: Annotated[bool | None, "Null where it is not stated."]
    look_at: Annotated[
        list[str],
        "Provisions to look at that the kind or a context calls for: of the Union, and of the sources' countries.",
    ]
    findings: Annotated[list[str], "Ids of the findings of the kind that end at the places."]
    state: Annotated[
        str, one_of(*RowState), "Open while a finding stands; accepted or dismissed if none does; or there is none."
    ]
    fleet: Annotated[
        NotRequired[RowRobotsEntry], "Of a fleet that was read as a whole: of a row in which findings end."
    ]
    to_complete: Annotated[
        list[Annotated[str, one_of(*Cell)]], "Fields of which something is not known, and a person has to complete it."
    ]
