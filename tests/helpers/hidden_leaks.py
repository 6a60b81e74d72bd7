"""A leak, hidden in each of many ways: what an answer must show of it (rules S7, S11 to S13, S15, S16).

Every case is the same robot: a camera, its video, a reviewed viewer, and an uplink that is a leak. One thing about it is
so that the way to the uplink is not seen, or is taken away by less than a person's word.
"""

from __future__ import annotations

# ruff: noqa: E501 - a case is read in one piece
import gzip
from typing import TYPE_CHECKING, NamedTuple

from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from pathlib import Path

Files = dict[str, str | bytes]

SENSITIVE = "channels: {/video: sensitive}\n"
SEES = f"labels: 1\nnodes: {{/camera: {{source: [Video]}}, /view: {{leak: none, conduit: [Video]}}}}\n{SENSITIVE}"
WITH_UPLINK = SEES.replace("}}\n", "}, /uplink: {leak: [Video]}}\n", 1)
NAMES_THE_LEAK = "labels: 1\nnodes: {/uplink: {leak: [Video]}}\n"


class Hidden(NamedTuple):
    """One way to hide it.

    Attributes
    ----------
    files
        What is read: ``policies`` or ``fleet`` is named, with ``labels`` and other options.
    shows
        ``leak``, ``open``, ``error``, or the name of a doubt.
    breaks
        Whether the exit code is not 0 by default: a leak, an error, something open, a doubt that breaks.
    """

    files: Files
    shows: str
    breaks: bool = True
    policies: tuple[str, ...] = ("p.xml",)
    labels: tuple[str, ...] = ("l.yaml",)
    fleet: str = ""
    more: dict[str, object] = {}  # noqa: RUF012 - nobody changes it


def enclaves(*profiles: str) -> str:
    """A policy with an enclave for each ``node>written<read``."""
    texts = [policy(profile) for profile in profiles]
    inside = (text.partition("<enclaves>")[2].partition("</enclaves>")[0] for text in texts)
    each = (text.replace('path="/e"', f'path="/e{number}"') for number, text in enumerate(inside))
    return f'<policy version="0.2.0"><enclaves>{"".join(each)}</enclaves></policy>'


SEEN = enclaves("/camera>/video", "/view</video")  # all that is read where the uplink stands elsewhere
WHOLE = enclaves("/camera>/video", "/view</video", "/uplink</video")
UP = enclaves("/uplink</video").replace("/e0", "/up")
LIST = (
    '{"access_control": {"enabled": true, "default_permission": "deny", "rules": [{"id": "r", "permission": "allow", '
)
LIST += '"flows": ["ingress"], "messages": ["declare_subscriber"], "key_exprs": ["0/video/**"]}], '
LIST += (
    '"subjects": [{"id": "s", "cert_common_names": ["/uplink"]}], "policies": [{"rules": ["r"], "subjects": ["s"]}]}}'
)
PERMISSIONS = """<dds><permissions><grant name="/up"><subject_name>CN=/up</subject_name><validity>
<not_before>2020-01-01T00:00:00</not_before><not_after>2040-01-01T00:00:00</not_after></validity><allow_rule><domains>
<id>0</id></domains><subscribe><topics><topic>rt/video</topic></topics></subscribe></allow_rule><default>DENY</default>
</grant></permissions></dds>"""
FRAGMENT = UP.partition("<enclaves>")[2].partition("</enclaves>")[0]


def beside(name: str, content: str | bytes, shows: str = "unread-file") -> Hidden:
    """The uplink's policy lies in the folder that is named, as a file of an unusual name or kind."""
    return Hidden({"d/p.xml": SEEN, f"d/{name}": content, "l.yaml": SEES}, shows, policies=("d",))


def labelled(labels: str, shows: str, *, breaks: bool = True, text: str = WHOLE, **more: object) -> Hidden:
    """The labels hide it."""
    return Hidden({"p.xml": text, "l.yaml": f"labels: 1\n{labels}"}, shows, breaks, more=more)


def seen_running(text: str, labels: str, shows: str, *, breaks: bool = True) -> Hidden:
    """The robot was observed: ``text`` is what ``ros2 node info`` printed."""
    return Hidden({"g.txt": text, "l.yaml": labels}, shows, breaks, policies=("r.policy.xml",))


