"""The beginning of a file -> what it is by its content, whatever its name (rule S11).

In: bytes. Out: ``FileKind``, or None for anything else. A file is told by how it begins: what stands before the first
element or brace may be comments and what templates put there, no prose. So a page that quotes a policy is none.
"""

from __future__ import annotations

import bz2
import lzma
import re
import zlib
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.reading.bounded_file import beginning

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

BOUND = 2**18  # bytes in which a file says what it is: a configuration of Zenoh has its list far behind
HEAD = 4096  # bytes in which a signed file says that it is
SIGNED = b"multipart/signed"
ACCESS = "access_control"
BAG = "rosbag2_bagfile_information"  # key of the metadata of a recording
EVERY_NODE = "/**:"  # begins a file of parameters, and no comment


class FileKind(NamedTuple):
    """What a file is, and what to do with it.

    Attributes
    ----------
    key
        What a reader of this program looks for in such a file; empty where no reader of YAML takes it.
    """

    name: str
    instead: str
    key: str = ""

    def refused(self, purpose: str, file: str) -> tuple[str, str]:
        """Return the problem and what to do where something else is wanted."""
        return f"this is {self.name}, and not {purpose}", self.instead.replace("FILE", shown(file))


POLICY = FileKind("an SROS 2 policy", "name it by itself")
PERMISSIONS = FileKind("permissions or governance", "name it by itself")
ACCESS_LIST = FileKind("an access list of Zenoh", "name it by itself, as .json5")
NODE_INFO = FileKind(
    "the output of `ros2 node info`",
    "see what could get out: rosprivacy try FILE; or make a policy of it: rosprivacy observe --text FILE",
)
ROS_GRAPH = FileKind("a message with the graph of ROS", "make a policy of it: rosprivacy observe --rosgraph FILE")
OBSERVE = "make a policy of what runs: rosprivacy observe --ros2"
START = f"start it, and {OBSERVE}"
LAUNCH = FileKind("a launch file", f"see what could get out of what it starts: rosprivacy try FILE; or {START}")
DESCRIPTION = FileKind(
    "a description of a node's interface (NoDL)",
    "name it by itself, as .nodl.yaml or .nodl.xml: rosprivacy try FILE",
)
DESCRIPTIONS = (".nodl.yaml", ".nodl.yml", ".nodl.json", ".nodl.xml")
"""How the names of descriptions end."""
COMPOSE = FileKind("a file of Docker Compose", START)
PARAMETERS = FileKind("a file of ROS parameters", OBSERVE)
NAMES_ALONE = FileKind(
    "a list of names, as `ros2 node list` prints it",
    "it does not say who uses what: ask each node, rosprivacy observe --ros2",
)
PROJECT = FileKind("a project file", "give it with --project, or work in its folder")
RECORDED = FileKind("a bag", "see what is in it: rosprivacy bag FILE")
_BY_KEY = {
    "labels": FileKind("a label file", "give it with --labels (-l)", "labels"),
    "fleet": FileKind("a fleet file", "give it with --fleet", "fleet"),
    "types": FileKind("a file of message types", "give it with --types", "types"),
    "decisions": FileKind("a file of decisions", "give it with --decisions", "decisions"),
    BAG: FileKind("a bag", "see what is in it: rosprivacy bag FOLDER", BAG),
    "launch": LAUNCH,
    ACCESS: ACCESS_LIST,
}
_BY_ROOT = {
    "interface": DESCRIPTION,
    "robot": FileKind("a description of a robot's body (URDF)", OBSERVE),
    "sdf": FileKind("a world or a model of a simulator (SDF)", OBSERVE),
    "package": FileKind("a package's manifest", f"name its folder: rosprivacy try FOLDER; or {OBSERVE}"),
    "cyclonedds": FileKind("settings of a middleware", "name what is deployed: a policy, permissions or a keystore"),
}
SAVED_GRAPH = FileKind("a saved graph", "give it with --add")
_BY_FORMAT = {
    "graph": SAVED_GRAPH,
    "analysis": FileKind("a saved analysis", "compare with it: rosprivacy diff FILE POLICY"),
}

