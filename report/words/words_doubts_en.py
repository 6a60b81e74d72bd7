"""Doubts in English: a title, what is said of one and of several with their names, what to do."""

DOUBTS = {
    "access-gap": (
        "What is allowed is not known",
        "what {names} allows is not known",
        "what is allowed is not known at {n} places ({names})",
        "look at the warnings about these files, and at the enforced view (--view enforced)",
    ),
    "analysed-in-parts": (
        "An answer of a fleet in parts",
        "of robots that are not shown no doubts are told",
        "of robots that are not shown no doubts are told",
        "ask about the whole fleet in memory, or about the robots that matter",
    ),
    "backups-not-stated": (
        "A storage whose backups nobody states",
        "backups of {names} are not stated and taken as none",
        "backups of {n} storages are not stated and taken as none ({names})",
        "state them in the label file: backups: P30D, or backups: false",
    ),
    "bag-gap": (
        "Not all is known of a bag",
        "not all is known of the bag {names}",
        "not all is known of {n} bags ({names})",
        "name the policies of the system that was recorded, or repair the bag (rosprivacy bag says what is wrong)",
    ),
    "by-globs": (
        "Only a glob answers for an element",
        "only a glob answers for {names}",
        "only globs answer for {n} elements ({names})",
        "look at each, then keep what was seen: rosprivacy labels --pin",
    ),
    "careful-deny": (
        "A search that a bound cut",
        "a bound cut what a DENY in {names} leaves of wildcards",
        "a bound cut what {n} DENYs leave of wildcards ({names})",
        "raise the bound on comparisons",
    ),
    "empty-group": (
        "Lines of a policy that grant nothing",
        "a group of lines in {names} has no rule and grants nothing",
        "{n} groups of lines have no rule and grant nothing ({names})",
        'write publish="ALLOW" or the like there, or remove them',
    ),
    "empty-include": (
        "An include that brings nothing",
        "an include in {names} brings nothing",
        "{n} includes bring nothing ({names})",
        "correct what the include selects, or remove it",
    ),
    "fallback-taken": (
        "A fallback was taken",
        "a fallback was taken in {names}",
        "{n} fallbacks were taken ({names})",
        "give the file that is included, or take the fallback out",
    ),
    "joins-nothing": (
        "A domain or infrastructure that joins nothing",
        "a domain or infrastructure in {names} joins nothing",
        "{n} domains or infrastructures join nothing ({names})",
        "name its domain, or a flow to it; leave the domain out if it is meant to be alone",
    ),
    "leak-joins-nothing": (
        "A domain or infrastructure that lets data out and joins nothing",
        "a domain or infrastructure in {names} that lets data out or keeps it joins nothing",
        "{n} domains or infrastructures that let data out or keep it join nothing ({names})",
        "name its domain, or a flow to it; leave the domain out if it is meant to be alone",
    ),
    "made-without-warnings": (
        "A text of what runs that was made without warnings",
        "the text behind {names} was made without warnings",
        "{n} texts of what runs were made without warnings ({names})",
        "make the text anew with -a, --include-hidden and 2>&1, and observe it again",
    ),
    "mistaken-tilde": (
        "A name behind ~ without /",
        "a name in {names} has no / behind ~ and is another name",
        "{n} names have no / behind ~ and are other names ({names})",
        "write ~/ before it",
    ),
    "infrastructure-closes": (
        "Only the file of infrastructure closes the way to a leak",
        "only the file of infrastructure closes the way to a leak at {names}",
        "only the file of infrastructure closes the ways to leaks at {n} channels ({names})",
        "look at what the channel carries, and say so in a label",
    ),
    "no-flow": (
        "An element outside ROS that no flow reaches",
        "no flow reaches {names}",
        "no flow reaches {n} elements outside ROS ({names})",
        "say in the label file what flows into it, or remove it",
    ),
    "no-reader": (
        "Data that nobody known reads",
        "{names} ends at no known reader",
        "{n} channels end at no known reader ({names})",
        "give the policy of whoever reads it, or look who does (rosprivacy observe)",
    ),
    "no-robot": (
        "Folders of a group of robots without its policy",
        "folders of a group in {names} have no policy and are no robots",
        "folders of {n} groups have no policy and are no robots ({names})",
        "give these folders the policy, or move them elsewhere",
    ),
    "nothing-enforced": (
        "Nothing is enforced for what was observed",
        "nothing is enforced for {n} node ({names})",
        "nothing is enforced for {n} nodes ({names})",
        "see what any program on the network can read (--view both); the policy that rosprivacy observe wrote can be enforced: ros2 security generate_artifacts -k KEYSTORE -p POLICY, and ROS_SECURITY_STRATEGY=Enforce",
    ),
    "observation-gap": (
        "An observation that is known to miss something",
        "the observation is known to miss something ({names})",
        "the observation is known to miss {n} things ({names})",
        "observe again until no gap is left (rosprivacy observe), or name a policy",
    ),
    "odd-namespace": (
        "A namespace that does not begin with /",
        "a namespace in {names} does not begin with /",
        "{n} namespaces do not begin with / ({names})",
        "write / before it",
    ),
    "paths-not-counted": (
        "A search that a bound cut",
        "a bound cut the count of paths",
        "a bound cut {n} counts of paths",
        "raise the bound, or ask about fewer kinds of data",
    ),
    "refused-name": (
        "A name that no ROS node can have",
        "a name in {names} is none that a ROS node can have",
        "{n} names are none that a ROS node can have ({names})",
        "correct the name: it meets no other, or the wrong ones",
    ),
    "restricted": (
        "Only some kinds of data were asked for",
        "only some kinds of data were asked for",
        "only some kinds of data were asked for",
        "ask about all kinds",
    ),
    "standard-closes": (
        "Only the standard file closes the way to a leak, at a channel that is not in its standard place",
        "only the standard file closes the way to a leak at {names}, which is not a standard channel in its place",
        "only the standard file closes the ways to leaks at {n} channels that are not in their standard place ({names})",
        "look at what the channel carries, and say so in a label by its full name",
    ),
    "type-closes": (
        "Only the type of a channel closes the way to a leak",
        "only the type of a channel closes the way to {names}",
        "only the types of channels close the ways to {n} leaks ({names})",
        "look at what the channel carries, and say so in a label",
    ),
    "types-of-nothing": (
        "Observed types of what nothing is called",
        "{names} tells types of channels or nodes that are not there",
        "{n} files tell types of channels or nodes that are not there ({names})",
        "give the policy of what was seen running too, or the file of this system",
    ),
    "unread-file": (
        "A file with grants that was not read",
        "{names} was not read",
        "{n} files were not read ({names})",
        "name the file, or the policy that includes it, or move it out of the folder",
    ),
}
WORDS = {
    "r.answer": "The answer that this record rests on",
    "h.doubts": "Doubts",
    "doubt.sentence": "In doubt: {doubts}.",
    "verdict.doubtful": "Not determined: not all is known",
    "verdict.doubtful.means": "No path to a recipient was found, but something that could hide one is not known: the section on doubts names it. Until it is known, nothing can be concluded.",
    "doubt.accepted.one": "{n} doubt accepted",
    "doubt.accepted.many": "{n} doubts accepted",
    "doubt.list": "Doubts: what is not known, or rests on more than a person's word ({n})",
    "doubt.breaks": "breaks",
    "doubt.rides": "rides",
    "doubt.is.accepted": "accepted until {date} by {owner}: {reason}",
    "doubt.what.to.do": "What to do: {do}",
    "doubt.none": "Nothing is known to be in doubt.",
    **{
        f"doubt.{name}.{part}": text
        for name, texts in DOUBTS.items()
        for part, text in zip(("title", "one", "many", "do"), texts, strict=True)
    },
}