def node_info(name: str, writes: str = "", reads: str = "") -> str:
    """A block of ``ros2 node info``."""
    subscribers = f"    {reads}: sensor_msgs/msg/Image\n" if reads else ""
    publishers = f"    {writes}: sensor_msgs/msg/Image\n" if writes else ""
    rest = "".join(
        f"  {what}:\n\n" for what in ("Service Servers", "Service Clients", "Action Servers", "Action Clients")
    )
    return f"{name}\n  Subscribers:\n{subscribers}\n  Publishers:\n{publishers}\n{rest}"


def services(*lines: str) -> str:
    """Enclaves with service rights: ``node reply|request name``."""
    text = ""
    for number, line in enumerate(lines):
        node, role, name = line.split()
        text += f'<enclave path="/s{number}"><profiles><profile ns="/" node="{node[1:]}"><services {role}="ALLOW">'
        text += f"<service>{name}</service></services></profile></profiles></enclave>"
    return text


def with_services(*lines: str) -> str:
    """The seen policy with service rights."""
    return SEEN.replace("</enclaves>", f"{services(*lines)}</enclaves>")


OBSERVED = node_info("/camera", "/video") + node_info("/view", "", "/video")
REVIEWED = "nodes: {/camera: {source: [Video]}, /view: {leak: none, conduit: [Video]}"
LEAK = "nodes: {/camera: {source: [Video]}, /view: {leak: none, conduit: [Video]}, /uplink: {leak: [Video]}}\n"
RELAYED = LEAK.replace("/uplink", "/relay: conduit, /uplink")
TWO_STEPS = enclaves("/camera>/video", "/view</video", "/relay>/sent</video", "/uplink</sent")