_BEFORE = {  # what may stand before the first element or brace -> where it ends
    "<?": "?>", "<!--": "-->", "<!": ">", "]": ">", "<%": "%>", "{%": "%}", "{#": "#}", "{{": "}}", "#": "\n",
    "//": "\n", "/*": "*/", "@": "@", "---": "\n", "%": "\n",
}  # fmt: skip
_ROOT = re.compile(r"<(?:[A-Za-z_][\w.-]*:)?([A-Za-z_][\w.-]*)")
_GRANT = re.compile(r"""(?:publish|subscribe|request|reply|call|execute)=["'](?:ALLOW|DENY)["']""")
_KEY = re.compile(r"""^["']?([A-Za-z_]\w*)["']?[ \t]*:""", re.MULTILINE)
_NAMES = re.compile(r"(?:/[\w/]+(?: \[[\w/, ]+\])?\r?\n)+")
_FIRST = re.compile(r"""["']?[\w/*]+["']?[ \t]*:[ \t]*(?:\r?$|[\w"'{\[|>&-])""", re.MULTILINE)
_INNER = re.compile(r"""^[ \t]+["']?(\w+)["']?[ \t]*:""", re.MULTILINE)
_PROJECT = re.compile(r"(?:policies|fleet|labels|types|decisions|baseline)[ \t]*=|\[tool\.rosprivacy\]")
_NODE = re.compile(r"^/\S+\r?\n  (?:Subscribers|Publishers):", re.MULTILINE)
_FORMAT = re.compile(r'"format": ?"rosprivacy\.([a-z]+)/')
_RECORDED = (b"\x89MCAP", b"SQLite format 3\0")
_PACKED: Mapping[bytes, Callable[[bytes], bytes]] = {
    b"\x1f\x8b": lambda data: zlib.decompressobj(31).decompress(data, BOUND),
    b"BZh": lambda data: bz2.BZ2Decompressor().decompress(data, BOUND),
    b"\xfd7zXZ\0": lambda data: lzma.LZMADecompressor(memlimit=2**27).decompress(data, BOUND),
}


def kind_of(data: bytes) -> FileKind | None:
    r"""Return what a file is by its first ``MOST`` bytes; packed ones are looked into.

    >>> [kind_of(text) for text in (b"# A page\n\nof a <policy>", b"")]
    [None, None]
    >>> kind_of(b"<!-- a template -->\n<policy version='0.2.0'>").name, kind_of(b"labels: 1\n").name
    ('an SROS 2 policy', 'a label file')
    """
    data = _unpacked(data[:BOUND])
    if data.startswith(_RECORDED):
        return RECORDED
    if is_signed(data):
        return PERMISSIONS
    text = _text(data)
    at = _beginning(text)
    if root := _ROOT.match(text, at):
        return _of_xml(root[1].lower(), text)
    if "def generate_launch_description(" in text:
        return LAUNCH
    return _of_values(text, at) or _of_lines(text, at)


def kind_of_map(keys: Sequence[str], inner: Collection[str], form: str = "") -> FileKind | None:
    """Return what a map is by its keys, the first above all, and by those of the maps in it.

    Parameters
    ----------
    form
        What it says under ``format``.

    Examples
    --------
    >>> kind_of_map(["services"], ["web", "image"]).name, kind_of_map(["/camera"], ["ros__parameters"]).name
    ('a file of Docker Compose', 'a file of ROS parameters')
    """
    if keys and keys[0] in _BY_KEY:
        return _BY_KEY[keys[0]]
    if form.startswith("rosprivacy."):
        return _BY_FORMAT.get(form.removeprefix("rosprivacy.").partition("/")[0])
    if keys and keys[0] == "nodes" and {"publishers", "subscriptions"} <= {*inner}:
        return ROS_GRAPH
    if "nodl_version" in keys:
        return DESCRIPTION
    if "ros__parameters" in inner:
        return PARAMETERS
    return COMPOSE if "services" in keys and ("image" in inner or "build" in inner) else None


