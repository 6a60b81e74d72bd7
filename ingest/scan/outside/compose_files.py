"""Files of Docker Compose and Kubernetes -> services and volumes beside the robot's own code, each with its line.

Of an environment nothing is kept, neither names nor values: it is where keys and passwords stand. Of a volume its name
or the folder of the host is kept, of a service its name and the ports that others than this machine can reach.

Source: the Compose Specification (services, volumes, ports); the Kubernetes API (Deployment, StatefulSet, DaemonSet,
Pod, Job, CronJob, PersistentVolumeClaim, Service).
"""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.ingest.scan.outside.config_files import Stated, documents, first_bytes, unread
from rosprivacy.ingest.scan.scan_facts import CodePlace, External, Gap

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ingest.scan.checkout_files import CheckoutFiles

COMPOSE = re.compile(r"(?:docker-)?compose(?:[.-][\w.-]+)?\.ya?ml", re.IGNORECASE)
NAMED_COMPOSE = re.compile(r"[\w.-]*compose[\w.-]*\.ya?ml", re.IGNORECASE)  # by its content, if it has services
WORKLOADS = ("Deployment", "StatefulSet", "DaemonSet", "Pod", "Job", "CronJob")
CLAIM = "PersistentVolumeClaim"
KUBERNETES = re.compile(rf"^kind:\s*(?:{'|'.join((*WORKLOADS, CLAIM))})\s*$".encode(), re.MULTILINE)
DEFAULT = re.compile(r"\$\{(\w+)(?:[^\w{}][^{}]*)?\}")  # of a variable, which may hold what nobody should read
LOCAL_HOSTS = ("127.0.0.1", "localhost", "::1", "[::1]")
YAML = (".yml", ".yaml")
PLUMBING = re.compile(r"/(?:dev|proc|sys|run)(?:/.*)?|/tmp/\.X11-unix.*|/etc/(?:localtime|timezone)")
X11_KEY = "xauth"  # in names such as .Xauth, .xauthority; only letters, digits and _ follow
WORD = re.compile(r"\w*")


def read_compose(checkout: CheckoutFiles) -> Stated:
    """Return what the compose files and manifests of a checkout run and keep."""
    found: list[External] = []
    gaps: list[Gap] = []
    root = Path(checkout.root)
    for file in checkout.files:
        compose = bool(NAMED_COMPOSE.fullmatch(PurePosixPath(file).name))
        if not compose and not (file.endswith(YAML) and KUBERNETES.search(first_bytes(root, file))):
            continue
        try:
            for top in documents(root, file):
                found += _of_compose(top, file) if compose else _of_manifest(top, file)
        except InputErrors as errors:
            gaps += [unread(file, error) for error in errors.errors]
        except InputError as error:
            if COMPOSE.fullmatch(PurePosixPath(file).name) or not compose:
                gaps.append(unread(file, error))
    return Stated(tuple(sorted(set(found))), tuple(sorted(set(gaps))))


def _of_compose(top: Value, file: str) -> Iterator[External]:
    mounted: set[str] = set()
    for name, line, service in _entries(top, "services"):
        ports = sorted({port for item in _items(service, "ports") if (port := _published(item))})
        own = f"service {name}" + (f" (port {', '.join(ports)})" if ports else "")
        yield _stated(file, line, own)
        for item in _items(service, "volumes"):
            volume = _volume(item)
            if volume and not _is_plumbing(volume):
                mounted.add(volume)
                yield _stated(file, item.line, f"volume {volume}")
    for name, line, _ in _entries(top, "volumes"):
        if name not in mounted:
            yield _stated(file, line, f"volume {_plain(name)}")


def _of_manifest(top: Value, file: str) -> Iterator[External]:
    kind, about = _text(top, "kind"), top.get("metadata")
    name = _plain(_text(about, "name")) if about else ""
    if kind in WORKLOADS and name:
        yield _stated(file, top.line, f"service {name}")
        for volume in _host_paths(top):
            yield _stated(file, volume.line, f"volume {_plain(volume.text)}")
    elif kind == CLAIM and name:
        yield _stated(file, top.line, f"volume {name}")


def _host_paths(top: Value) -> Iterator[Value]:
    """The folders of the host that a workload mounts."""
    waiting = [top]
    while waiting:
        value = waiting.pop()
        path = value.get("hostPath")
        inside = path.get("path") if path else None
        if inside and inside.text:
            yield inside
        waiting += [*value.items, *(entry for key, _, entry in value.entries if key != "env")]


def _stated(file: str, line: int, name: str) -> External:
    return External(CodePlace(file, line), name, "compose", incoming=True, outgoing=True, stated=True)


def _entries(top: Value, key: str) -> Sequence[tuple[str, int, Value]]:
    value = top.get(key)
    return value.entries if value else ()


def _items(service: Value, key: str) -> Sequence[Value]:
    value = service.get(key)
    return value.items if value else ()


def _text(value: Value | None, key: str) -> str:
    inside = value.get(key) if value else None
    return inside.text if inside else ""


def _plain(text: str) -> str:
    """A text without the defaults of variables."""
    return DEFAULT.sub(r"${\1}", text)


def _published(item: Value) -> str:
    """The port of the host that others than this machine can reach; empty if there is none.

    ``8080:80`` is reached from everywhere, ``127.0.0.1:8080:80`` from here alone, ``80`` by a port that nobody names.
    """
    if item.kind == "map":
        return "" if _text(item, "host_ip") in LOCAL_HOSTS else _plain(_text(item, "published"))
    address, _, _ = _plain(item.text).rpartition(":")
    host, _, port = address.rpartition(":")
    return "" if host in LOCAL_HOSTS else port


def _volume(item: Value) -> str:
    """What is mounted: a named volume, or a folder of the host; empty for one that goes with the container."""
    if item.kind == "map":
        return _plain(_text(item, "source"))
    source, colon, _ = _plain(item.text).partition(":")
    return source if colon else ""


def _is_plumbing(volume: str) -> bool:
    """Whether a volume only joins a container to the system: devices, its clock, its screen."""
    _, key, rest = volume.replace("Xauth", X11_KEY).rpartition(X11_KEY)
    return PLUMBING.fullmatch(volume) is not None or (bool(key) and WORD.fullmatch(rest) is not None)
