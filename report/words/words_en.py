"""The words of reports in English. Paths to assess, recipients, conditions: no verdict of law, no promise."""

from rosprivacy.analysis.model import REASONS

WORDS = {
    "thousands": ",",
    "date": "{year}-{month}-{day}",
    "title": "Where personal data can go",
    "subtitle": "Data-flow report for data protection",
    "system": "System",
    "made": "Made on {date} with rosprivacy {version}",
    "made.undated": "Made with rosprivacy {version}",
    "law.date": "Law as of {date}",
    "law.countries": "adequacy decisions as of {date}",
    "pair": "{what}: {said}",
    "skip": "Skip to the content",
    "contents": "Contents",
    "top": "Back to the contents",
    "none": "none",
    "yes": "yes",
    "no": "no",
    "not.stated": "not stated",
    "more": "and {n} more",
    "wildcard": "wildcard",
    # --- things, counted
    "way.one": "{n} path to assess",
    "way.many": "{n} paths to assess",
    "element.one": "{n} element",
    "element.many": "{n} elements",
    "flow.one": "{n} flow",
    "flow.many": "{n} flows",
    "openelement.one": "{n} other open element",
    "openelement.many": "{n} other open elements",
    "leak.one": "{n} recipient",
    "leak.many": "{n} recipients",
    "robot.one": "{n} robot",
    "robot.many": "{n} robots",
    "ofrobots.one": "{n} robot",
    "ofrobots.many": "{n} robots",
    "enclave.one": "{n} enclave",
    "enclave.many": "{n} enclaves",
    "step.one": "{n} step",
    "step.many": "{n} steps",
    "channel.one": "{n} standard ROS channel",
    "channel.many": "{n} standard ROS channels",
    "year.one": "{n} year",
    "year.many": "{n} years",
    "month.one": "{n} month",
    "month.many": "{n} months",
    "week.one": "{n} week",
    "week.many": "{n} weeks",
    "day.one": "{n} day",
    "day.many": "{n} days",
    "hour.one": "{n} hour",
    "hour.many": "{n} hours",
    "minute.one": "{n} minute",
    "minute.many": "{n} minutes",
    "second.one": "{n} second",
    "second.many": "{n} seconds",
    # --- kinds of elements
    "kind.node": "node",
    "kind.topic": "topic",
    "kind.service": "service",
    "kind.action": "action",
    "kind.storage": "storage",
    "kind.external-system": "external system",
    "kind.shared-memory": "shared memory",
    "kind.side-channel": "side channel",
    "kind.device": "device",
    "kind.display": "display",
    "kind.person": "person",
    "leg.request": "request",
    "leg.response": "response",
    # --- roles and steps
    "role.source": "source of {data}",
    "role.leak": "lets out {data}",
    "role.sanitizer": "cleans {data}",
    "role.conduit": "reviewed, passes on {data}",
    "role.derivation": "makes other data of {data}",
    "unreviewed": "not reviewed",
    "verb.publish": "publishes to",
    "verb.subscribe": "is read by",
    "verb.request": "requests, data goes to",
    "verb.reply": "replies, data goes to",
    "verb.call": "calls, data goes to",
    "verb.execute": "executes, data goes to",
    "verb.matches": "is covered by the wildcard",
    "verb.flow": "goes to",
    "policy.more": "and {n} more policy lines",
    "policy.of": "enclave {enclave}, profile {profile}",
    "policy.none": "no policy line: the wildcard covers the name",
    # --- sections
    "h.kinds": "Kinds of personal data",
    "h.assumptions": "What the result rests on",
    "h.changes": "What changed since the earlier report",
    "h.tables": "Whose data, and who can get them",
    "h.findings": "Paths to assess",
    "h.outside": "Storages and other things outside ROS",
    "h.sanitizers": "What is cleaned, and what passes beside",
    "h.questions": "Open questions",
    "h.criteria": "For a data protection impact assessment",
    "h.inventory": "Inventory",
    "h.method": "How this report comes about",
    "h.sign": "Assessment by a person",
    # --- result
    "verdict.leak": "Personal data can reach a place that a person has to assess",
    "verdict.undetermined": "Not determined: what data can pass is not reviewed in full",
    "verdict.no-leak-found": "No path to a recipient was found under the labels given",
    "verdict.nothing": "Not determined: no source was named, so no data was followed",
    "verdict.code": "Code of this answer for programs",
    "verdict.leak.means": (
        "At least one kind of personal data can get from where it is brought in to an element that lets it out of the "
        "system, keeps it too long or without a stated end, or lies in a third country. Such a path can be lawful and intended. A person has to "
        "assess each: is it wanted, on which legal basis, who is the recipient?"
    ),
    "verdict.undetermined.means": (
        "No path to a recipient was found, but data can get to {open} that no label speaks of. Until these are reviewed, "
        "nothing can be concluded: one of them may let data out."
    ),
    "verdict.ends": "Unknown ends ({ends}): it is not known who reads or what flows in; see section {section}.",
    "verdict.no-leak-found.means": (
        "Under the labels given, no path leads from a source to a recipient, and everything on the way was reviewed. "
        "This holds only as far as the labels and policies are true. It says nothing about what lies outside them."
    ),
    "verdict.nothing.means": (
        "No label names a source of the kinds of data that were asked for. The report says nothing about the system."
    ),
    "verdict.goes-nowhere": "Not determined: what the named sources bring in goes nowhere, so no data were followed",
    "verdict.goes-nowhere.means": (
        "What the sources named in the labels bring in goes to standard channels at most, and ends there. Perhaps "
        "other nodes bring it in. The report says nothing about the system."
    ),
    "verdict.no-leak-named": "Not determined: no label says where data get out of the system",
    "verdict.no-leak-named.means": (
        "Data were followed, and everything on the way was reviewed. But no label says of any element that it lets the "
        "data out, or that it does not, so no path could have been found."
    ),
    "verdict.accepted": "{ways} accepted by a person's decision; section {section} shows each with its reason.",
    "not.legal": (
        "This report is no legal verdict. It shows where data can go under the policies, and what people said of the "
        "elements. Whether that is permitted is for a person to decide."
    ),
    "n.ways": "paths to assess",
    "n.special": "of them with data that fall under Article 9 or 10 GDPR, always or on a condition",
    "n.reveals": "of them with data that may reveal what Article 9 or 10 names, or of which that is not known",
    "n.recipients": "places that data can reach",
    "n.open": "elements not reviewed",
    "n.accepted": "accepted by decision",
    "n.dismissed": "paths only through another recipient",
    "t.kinds": "Kinds of personal data in the system",
    "c.kind": "Kind of data",
    "c.article9": "Article 9(1) GDPR",
    "c.sources": "Brought in or made by",
    "c.factors": "Identity factors",
    "c.ways": "Paths to assess",
    "c.places": "Places reached",
    "c.open": "Not reviewed",
    "made.by": "makes it of {data}",
    # --- what a report begins with
    "b.decide.one": "You have to decide 1 thing",
    "b.decide.many": "You have to decide {n} things",
    "b.decided.one": "{n} more is decided and not yet carried out.",
    "b.decided.many": "{n} more are decided and not yet carried out.",
    "b.carry.one": "{n} thing is decided and not yet carried out",
    "b.carry.many": "{n} things are decided and not yet carried out",
    "b.can": "{data} can get to {leak}",
    "b.places.one": "and other data to {n} more place",
    "b.places.many": "and other data to {n} more places",
    "b.open": "Not reviewed, though personal data can get there: {open}. So there may be more to decide.",
    "b.review": "Review first: {names}.",
    "b.more": "{n} more are listed below, among the paths to assess.",
    "b.each": (
        "Such a path can be lawful and intended. Say for each: is it wanted, on which legal basis, and who is the recipient?"
    ),
    "b.whose": "Whose data",
    "b.law": "Provisions",
    "b.law.disclosure": "Article 6",
    "b.law.storage-limitation": "Article 5(1)(e)",
    "b.law.third-country-transfer": "chapter V (Articles 44 to 49)",
    "b.basis": "Legal basis",
    "b.basis.none": "none recorded",
    "b.recipient": "Recipient",
    "b.owner": "Who decides",
    "b.owner.none": "nobody is named",
    "b.only": "{decided}, for {robot} only",
    "b.changed": "{decided}; changed since",
    "b.see": "In full",
    "b.dismissed": "{ways} lead only through one of these places; they stand below, at the end of their kind.",
    "code.leak": "data can get to a point of exit",
    "code.undetermined": "not known",
    "code.no-leak-found": "none found under the labels given",
    # --- what closes paths
    "h.closing": "What closes these paths",
    "z.none.fleet": (
        "Changes are proposed for the policies of one robot: 'rosprivacy mitigate' with the policies and labels of a robot "
        "tells the cheapest ones, proven by a new analysis."
    ),
    "z.none.many": (
        "There are too many paths to propose changes here; 'rosprivacy mitigate' with the files of this report tells the "
        "cheapest ones, proven by a new analysis."
    ),
    "z.none.graph": "No change can be proposed here: the policies behind this report are not at hand.",
    "z.nothing": "No change that can be proposed removes these paths.",
    "z.intro": "With {changes}, this would be closed: {removed}. That is no decision: a change is work for a person, and there may be others.",
    "z.change.one": "{n} change",
    "z.change.many": "{n} changes",
    "z.proven": "Analysed anew with them. Paths to a point of exit are then: {verdict}. That holds as far as reviews find what is assumed.",
    "z.less": "These get less than today: {names}.",
    "z.more": "{n} more; 'rosprivacy mitigate' tells all.",
    "z.filter": "Put a filter between {source} and {target} that ends {data} (anonymise, aggregate or drop; pseudonymising does not do it).",
    "z.review": "Review {channel}: does it carry {data}? If a person finds that it does not, a label that says so closes the path.",
    "z.deny": "Set these policy lines to DENY, for {data}. A DENY holds for the whole enclave: {enclaves}.",
    "z.spares": "A filter one step before would also reach {names}.",
    "z.instead": "Without a change of flows, if it is so or can be arranged, a label file can state:",
    "z.state.storage-limitation": "of {element}, for how long {data} is kept, within the limit",
    "z.state.third-country-transfer": "of {element}, another country, or the basis of the transfer of {data}",
    "z.stays": "No change removes:",
    "b.picture": "The shortest paths of what is to be decided, in one picture",
    "b.picture.part": "The shortest paths of the first {n} of {all} to decide; the others have a picture each, below",
    # --- the rights of the persons
    "h.rights": "Rights of the persons: where their data can lie",
    "rt.intro": "Who is asked for access, erasure or portability (Articles 15, 17 and 20) has to know where the data lie. For each group of persons the tables name the storages, recipients and points of exit that data about them can get to.",
    "rt.of": "Data about: {group}",
    "rt.where": "Where",
    "rt.who": "Who operates it, and where",
    "rt.unknown": "not known",
    "rt.none": "Data about {group}: no path to a storage or recipient was found under the labels given.",
    "rt.nobody": "No source is named, so nothing is known of whose data there are.",
    "rt.limits": "A place counts for a group if data of a kind that comes from its sources can get there. What nodes, logs and recipients keep besides is not known to the program.",
    # --- the risks
    "h.risks": "Risks to the persons",
    "risk.intro": "Article 35(7)(c) and (d): for each flow the risks to the rights and freedoms of the persons, and what is done about them. Only a person can say it; the fields are for that.",
    "risk.likelihood": "How likely is harm?",
    "risk.severity": "How severe would it be?",
    "risk.whom": "For whom?",
    "risk.measures": "Measures",
    "risk.residual": "Remaining risk",
    "risk.decision": "Who decided, and what",
    "sign.save": "Save the answers",
    "sign.save.how": "The fields of this page can be filled in. The button saves all answers to a file; 'rosprivacy report --assessment FILE' fills them into the next report.",
    "sign.file": "The answers come from",
    "sign.unmatched": "Answers that match nothing any more",
    "sign.unmatched.means": "These answers are about paths or fields that this report does not have. They are saved again with the others; empty them to drop them.",
    # --- Article 9
    "article9.short": "Article 9(1)",
    "article9.always": "applies to such data",
    "article9.conditional": "applies on a condition",
    "article9.may-reveal": "such data may reveal it",
    "article9.no": "not by itself",
    "article9.unknown": "not known",
    "law.always": "Applies to such data",
    "law.conditional": "Applies to such data on a condition",
    "law.may-reveal": "Such data may reveal what it names",
    "law.meaning": "What the provision says",
    "law.sources": "Source",
    "law.stated": "Stated for",
    "law.as.of": "as of {date}",
    "law.narrower": "if the data are of a narrower kind: {kinds}",
    "law.no": "Not a special category by itself: {reason}",
    "law.unknown": (
        "The ontology does not say whether Article 9(1) GDPR applies to such data. That is no 'no': a person has to look."
    ),
    "law.gdpr": "Defined in",
    "law.box": "Provisions to look at",
    "law.context": "In this context ({context}), such data may reveal what it names",
    "law.look": "Look at too",
    "look.heading": "Further law to look at",
    "look.intro": "Only the GDPR is followed into paths; these provisions are pointed at. Whether they apply is for a person to judge.",
    "look.system": "Every system",
    "look.context": "In this context: {context}",
    "look.applies": "applies from {date}",
    "f.context": "In the context of the source ({context}), the data may reveal what {provision} speaks of: {reason}.",
    # --- assumptions
    "a.view.declared": "View 'declared': each node does what its own profile in the policy says, and nothing else.",
    "a.view.enforced": (
        "View 'enforced': each node may do whatever any profile in its enclave allows, because that is what the "
        "middleware enforces. It shows what remains if a node misbehaves."
    ),
    "a.unlabelled": (
        "An element that no label speaks of passes on all data that gets there, and counts as not reviewed; a channel "
        "counts as able to carry personal data."
    ),
    "a.standard": "{channels} taken to carry no personal data, by the file {file} (SHA-256 {sha}).",
    "a.standard.proposed": "{channels} taken to carry no personal data, by the file {file} (SHA-256 {sha}), or by {proposed}.",
    "a.standard.none": "No standard ROS channel was taken to carry no personal data.",
    "a.standard.reached": "{data} would get to {element}, and stops there for this.",
    "a.standard.unchanged": "A label by a glob says that {element} may carry data; it does not count against that file.",
    "a.absent": "{element} has a profile and is not on the robot: {why}. So nothing gets to it, and nothing comes from it.",
    "a.hangs": "That no path was found hangs on labels at which data end: {labels}. Check that each is true.",
    "a.glob": (
        "The glob at {place} ({says}) decides {elements}; data ends for it at {closed} of them, and {reviewed} count as "
        "reviewed for it."
    ),
    "a.glob.half": (
        "Warning: that is more than half of the nodes, channels or flows that data gets to; check that it is meant."
    ),
    "a.glob.flows": "The glob at {place} ({says}) decides {flows}; data ends for it along {closed} of them.",
    "a.glob.last-path": "Warning: without it the answer would not be that no leak was found; check that it is meant.",
    "a.overruled.source": "{elements}: no source of {data}, since the label at {by} takes away that at {lost}.",
    "a.overruled.leak": "{elements}: no leak of {data}, since the label at {by} takes away that at {lost}.",
    "a.categories": "The answer is only about these kinds of data and narrower ones: {names}. Others were not looked at.",
    "a.factors": (
        "The answer is only about data that tell of these factors of a person's identity, or of which that is not stated: "
        "{names}. Others were not looked at."
    ),
    "a.types": "The answer is only about data of these types: {names}. Others were not looked at.",
    "a.article9.always": "The answer is only about data that always fall under Article 9(1) GDPR, or of which that is not known. Other personal data were not looked at.",
    "a.article9.conditional": "The answer is only about data that fall under Article 9(1) GDPR always or on a condition, or of which that is not known. Other personal data were not looked at.",
    "a.article9.may-reveal": "The answer is only about data that can fall under Article 9(1) GDPR, or of which that is not known. Other personal data were not looked at.",
    "a.backups": "Backups are not stated, and taken to be none: {names}.",
    "a.broader": "{data} is a part of this answer too: data of this kind may be {kinds}.",
    "a.database": "The graph of {robots} came from a database, where people can have changed it after it was loaded.",
    "a.unstated": (
        "{element} is labelled as cleaning {data}, but no label states how. It was taken as pseudonymisation: the data "
        "is still personal."
    ),
    "a.kinds": "Each {kind} is taken to {role}, unless a label says otherwise.",
    "a.kinds.leak": "let out all data that gets there",
    "a.kinds.conduit": "pass on all data that gets there",
    "a.countries": "Members of the EEA and adequacy decisions as of {date}; check them.",
    "a.limit": "How long {element} keeps {data} was not judged: no label file states a limit.",
    "a.law": "Only the GDPR is followed into paths, as the ontology of the program knows it as of {date}. The AI Act, the law on electronic communications, national law and agreements with works councils are not looked at. Proposals of new law are not applied.",
    "a.labels": "Labels are a person's word. The program cannot check what a node does inside, or what leaves it past ROS.",
    "t.closed": "Closed on somebody's word: without it, data would get on",
    "k.intro": (
        "Each row is a line of a policy or label file, or a decision, that keeps data from a recipient or from an "
        "element that nobody has reviewed. The result holds only as far as these lines are right."
    ),
    "c.closed": "Where data ends",
    "c.word": "On whose word",
    "c.behind": "What lies behind",
    "k.leak": "recipient {element}",
    "k.open": "not reviewed: {element}",
    "k.perhaps": "not worked out",
    "k.glob": "{said}, by a glob",
    "k.deny": "denied by the policy",
    "k.standard-channel": "standard channel, taken to carry no personal data",
    "k.mundane": "said to carry no personal data",
    "k.only": "said to carry other data only",
    "k.never": "said never to carry it",
    "k.sanitizer": "said to clean it",
    "k.outdone": "a label of higher rank",
    "k.decision": "accepted by a decision",
    "k.restriction": "not asked about",
    "t.files": "Files that were read",
    "c.file": "File",
    "c.role": "Role",
    "c.hash": "SHA-256",
    "file.policies": "policy",
    "file.labels": "labels",
    "file.ontologies": "categories of the user",
    "file.standard": "standard channels",
    "file.none": "No label file was given.",
    "diagnostics": "What was said when the files were read",
    "severity.error": "error",
    "severity.warning": "warning",
    "severity.notice": "notice",
    # --- changes
    "ch.intro": "Compared with the document {file} (SHA-256 {sha}).",
    "ch.none": "Nothing changed in what was found.",
    "ch.verdict": "The verdict was '{before}' and is now '{now}'.",
    "ch.verdict.same": "The verdict is the same as before: '{now}'.",
    "ch.new": "New paths",
    "ch.gone": "Paths that are gone",
    "ch.changed": "Paths that changed",
    "ch.open.new": "Newly open elements",
    "ch.open.gone": "Elements that are no longer open",
    "ch.kinds.new": "Kinds of data that are new: {names}",
    "ch.kinds.gone": "Kinds of data that are no longer followed: {names}",
    "ch.scope": ("The two reports were not made in the same way. A path that is new or gone can come from that alone:"),
    "ch.scope.view": "view: '{before}', now '{now}'",
    "ch.scope.categories_asked": "kinds asked for: {before}, now {now}",
    "ch.scope.identity_factors_asked": "identity factors asked for: {before}, now {now}",
    "ch.scope.data_types_asked": "types of data asked for: {before}, now {now}",
    "ch.scope.article9_only": "only what can fall under Article 9: {before}, now {now}",
    "ch.scope.article9_level": "level of Article 9: {before}, now {now}",
    "ch.scope.standard_channels": "file of the standard channels: {before}, now {now}",
    "ch.scope.law_as_of": "date of the law: {before}, now {now}",
    "ch.scope.rosprivacy": "version of the program: {before}, now {now}",
    "ch.scope.ontologies": "ontologies of the user: {before}, now {now}",
    "ch.files": "Files that differ: {names}.",
    "ch.files.same": "All policy and label files are the same.",
    "ch.what.witness": "another shortest path",
    "ch.what.pseudonymised": "in another form (pseudonymised or not)",
    "ch.what.dismissed": "now or no longer only through another recipient",
    "ch.what.accepted": "another decision",
    "ch.what.disjoint_paths": "another number of separate paths",
    "ch.what.article9": "another statement on Article 9",
    "ch.what.robots": "on other robots",
    "ch.what.law": "other provisions",
    "ch.what.special_from": "data become special elsewhere",
    "ch.what.reason": "another reason",
    "badge.new": "new",
    "badge.changed": "changed",
    # --- tables
    "t.subjects": "Whose data, by kind",
    "t.recipients": "Who can get data, by kind",
    "t.part": "{title} (part {part} of {parts})",
    "t.subjects.intro": (
        "Rows are groups of persons, as the labels of sources name them. A cell says what can happen to data of that kind "
        "about these persons."
    ),
    "t.recipients.intro": (
        "Rows are elements that let data out, keep it, or lie outside ROS. A cell says whether data of that kind can get "
        "there, and links to the first path."
    ),
    "t.subjects.missing": (
        "Labels do not say whom the data of these sources are about; 'subjects' in a label file says it: {names}."
    ),
    "c.subject": "Persons",
    "c.recipient": "Recipient or place",
    "subject.unknown": "persons not stated",
    "cell.brought": "brought in, no path found",
    "cell.made": "can be made of it",
    "cell.through": "only through another recipient",
    "cell.gets": "gets there",
    "cell.no": "no path found",
    "cell.none": "–",
    "cell.hidden": "pseudonymised",
    "cell.accepted": "accepted",
    "t.subjects.legend": "'–': no source that brings in or leads to data of this kind is labelled with these persons.",
    "table.legend": "'no path found' holds under the labels given, and only if nothing on the way is left to review.",
    # --- findings
    "f.intro": (
        "Each entry is one path to assess: one kind of data, from one source, to one place. The list below each heading "
        "is a shortest path; each step names the policy line that allows it. To close a path, change one of these lines, or "
        "put an element in between that anonymises, aggregates or drops them; pseudonymising does not close it. Questions for each: is the disclosure wanted? On which basis of "
        "Article 6, and of Article 9(2) where the data are special? Who is the recipient, and in which role?"
    ),
    "f.none": "There is no path to assess.",
    "f.filter": "Find and filter",
    "f.search": "Search in names, lines and ids",
    "f.all": "all",
    "f.reset": "Show all",
    "f.filter.kind": "Kind of finding",
    "f.filter.state": "State",
    "f.shown": "{shown} of {all} shown",
    "f.noscript": "Searching and filtering need JavaScript; everything is shown without it.",
    "state.open": "to assess",
    "state.accepted": "accepted",
    "state.decided": "decided, not accepted",
    "state.dismissed": "only through another recipient",
    "finding.disclosure": "disclosure",
    "finding.storage-limitation": "storage limitation",
    "finding.third-country-transfer": "transfer to a third country",
    "f.disclosure": "{data} can get from {source} to {leak}, which lets it out.",
    "f.storage-limitation": "{data} from {source} is kept at {leak}: without a stated end, or too long.",
    "f.third-country-transfer": "{data} from {source} can get to {leak}, outside the EEA, without a stated basis.",
    "f.single": "{data} is brought in and let out at {source} itself.",
    "f.pseudonymised": (
        "On these paths the data arrives pseudonymised only. That is still personal data for whoever can tell the persons "
        "(recital 26 GDPR). To be answered: can this recipient do so, alone or with what others hold? For you as controller they remain "
        "personal data (Articles 13 and 14)."
    ),
    "f.dismissed": "Every path to it goes through {names}, which has an entry of its own. Assess that one first.",
    "f.beside": "Past it, the data gets there pseudonymised only: that is an entry of its own.",
    "f.special": "{element} makes data of this kind, which can be a special category, of data that are none by themselves.",
    "f.ways": "{n} paths share no step; closing one leaves the others.",
    "f.paths": "Further paths",
    "f.bounded": "There are more paths than the {n} that are listed.",
    "f.robots": "The same on {robots}. The policy lines are those of the first.",
    "f.because": "Reason: {reason}",
    # --- why data may not be where they get to
    **{f"reason.{key}": text for key, text in REASONS.items()},
    "f.id": "id",
    "f.way": "Shortest path",
    "f.picture": "Picture of the path: {way}",
    "f.picture.part": "Only the shorter paths are drawn; for all of them, with the files of this report: {command}",
    "f.picture.none": "Not drawn here; for a picture, with the files of this report: {command}",
    "f.picture.left": (
        "{n} of the paths below have no picture here, so that the file stays one that can be mailed, or because Graphviz "
        "could not draw them. Each of them says how to get it."
    ),
    "f.picture.extra": (
        "There are no pictures, because Graphviz was not installed where the report was made. With its "
        "headers (Debian: libgraphviz-dev) and the extra [views] of rosprivacy it draws one of each path."
    ),
    "p.legend": "How to read the pictures",
    "p.shapes": (
        "Ovals are nodes, rectangles topics; round corners are services, tabs actions. Other shapes are things outside "
        "ROS. Arrows show where the data goes."
    ),
    "p.source": "brings in {names}",
    "p.leak": "lets out {names}",
    "p.storage-limitation": "kept without an end, or too long: {names}",
    "p.third-country-transfer": "outside the EEA, no basis stated: {names}",
    "p.makes": "makes {to} of {names}",
    "p.pseudonymises": "pseudonymises {names}",
    "p.cleans": "ends {names}",
    "p.unreviewed": "not reviewed: {names}",
    "p.hidden": "{names} (pseudonymised)",
    "p.more": "{names} and {n} more",
    "p.look.source": "brings data in",
    "p.look.leak": "lets data out, or is a place to assess",
    "p.look.derivation": "makes one kind of data of another",
    "p.look.sanitizer": "cleans, but not all",
    "p.look.reviewed": "reviewed: passes on what it gets",
    "p.look.open": "not reviewed: passes on what it gets, as far as is known",
    "p.look.shortest": "step of the shortest path",
    "p.look.way": "step of a longer path",
    "p.look.hidden": "only pseudonymised data",
    "f.now": "from here: {data}",
    "f.data": "{data} (pseudonymised)",
    "f.from.to": "{source} to {leak}",
    "f.number": "Path {n}",
    "f.kind.none": "No path to assess was found for this kind.",
    # --- fleets
    "h.fleet": "The robots of the fleet",
    "fl.intro": (
        "The fleet has {robots}: {kinds}, told apart by their policies and labels. Robots of one kind are alike, so one of them "
        "is shown for all, here and on each path. How many robots a path is on stands with it; the numbers of elements and "
        "flows are those of the whole fleet. Infrastructure, and what the robots share, counts as no robot."
    ),
    "t.robots": "Robots that are alike",
    "c.model": "Model",
    "c.shown": "Shown for all",
    "c.number": "Number",
    "fl.deviants": "Robots that are not as most of their model",
    "fl.deviants.none": "There are none.",
    "fl.deviant": "{robots}, not as most of the model {model}",
    "fl.more": "There, and not at most",
    "fl.fewer": "At most, and not there",
    "fl.begins": "data begins there",
    "fl.ends": "data ends there, from another robot",
    "fl.dismissed": "only through another recipient",
    "fl.dismissed.not": "by a path of its own",
    "fl.hidden": "pseudonymised",
    "fl.hidden.not": "unfiltered",
    "fl.accepted": "accepted by a decision",
    "fl.accepted.not": "not accepted",
    "fl.plain": "not pseudonymised",
    "fl.more_open": "not reviewed: {names}",
    "fl.fewer_open": "not reviewed: {names}",
    "f.fleet": "On {n} of {all}.",
    "f.fleet.none": "It begins and ends outside the robots.",
    "f.fleet.across": "From one robot to another; {n} such paths in the fleet.",
    "f.pattern": "pattern",
    "n.robots": "robots in the fleet",
    "robotkind.one": "{n} kind of robot",
    "robotkind.many": "{n} kinds of robots",
    "file.fleet": "fleet",
    # --- Articles of the GDPR
    "cite.article": "{article}",
    "cite.paragraph": "{article}({paragraph})",
    "cite.point": "{article}({paragraph})({point})",
    # --- decisions
    "d.decision": "Decision",
    "d.accept": "accepted",
    "d.mitigate": "to be mitigated",
    "d.delegate": "delegated",
    "d.avoid": "to be avoided",
    "d.reason": "Reason",
    "d.owner": "Owner",
    "d.legal_basis": "Legal basis (Articles of the GDPR)",
    "d.date": "Decided on",
    "d.ticket": "Tracked at",
    "d.expires": "Valid until",
    "d.state": "State",
    "d.state.valid": "in force",
    "d.state.expired": "expired: it no longer counts",
    "d.state.orphaned": "matches no path any more",
    "d.none": "No decision is recorded.",
    "d.gap.article_6": "No legal basis under Article 6(1) is recorded.",
    "d.gap.article_9": "{data} can be a special category ({provision}), and no exception of Article 9(2) is recorded.",
    "d.gap.reveals": "{data} may reveal what is named in {provision}, and no exception of Article 9(2) is recorded.",
    "d.gap.secrecy": "It rests on Article 9(2)(h), and that Article 9(3), professional secrecy, is met is not recorded.",
    "d.gap.article_10": "{data} can be data of Article 10, and the law that authorises them is not recorded.",
    "d.gap.chapter_v": "The data leave the EEA, and no basis of chapter V (Articles 45, 46, 47 or 49) is recorded; Article 6 alone does not permit it.",
    "d.changed.path": "Changed since it was decided: the shortest path was {before}, and is {now}.",
    "d.changed.view": "Changed since it was decided: then the view of the policies was '{before}', now it is '{now}'.",
    "d.changed.disjoint_paths": "Changed since it was decided: there were {before} separate paths, and there are {now}.",
    "d.changed.robots": "Changed since it was decided: it was about {before} robots, and there are {now}. Nothing is decided about a robot that was not there.",
    "d.orphans": "Decisions that match no path",
    # --- outside ROS
    "o.none": (
        "No label file states a storage, server or other thing outside ROS. That there are none is not shown by this: what "
        "nodes and recipients keep, and for how long, is for a person to complete."
    ),
    "o.intro": "What people stated about them. An empty field was not stated, and is for a person to complete.",
    "t.storages": "Storages and how long they keep data",
    "t.systems": "External systems and other things outside ROS",
    "c.element": "Element",
    "c.holds": "Data that gets there",
    "c.retention": "Kept for",
    "c.backups": "In backups",
    "c.encrypted": "Encrypted at rest",
    "c.place": "Country",
    "c.operator": "Operator",
    "c.recipient.role": "Role of the recipient",
    "c.transfer": "Basis of a transfer",
    "o.kept.backups": "{duration}, in backups {more} more",
    "o.kept.backups.unknown": "{duration}, in backups for longer; how long is not stated",
    "o.notstated": "not stated",
    "o.every": "everything: {duration}",
    "o.of": "{data}: {duration}",
    "o.backups.unknown": "yes, for how long is not stated",
    "o.unlimited": "limit for {data}",
    "area.eea": "in the EEA",
    "area.adequate": "adequacy decision",
    "area.partly": "adequacy decision for some recipients",
    "area.third": "third country",
    "recipient.controller": "controller",
    "recipient.joint-controller": "joint controller",
    "recipient.processor": "processor",
    "recipient.third-party": "third party",
    # --- sanitizers
    "s.none": "No label says that an element cleans data.",
    "s.intro": (
        "Anonymising, aggregating and dropping end a kind of data; pseudonymising does not. Whether an element does what "
        "its label says is for a person to check. What passes beside is as important: others that read the same channels "
        "get the data as it is."
    ),
    "t.sanitizers": "Elements that clean data",
    "c.cleans": "Cleans",
    "c.method": "Method",
    "c.leaves": "Leaves it all the same",
    "c.beside": "Get it beside",
    "c.past": "Paths past it",
    "k.absent": "said not to be on the robot",
    "method.anonymise": "anonymises",
    "method.aggregate": "aggregates",
    "method.drop": "drops",
    "method.pseudonymise": "pseudonymises: still personal data",
    "method.unstated": "not stated: taken as pseudonymising, still personal data",
    "s.unreached": "does not get there",
    "t.derivations": "Elements that make one kind of data of another",
    "c.from": "Of",
    "c.to": "It makes",
    "s.special": "can be a special category from here on",
    # --- open questions
    "q.none": "Every element that data gets to is covered by a label.",
    "q.intro": (
        "Data can get to these elements, and no label speaks of them. Each may be a recipient. They are in the order in "
        "which to review them: nodes that data reaches first, then channels, then what lies behind; within each "
        "group, what most depends on stands first. What data gets to past one element only, a label there can close."
    ),
    "q.first": "Review next: nodes that data reaches before any other open node",
    "q.channels": "Channels",
    "q.behind": "Nodes that lie behind those",
    "q.legs": "{elements}; {legs} with the legs of services and actions",
    "q.waits": "{elements} can wait: from there data gets to no recipient and to no node that is not reviewed",
    "q.proposed": (
        "{elements}: lifecycle or other infrastructure channels, which the label file rosprivacy:infrastructure proposes "
        "to take as free of personal data"
    ),
    "q.brings": "is a source itself ({data}); does it pass on what comes in?",
    "q.reader": "Channels with data that nobody known reads: a reader may stand in a policy that was not given",
    "q.flow": "Elements outside ROS that no flow reaches: what flows into them may have been forgotten",
    "c.data": "Kinds of data",
    "c.distance": "From a source",
    "c.through": "Comes through",
    "c.closes": "Only past it",
    "missing.country": "country",
    # --- criteria
    "w.intro": "Article 35 GDPR asks for an assessment where a processing is likely to result in a high risk. The nine criteria are those of the guidelines WP 248 rev.01, which the EDPB endorsed. As a rule two of them call for an assessment; one can be enough, and two need not be. Who makes none where some are met has to be able to say why. Also look at the list of your authority under Article 35(4). The program shows what it sees; it never says that no assessment is needed.",
    "t.criteria": "The nine criteria of WP 248 rev.01",
    "c.criterion": "Criterion",
    "c.shows": "What the analysis shows",
    "c.answer": "Answer of a person",
    "w.1": "Evaluation or scoring",
    "w.2": "Automated decisions with legal or similar effect",
    "w.3": "Systematic monitoring",
    "w.4": "Sensitive or highly personal data",
    "w.5": "Large scale",
    "w.6": "Matching or combining data",
    "w.7": "Vulnerable persons",
    "w.8": "Innovative use of technology",
    "w.9": "Persons are kept from a right or a service",
    "w.person": "nothing; only a person can say",
    "w.make": "{element} makes {data} of {of}",
    "w.makes": "Elements infer data from other data: {names}",
    "w.observes": "Sources of sensors that can observe persons: {names}",
    "w.special": "Special categories or data of Article 10, always or on a condition: {names}",
    "w.reveals": "May reveal such data, or it is not known: {names}",
    "w.personal": "Highly personal all the same (location, communication, household): {names}",
    "w.none": "no kind of data that is known to be special; whether others are highly personal, a person has to say",
    "w.innovative": "Robots with sensors among persons are a new technology (WP 248, criterion 8){makes}",
    "w.scale": "{robots} analysed; how many persons, how long and where, only a person can say",
    "w.combines": "{elements} with more than one kind of data, such as {names}",
    "w.subjects": "Persons that labels name: {names}",
    "w.article35": (
        "Article 35(3) names cases that always need one: (a) systematic and extensive evaluation of persons with legal or "
        "similar effect, (b) Article 9 or 10 data on a large scale, (c) systematic monitoring of a publicly accessible "
        "area on a large scale."
    ),
    # --- inventory
    "i.intro": "{elements} and {flows} were analysed. The table lists the elements that personal data can get to.",
    "i.search": "Search in the inventory",
    "t.inventory": "Elements that personal data can get to",
    "c.name": "Name",
    "c.robots": "Robots",
    "c.said": "What labels say",
    "c.reviewed": "Reviewed",
    "i.rest": "Elements that none of these kinds of data can get to",
    "i.rest.none": "There are none.",
    "i.enclaves": "Enclaves of the policies, with their nodes",
    "i.enclaves.none": "No enclave is known.",
    "i.denied": "Allowed by one policy line and taken back by another that denies: {flows}.",
    # --- method
    "m.1": "Input",
    "m.1.text": (
        "A robot with ROS 2 is made of programs, called nodes, that send each other data over channels: topics, services "
        "and actions. An SROS 2 policy says, line by line, which node may use which channel. The policies were read as "
        "they are, together with label files in which people say what nodes do with personal data."
    ),
    "m.2": "What people say",
    "m.2.text": (
        "A source brings a kind of personal data in. A recipient (in the program: a leak) lets it out of the system: to a "
        "cloud, a log, a display. A cleaning element (sanitizer) ends a kind of data or pseudonymises it. A deriving "
        "element makes one kind of another, as a face recogniser makes face templates of video. Everything else passes "
        "data on. The same element can be each of these for different kinds of data."
    ),
    "m.3": "What the program computes",
    "m.3.text": (
        "From policies and labels it builds a directed graph and follows every kind of data from its sources to every "
        "place that it can get to. It takes the cautious side: an element that nobody reviewed passes on all that gets to "
        "it. Whether data really goes a path, and how often, a policy does not tell; the report says what is allowed."
    ),
    "m.4": "Kinds of data",
    "m.4.text": (
        "Kinds of data form a hierarchy. Data of a kind may be of any narrower kind: what a label says of a broader kind "
        "as cleaned holds for the narrower; what it says of a narrower kind as let out may concern the broader, and what "
        "it says so of another kind each one that shares a narrower kind with it. Each kind carries what the law says of it, with the condition and the source, tied to the Data Privacy Vocabulary."
    ),
    "m.5": "Pseudonymised data",
    "m.5.text": (
        "Only anonymous data leave the law of data protection. Data that were pseudonymised are followed on, marked as "
        "such (recital 26). Where a label does not state how an element cleans, pseudonymising is assumed."
    ),
    "m.6": "Paths to assess",
    "m.6.text": (
        "For each kind of data, source and place there is one entry, with a shortest path as proof and the number of paths "
        "that share no step. A path that leads only through another recipient of the same kind is listed as such, since "
        "that one has to be assessed first. The id of an entry stays the same as long as kind, source and place do."
    ),
    "m.7": "Verdict",
    "m.7.text": (
        "'leak': there is a path to assess. 'undetermined': there is none, but elements on the way are not reviewed, or no "
        "source was named. 'no-leak-found': there is none, and nothing is open. None of these is a statement of law."
    ),
    "m.8": "What the report cannot know",
    "m.8.text": (
        "What a node does inside, what leaves it past ROS, what a policy that was written by observation did not see, who "
        "stands behind a recipient, for which purpose and on which basis: only people know. The report leaves these "
        "fields empty."
    ),
    "m.9": "The law in this report",
    "m.9.text": (
        "Texts on the law are in the program's own words, with the date of the law and the sources that were read. They "
        "help to find the provision; what counts is the law itself. Guidelines and judgments say how it is read."
    ),
    "m.10": "Can it be repeated?",
    "m.10.text": (
        "The same files give the same report, byte for byte, apart from its date. The hashes above say which files these "
        "were."
    ),
    # --- signature
    "sign.intro": (
        "The fields below are for the person who assesses. The program leaves them empty: it cannot know the answers."
    ),
    "t.sign": "Assessment",
    "c.field": "Field",
    "sign.purpose": "Operations and purposes of the processing (Article 35(7)(a))",
    "sign.controller": "Controller, and data protection officer",
    "sign.basis": "Legal basis (Article 6, and Article 9(2) for special categories)",
    "sign.necessity": "Necessity and proportion (Article 35(7)(b))",
    "sign.measures": "Measures that were decided (Article 35(7)(d))",
    "sign.residual": "Remaining risk, and next review",
    "sign.risks": "Risks to the rights and freedoms of the persons: likelihood, severity, for whom (Article 35(7)(c))",
    "sign.advice": "Advice of the data protection officer (Article 35(2))",
    "sign.views": "Views of the persons or their representatives, such as the works council (Article 35(9))",
    "sign.consultation": "Prior consultation of the supervisory authority, if the risk stays high (Article 36)",
    "sign.name": "Name and role",
    "sign.date": "Place and date",
    "sign.signature": "Signature",
    "redacted": (
        "Names of elements, files, enclaves, robots and persons were replaced in this copy, and free texts left out. Ids "
        "of entries are those of the full report."
    ),
    "redacted.mark": "redacted copy",
    # --- data types of the ontology
    "factors": "Identity factors, Article 4(1)",
    "factor.name": "name",
    "factor.number": "identification number",
    "factor.location": "location data",
    "factor.online-identifier": "online identifier",
    "factor.physical": "physical",
    "factor.physiological": "physiological",
    "factor.genetic": "genetic",
    "factor.mental": "mental",
    "factor.economic": "economic",
    "factor.cultural": "cultural",
    "factor.social": "social",
    "types": "Types of data",
    "type.image": "image",
    "type.video": "video",
    "type.depth": "depth image",
    "type.point-cloud": "point cloud",
    "type.thermal": "thermal image",
    "type.audio": "sound",
    "type.text": "text",
    "type.number": "number",
    "type.position": "position",
    "type.map": "map",
    "type.identifier": "identifier",
    "type.template": "template",
    "type.class-label": "class label",
    "type.record": "record",
    # --- bases of a transfer, Articles 45, 46 and 49
    "transfer.adequacy": "adequacy decision (Article 45)",
    "transfer.public-instrument": "instrument between public bodies (Article 46(2)(a))",
    "transfer.binding-corporate-rules": "binding corporate rules (Article 46(2)(b))",
    "transfer.standard-clauses": "standard contractual clauses (Article 46(2)(c) and (d))",
    "transfer.code-of-conduct": "code of conduct (Article 46(2)(e))",
    "transfer.certification": "certification (Article 46(2)(f))",
    "transfer.authorised-clauses": "clauses that an authority authorised (Article 46(3))",
    "transfer.derogation": "derogation (Article 49)",
    # --- the record of processing
    "r.unbased.partly": "{country}: no basis is stated (the adequacy decision covers some recipients only)",
    "r.unbased.third": "{country}: no basis is stated (no adequacy decision is known)",
    "r.activity": "Name of the processing activity",
    "r.exit": "Where the data leave; the recipient there is to be named",
    "r.country": "Country",
    "r.basis": "Legal basis, as stated, or as decisions record it",
    "r.open": "to be completed",
    "r.dpo": "data protection officer: {name}",
    "t.processed": "What data are processed for, as stated",
    "t.processed.intro": "What label files state of purposes and legal bases where data begin and end. A stated basis is no decision: it changes no finding.",
    "c.where": "Where",
    "c.purposes": "Purposes (Article 5(1)(b))",
    "c.bases": "Legal bases",
    "c.controllers": "Controller",
    "r.letter": "30(1)({letter})",
    "r.category": "Categories of personal data (30(1)(c))",
    "r.article9": "Special category, Article 9(1)",
    "r.provisions": "Provisions to look at",
    "r.subjects": "Categories of data subjects (30(1)(c))",
    "r.recipient": "Categories of recipients, as stated: operator, role (30(1)(d))",
    "r.form": "Form in which the data arrives",
    "r.transfer": "Transfers to third countries and safeguards (30(1)(e))",
    "r.retention": "Time limits for erasure (30(1)(f))",
    "r.measures": "Technical and organisational measures (30(1)(g))",
    "r.controller": "Controller, joint controller, representative, DPO (30(1)(a))",
    "r.purpose": "Purposes (30(1)(b))",
    "r.findings": "Findings",
    "r.complete": "To be completed by a person",
    "r.as.is": "as it is",
    "r.hidden": "pseudonymised",
    "r.norecipient": "no exit found under the labels given",
    "r.measure.enclaves": "SROS 2 policy with {enclaves} (whether it is enforced: to be completed)",
    "r.measure.cleans": "{element} {method}",
    "r.measure.encrypted": "{element}: encrypted at rest",
    "r.note": "Note",
    "r.note.open": "not reviewed, though this data can get there: {elements}; there may be more recipients",
    "r.kept": "{element}: {duration}",
    "h.hangs": "What the answer hangs on",
    "t.hangs": "If this one statement is wrong, this opens",
    "c.statement": "Statement",
    "c.who.why": "Who says so, and why",
    "c.opens": "Paths that would open",
    "c.asks": "Would not be reviewed",
    "u.intro": "Each row is one statement of a label file that takes data or a question away. It is a person's word, and the program cannot check it. The row says what there would be if that one statement were wrong: the analysis without it. Check those first on which a path hangs. The JSON document names every element.",
    "u.none": "No statement takes away a path or a question: nothing hangs on one.",
    "u.nobody": "nobody is named",
    "u.noreason": "no reason is given",
    "u.shipped": "a file that comes with the program, or in place of one",
    "u.sanitizer": "said to clean",
    "u.conduit": "reviewed, passes on",
    "u.mundane": "said to carry no personal data",
    "u.sensitive": "reviewed, may carry personal data",
    "u.only": "said to carry only",
    "u.never": "said never to carry",
    "u.absent": "said not to be on the robot",
    "u.no-leak": "said to let nothing out",
    "u.no-source": "said to bring nothing in",
    "u.refused": "without it the other labels contradict each other: {why}",
    "u.dismissed": "through another recipient only",
    "u.worse": "today only pseudonymised, or only through another recipient",
}