def of_key(key: str) -> str:
    """Return how a file is called that says its version under a key."""
    return _BY_KEY[key].name if key in _BY_KEY else f"a file with '{key}: 1'"


def kind_of_file(name: str) -> FileKind | None:
    """Return what a regular file is by its beginning; None of anything else.

    Raises
    ------
    OSError, ValueError
        If it cannot be read.
    """
    return kind_of(beginning(name, BOUND, passed_over=True))


def is_signed(data: bytes) -> bool:
    """Return whether a file says of itself that it is signed (S/MIME)."""
    return SIGNED in data[:HEAD].partition(b"<dds")[0]


def _unpacked(data: bytes) -> bytes:
    for magic, unpack in _PACKED.items():
        if data.startswith(magic):
            try:
                return unpack(data)
            except (zlib.error, OSError, ValueError, EOFError, lzma.LZMAError):
                return b""
    return data


def _text(data: bytes) -> str:
    """What is no text is none: a zero byte is in no UTF-8 that people write."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "ignore")
    return "" if b"\0" in data[:HEAD] else data.decode("utf-8", "ignore").removeprefix("\ufeff")


def _beginning(text: str) -> int:
    """Where the first element, brace or word stands."""
    at, last = 0, -1
    while at != last:
        last = at
        while at < len(text) and text[at].isspace():
            at += 1
        for begins, ends in _BEFORE.items():
            if text.startswith(begins, at) and not text.startswith(EVERY_NODE, at):
                end = text.find(ends, at + len(begins))
                at = len(text) if end < 0 else end + len(ends)
                break
    return at


def _of_xml(root: str, text: str) -> FileKind | None:
    if root == "launch":
        return LAUNCH
    if root == "dds":
        return PERMISSIONS if "permissions" in text or "domain_access_rules" in text else None
    if root == "policy" or (root != "html" and _GRANT.search(text)):
        return POLICY
    return _BY_ROOT.get(root)


def _of_lines(text: str, at: int) -> FileKind | None:
    """What prints lines: ``ros2``; and TOML."""
    if _NODE.search(text):
        return NODE_INFO
    if _PROJECT.match(text, at) or "\n[tool.rosprivacy]" in text:
        return PROJECT
    return NAMES_ALONE if _NAMES.fullmatch(text.strip() + "\n") else None


def _of_values(text: str, at: int) -> FileKind | None:
    """YAML, JSON or JSON5, by keys of the outermost map: the first, or that of an access list."""
    if text.startswith("{", at):
        if match := _FORMAT.search(text, at, at + HEAD):
            return _BY_FORMAT.get(match[1])
        keys = _keys(text, at)
        listed = ACCESS in text
    else:
        keys = (match[1] for match in _KEY.finditer(text, at)) if _KEY.match(text, at) else iter(())
        listed = True
    outer = list(keys)
    if listed and ACCESS in outer and outer[0] not in _BY_KEY:
        return ACCESS_LIST
    return kind_of_map(outer, {match[1] for match in _INNER.finditer(text, at)} if _FIRST.match(text, at) else ())


def _keys(text: str, at: int) -> Iterator[str]:
    """The keys of the outermost map of JSON5, which need no quotes; a comment or a text may hold anything."""
    depth, end = 0, len(text)
    while at < end:
        sign, begin = text[at], at
        at += 1
        if sign in "{[":
            depth += 1
        elif sign in "}]":
            depth -= 1
        elif sign == "/":
            ends = _BEFORE.get(text[begin : at + 1], "")
            closed = text.find(ends, at + 1)
            at = end if closed < 0 else max(at, closed + len(ends)) if ends else at
        elif sign in "\"'":
            while at < end and text[at] != sign:
                at += 1 + (text[at] == "\\")
            at += 1
        elif sign.isidentifier():
            while at < end and text[at].isidentifier():
                at += 1
        else:
            continue
        word = text[begin:at].strip("\"'")
        if depth == 1 and word.isidentifier() and text[at : at + 64].lstrip().startswith(":"):
            yield word