HIDDEN = {
    # files of a named folder (S11)
    "a policy with the ending .policy": beside("up.policy", UP),
    "a policy as a template": beside("up.xml.in", UP),
    "a policy as a backup": beside("up.xml.bak", UP),
    "a policy without an ending": beside("up", UP),
    "a policy as a generator's template": beside("up.xml.erb", UP),
    "a compressed policy": beside("up.xml.gz", gzip.compress(UP.encode(), mtime=0)),
    "a hidden policy": beside(".up.xml", UP, "open"),
    "an access list of Zenoh": beside("uplink.json5", LIST),
    "a fragment that nobody includes": beside("up.xml", FRAGMENT),
    "permissions": beside("permissions.xml", PERMISSIONS, "access-gap"),
    "an ending in capitals": Hidden({"d/p.xml": SEEN, "d/UP.XML": UP, "l.yaml": WITH_UPLINK}, "leak", policies=("d",)),
    # what was observed (S6, S16)
    "two nodes of one name": seen_running(
        OBSERVED + node_info("/uplink") + node_info("/uplink"), WITH_UPLINK, "observation-gap"
    ),
    "nothing is enforced": seen_running(OBSERVED, SEES, "nothing-enforced", breaks=False),
    # dead ends and restrictions (S11)
    "nobody known reads it": Hidden(
        {"p.xml": enclaves("/camera>/video,/more", "/view</video"), "l.yaml": SEES.replace("{/v", "{/more: sensitive, /v", 2)},
        "no-reader",
        breaks=False,
    ),
    "a service without a client": Hidden(
        {"p.xml": with_services("/camera reply /ask"), "l.yaml": SEES + "services: {/ask: sensitive}\n"},
        "no-reader",
        breaks=False,
    ),
    "an element outside ROS that nothing reaches": labelled(
        REVIEWED + "}\n" + SENSITIVE + "elements: {cloud: {kind: external-system, country: DE}}\n",
        "no-flow",
        breaks=False,
        text=SEEN,
    ),
    "another kind was asked for": labelled(
        "nodes: {/camera: {source: [Video, Voice]}, /view: {leak: none, conduit: [Video, Voice]}, /uplink: {leak: [Video], "
        "conduit: [Voice]}}\nchannels: {/video: sensitive}\n",
        "restricted",
        breaks=False,
        categories=("Voice",),
    ),
    "backups that nobody states": labelled(
        "nodes: {/camera: {source: [Video]}, /view: {leak: none, conduit: [Video]}}\n" + SENSITIVE
        + "elements: {disk: {kind: storage, country: DE, retention: P30D, conduit: [Video]}}\n"
        "flows: [{from: /view, to: disk}]\n",
        "backups-not-stated",
        breaks=False,
        text=SEEN,
    ),
    "a fallback that was taken": Hidden(
        {
            "p.xml": SEEN.replace(
                "</enclaves>",
                '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="up.xml"><xi:fallback/></xi:include>'
                "</enclaves>",
            ),
            "l.yaml": SEES,
        },
        "fallback-taken",
        breaks=False,
    ),
    # standard and infrastructure channels (S13)
    "a clock that is no clock": labelled(
        LEAK + SENSITIVE, "standard-closes", text=enclaves("/camera>/video,/x/clock", "/view</video", "/uplink</x/clock")
    ),
    "parameters of nobody": labelled(
        LEAK + SENSITIVE, "standard-closes",
        text=with_services("/camera reply /cloud/get_parameters", "/uplink request /cloud/get_parameters"),
    ),
    "spoken words in /rosout": Hidden(
        {
            "p.xml": enclaves("/camera>/rosout", "/uplink</rosout"),
            "l.yaml": "labels: 1\nnodes: {/camera: {source: [SpeechTranscript]}, /uplink: {leak: [PersonalData]}}\n",
        },
        "leak",
    ),
    "the infrastructure file": Hidden(
        {"p.xml": enclaves("/camera>/video,/tf_static", "/view</video", "/uplink</tf_static"), "l.yaml": WITH_UPLINK},
        "infrastructure-closes",
        breaks=False,
        labels=("l.yaml", "rosprivacy:infrastructure"),
    ),
    # globs and ranks (S7, S11)
    "a glob that calls everything mundane": labelled(
        LEAK + 'channels: {"/*": mundane}\n', "by-globs", breaks=False, text=TWO_STEPS
    ),
    "a glob that calls everything a conduit": labelled(
        'nodes: {/camera: {source: [Video]}, "/*": conduit, /view: {leak: none, conduit: [Video]}}\n' + SENSITIVE, "by-globs", breaks=False
    ),
    "a glob that cleans": labelled(
        'nodes: {/camera: {source: [Video]}, "/rel*": {sanitizer: {Video: drop}}, /view: {leak: none, conduit: [Video]}, '
        "/uplink: {leak: [Video]}}\n" + "channels: {/video: sensitive, /sent: sensitive}\n",
        "by-globs",
        breaks=False,
        text=TWO_STEPS,
    ),
    "a glob that says never": labelled(
        RELAYED + 'channels: {/video: sensitive, "/se*": {never: [Video]}}\n',
        "by-globs",
        breaks=False,
        text=TWO_STEPS,
    ),
    "a glob that says only": labelled(
        RELAYED + 'channels: {/video: sensitive, "/se*": {only: [Voice]}}\n',
        "by-globs",
        breaks=False,
        text=TWO_STEPS,
    ),
    "a bare conduit over a glob's leak": labelled(
        'nodes: {/camera: {source: [Video]}, "/up*": {leak: [Video]}, /uplink: conduit, /view: {leak: none, '
        "conduit: [Video]}}\n" + SENSITIVE,
        "leak",
    ),
    "a conduit of the broadest kind": labelled(
        'nodes: {/camera: {source: [Video]}, "/up*": {leak: [Video]}, /uplink: {conduit: [PersonalData]}, /view: conduit}\n'
        + SENSITIVE,
        "leak",
    ),
    "a broader leak that is none": labelled(
        'nodes: {/camera: {source: [Video]}, "/up*": {leak: [Video]}, /uplink: {leak: {none: [Voice]}}, /view: conduit}\n'
        + SENSITIVE,
        "leak",
    ),
    "both legs of a service": labelled(
        'nodes: {/cam: {source: {Video: [/frame]}}, /cloud: {leak: [Video]}}\nservices: {"/*": mundane}\n',
        "leak",
        text=f'<policy version="0.2.0"><enclaves>{services("/cam reply /frame", "/cloud reply /frame", "/client request /frame")}'
        "</enclaves></policy>",
    ),
    "a kind that may be the one": labelled(
        "nodes: {/camera: {source: [PersonalData]}, /view: conduit, /uplink: {leak: [Biometric]}}\n" + SENSITIVE, "leak"
    ),
    "pseudonymised only": labelled(
        "nodes: {/camera: {source: [Video]}, /view: conduit, /relay: {sanitizer: [Video]}, /uplink: {leak: [Video]}}\n"
        "channels: {/video: sensitive, /sent: sensitive}\n",
        "leak",
        text=TWO_STEPS,
    ),
    "an element that nobody has reviewed": labelled(
        "nodes: {/camera: {source: [Video]}, /view: {leak: none, conduit: [Video]}, /uplink: {leak: [Voice]}}\n" + SENSITIVE,
        "open",
    ),
    "no leak is named": labelled(
        "nodes: {/camera: {source: [Video]}, /view: {conduit: [Video]}, /uplink: conduit}\n" + SENSITIVE, "open"
    ),
    "no source is named": labelled("nodes: {/uplink: {leak: [Video]}}\n" + SENSITIVE, "open"),
    "a name that matches nothing": labelled("nodes: {/camera: {source: [Video]}, /uplnik: {leak: [Video]}}\n", "error"),
    "a kind that is misspelt": labelled("nodes: {/camera: {source: [Vidoe]}, /uplink: {leak: [Video]}}\n", "error"),
    "a leak behind a leak that is accepted by nobody": labelled(
        "nodes: {/camera: {source: [Video]}, /view: conduit, /relay: {leak: [Video]}, /uplink: {leak: [Video]}}\n"
        "channels: {/video: sensitive, /sent: sensitive}\n",
        "leak",
        text=TWO_STEPS,
    ),
    # fleets (S1, S7, S11)
    "a base station without a domain": Hidden(
        {
            "a.xml": SEEN,
            "b.xml": UP,
            "l.yaml": SEES,
            "m.yaml": NAMES_THE_LEAK,
            "f.yaml": "fleet: 1\nrobots: {a: {policies: [a.xml], domain: lab, labels: [l.yaml]}}\n"
            "infrastructure: {base: {policies: [b.xml], labels: [m.yaml]}}\n",
        },
        "leak-joins-nothing",
        fleet="f.yaml",
    ),
    "a domain in capitals": Hidden(
        {
            "a.xml": SEEN,
            "b.xml": UP,
            "l.yaml": SEES,
            "m.yaml": NAMES_THE_LEAK,
            "f.yaml": "fleet: 1\nrobots: {a: {policies: [a.xml], domain: lab, labels: [l.yaml]}}\n"
            "infrastructure: {base: {policies: [b.xml], labels: [m.yaml], domain: Lab}}\n",
        },
        "error",
        fleet="f.yaml",
    ),
    "a robot's glob over its model's name": Hidden(
        {
            "a.xml": WHOLE,
            "l.yaml": WITH_UPLINK,
            "m.yaml": 'labels: 1\nnodes: {"/up*": {leak: none}}\n',
            "f.yaml": "fleet: 1\nmodels: {m: {policies: [a.xml], labels: [l.yaml]}}\n"
            "robots: {a: {model: m, labels: [m.yaml]}}\n",
        },
        "leak",
        fleet="f.yaml",
    ),
    "a leak on another robot of the domain": Hidden(
        {
            "a.xml": SEEN,
            "b.xml": UP,
            "l.yaml": SEES,
            "m.yaml": NAMES_THE_LEAK,
            "f.yaml": "fleet: 1\nrobots: {a: {policies: [a.xml], domain: lab, labels: [l.yaml]}, "
            "b: {policies: [b.xml], domain: lab, labels: [m.yaml]}}\n",
        },
        "leak",
        fleet="f.yaml",
    ),
}  # fmt: skip


def write_files(hidden: Hidden, folder: Path) -> None:
    """Write what a case reads."""
    for name, content in hidden.files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content if isinstance(content, bytes) else content.encode())


def on_a_fleet(hidden: Hidden) -> Hidden:
    """The same robot, as the only one of a fleet."""
    labels = ", ".join(hidden.labels)
    robot = f"{{policies: [{', '.join(hidden.policies)}], labels: [{labels}]}}"
    return hidden._replace(files={**hidden.files, "f.yaml": f"fleet: 1\nrobots: {{r1: {robot}}}\n"}, fleet="f.yaml")
