"""Doubts in English: a title, what is said of one and of several with their names, what to do."""

DOUBTS = {
    "access-gap": (
        "What is allowed is not known",
        "what {names} allows is not known",
        "what is allowed is not known at {n} places ({names})",
        "look at the warnings about these files, and at the enforced view (--view enforced)",
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
    "empty-group": (
        "A group of robots that no rule covers, or that is empty",
        "a group of robots has nothing in it ({names})",
        "{n} groups of robots have nothing in them ({names})",
        "correct the fleet file",
    ),
    "fallback-taken": (
        "A fallback was taken",
        "a fallback was taken in {names}",
        "{n} fallbacks were taken ({names})",
        "give the file that is included, or take the fallback out",
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
    "paths-not-counted": (
        "A search that a bound cut",
        "a bound cut the count of paths",
        "a bound cut {n} counts of paths",
        "raise the bound, or ask about fewer kinds of data",
    ),
    "restricted": (
        "Only some kinds of data were asked for",
        "only some kinds of data were asked for",
        "only some kinds of data were asked for",
        "ask about all kinds",
    ),
    "type-closes": (
        "Only the type of a channel closes the way to a leak",
        "only the type of a channel closes the way to {names}",
        "only the types of channels close the ways to {n} leaks ({names})",
        "look at what the channel carries, and say so in a label",
    ),
    "unread-file": (
        "A file with grants that was not read",
        "{names} was not read",
        "{n} files were not read ({names})",
        "name the file, or the policy that includes it, or remove it",
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
