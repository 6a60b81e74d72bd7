"""The guard: one browser that opened the link, from the page itself, by this machine's own names; nobody else."""

from __future__ import annotations

import gc
import http.client
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.routing import Route
from starlette.testclient import TestClient

from rosprivacy.cli import ENOUGH
from rosprivacy.explorer.web.guard import HEADERS, LARGEST, Guard, RequestDoor, refused
from rosprivacy.explorer.web.serving import bound_socket, collect_garbage, server, tunnel

if TYPE_CHECKING:
    from collections.abc import Iterator

    from starlette.requests import Request

PORT = 8700
HOST = f"127.0.0.1:{PORT}"
OURS = {"origin": f"http://{HOST}"}


class Inner:
    """An application that keeps what it was asked."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        routes = [Route("/", self.answer), Route("/label", self.answer, methods=["POST"])]
        self.app = Starlette(routes=routes)

    async def answer(self, request: Request) -> PlainTextResponse:
        self.asked.append(f"{request.method} {request.url.path} {len(await request.body())}")
        return PlainTextResponse("inner")


class Room:
    """An application behind a door, and who knocks."""

    def __init__(self, *, read_only: bool = False) -> None:
        self.inner, self.door = Inner(), RequestDoor(PORT, read_only)
        self.link = self.door.link
        self.app = Guard(self.inner.app, self.door)
        self.client = self.stranger()

    def stranger(self) -> TestClient:
        return TestClient(self.app, base_url=f"http://{HOST}", follow_redirects=False)

    def enter(self) -> Room:
        assert self.client.get(self.link).status_code == 200
        return self


def test_the_link_opens_the_page_once_and_leaves_another_secret() -> None:
    room = Room()
    answer = room.client.get(room.link)
    assert (answer.status_code, "<meta http-equiv=refresh content='0;url=/'>" in answer.text) == (200, True)
    cookie = answer.headers["set-cookie"]
    assert cookie.startswith(f"rosprivacy-{PORT}=")
    assert "httponly" in cookie.lower()
    assert "samesite=strict" in cookie.lower()
    assert room.link.rpartition("=")[2] not in cookie
    assert room.client.get("/").text == "inner"
    assert room.door.link == ""
    assert room.stranger().get(room.link).status_code == 401
    assert room.client.get("/").status_code == 200


@pytest.mark.parametrize("link", ["/enter", "/enter?token=", "/enter?token=wrong", "/enter?token=%C3%A4", "/enter?x=1"])
def test_no_other_token_opens_and_to_look_at_the_link_does_not_use_it_up(link: str) -> None:
    room = Room()
    assert room.client.get(link).status_code == room.client.head(room.link).status_code == 401
    assert room.client.get("/").status_code == 401
    assert not room.inner.asked
    room.enter()


def test_the_cookie_of_the_page_opens_nothing_before_the_link_was_used() -> None:
    room = Room()
    room.client.cookies.set(room.door.cookie, room.door._secret)
    assert room.client.get("/").status_code == 401


@pytest.mark.parametrize("value", ["", "wrong", "ä", "a" * 5000])
def test_no_other_cookie_opens(value: str) -> None:
    room = Room().enter()
    answer = room.stranger().get("/", headers=[(b"cookie", f"{room.door.cookie}={value}".encode())])
    assert answer.status_code == 401
    assert not room.inner.asked


def test_cookies_of_other_programs_on_this_machine_disturb_nothing() -> None:
    room = Room().enter()
    mine = f"{room.door.cookie}={room.door._secret}"
    odd = f'_xsrf=2|a|b; x={{"a": [1]}}; =; rosprivacy-1=other; {mine}; b@d[]=1'
    room.client.cookies.clear()
    assert room.client.get("/", headers={"cookie": odd}).status_code == 200


HOSTS = ("rebound.example", f"rebound.example:{PORT}", "127.0.0.1", "localhost", "127.0.0.1:8701", f"[::1]:{PORT}",
         f"127.0.0.1.:{PORT}", f"LOCALHOST:{PORT}", f"user@{HOST}", "")  # fmt: skip
ORIGINS = ("null", "", "http://rebound.example", f"https://{HOST}", "http://127.0.0.1:8701", f"http://localhost:{PORT}",
           f"http://{HOST}/", f"http://{HOST}.example", f"http://user@{HOST}", "file://")  # fmt: skip
OF_PAGE = ("origin", OURS["origin"])


@pytest.mark.parametrize(
    ("method", "path", "headers", "status"),
    [
        *(("GET", path, [("host", host)], 421) for host in HOSTS for path in ("/", "/enter?token=x")),
        *(("POST", "/label", [("host", host), OF_PAGE], 421) for host in HOSTS),
        *(("POST", "/label", [("origin", origin)], 403) for origin in ORIGINS),
        ("POST", "/label", [], 403),
        ("POST", "/label", [OF_PAGE, OF_PAGE], 403),
        *((method, "/label", [OF_PAGE], 405) for method in ("PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "GEHEIM")),
    ],
)
def test_the_browser_that_opened_the_link_is_refused_too_where_the_page_itself_does_not_ask(
    method: str, path: str, headers: list[tuple[str, str]], status: int
) -> None:
    """Another host, another origin or none, another method: the application is not asked."""
    room = Room().enter()
    content = "a=1" if method == "POST" else None
    assert room.client.request(method, path, headers=headers, content=content).status_code == status
    assert not room.inner.asked


def test_the_page_itself_is_let_in_under_both_names() -> None:
    room = Room().enter()
    assert room.client.post("/label", headers=OURS, content="a=1").text == "inner"
    cookie = {"cookie": f"{room.door.cookie}={room.door._secret}"}
    other = {"host": f"localhost:{PORT}", "origin": f"http://localhost:{PORT}", **cookie}
    assert room.stranger().post("/label", headers=other, content="a=1").text == "inner"


def test_the_length_of_a_form_is_said_and_bounded() -> None:
    assert _status({"content-length": str(LARGEST)}) is None
    assert _status({"content-length": str(LARGEST + 1)}) == 413
    assert _status({"content-length": "9" * 5000}) == 413
    assert _status({}) == 411
    assert _status({"transfer-encoding": "chunked"}) == 411
    assert _status({"transfer-encoding": "chunked", "content-length": "3"}) == 411
    for odd in ("-1", "1e3", "²", "", "3, 3"):
        assert _status({"content-length": odd}) == 400
    room = Room().enter()
    assert room.client.post("/label", headers=OURS, content="a" * (LARGEST + 1)).status_code == 413
    assert not room.inner.asked


def _status(more: dict[str, str]) -> int | None:
    found = refused("POST", Headers({"host": HOST, **OURS, **more}), RequestDoor(PORT))
    return found and found.status


def test_read_only_changes_nothing_and_says_why() -> None:
    room = Room(read_only=True).enter()
    answer = room.client.post("/label", headers=OURS, content="a=1")
    assert (answer.status_code, "--read-only" in answer.text) == (403, True)
    assert room.client.get("/").text == "inner"
    assert room.inner.asked == ["GET / 0"]


@pytest.mark.parametrize("path", ["/", "/nothing", "/enter?token=wrong", "/../etc/passwd", "/%2e%2e/etc/passwd"])
def test_every_answer_says_what_a_browser_may_do_with_it(path: str) -> None:
    room = Room().enter()
    for client in (room.client, room.stranger()):
        answer = client.get(path)
        assert {name: answer.headers.get(name) for name in HEADERS} == HEADERS
        assert answer.status_code in (200, 401, 404)
    assert "unsafe" not in HEADERS["content-security-policy"]


@given(
    st.lists(
        st.tuples(
            st.sampled_from([b"host", b"origin", b"cookie", b"content-length", b"transfer-encoding", b"accept"]),
            st.one_of(st.binary(max_size=40), st.sampled_from([HOST.encode(), OURS["origin"].encode(), b"3"])),
        ),
        max_size=7,
    ),
    st.sampled_from(["GET", "POST", "HEAD", "PUT"]),
)
def test_without_the_secret_nothing_gets_in_and_nothing_breaks(headers: list[tuple[bytes, bytes]], method: str) -> None:
    room = Room().enter()
    sent = [(name, value) for name, value in headers if name != b"host"] + [(b"host", HOST.encode())]
    for each in (headers, sent):
        scope = {"type": "http", "method": method, "path": "/label", "query_string": b"", "headers": each}
        answer = room.app._answer(scope)
        assert answer is not None
        assert 400 <= answer.status_code < 500


@contextmanager
def served(room: Room, port: int) -> Iterator[int]:
    """The real server, on a real socket."""
    with bound_socket(port) as listening:
        running = server(room.app)
        thread = threading.Thread(target=running.run, kwargs={"sockets": [listening]})
        thread.start()
        try:
            yield listening.getsockname()[1]
        finally:
            running.should_exit = True
            thread.join()


def test_the_server_listens_on_this_machine_alone_and_says_nothing_of_itself(capfd: pytest.CaptureFixture[str]) -> None:
    room = Room()
    with served(room, 0) as port:
        room.door.port = port
        asking = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
        asking.request("GET", f"/enter?{room.link.rpartition('?')[2]}")
        answer = asking.getresponse()
        answer.read()
        assert answer.status == 200
        assert answer.headers["server"] is None
        asking.request("GET", "/", headers={"cookie": answer.headers["set-cookie"].partition(";")[0]})
        assert asking.getresponse().read() == b"inner"
        asking.close()
        other = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
        other.request("GET", "/", headers={"upgrade": "websocket", "connection": "upgrade"})
        assert other.getresponse().status == 401
        other.close()
    assert "token" not in "".join(capfd.readouterr())


def test_a_port_that_is_taken_is_an_error_in_one_line() -> None:
    from rosprivacy.analysis.errors import InputError

    with bound_socket(0) as first:
        port = first.getsockname()[1]
        assert first.getsockname()[0] == "127.0.0.1"
        with pytest.raises(InputError, match=rf"^127\.0\.0\.1:{port}: cannot listen there: .*; name another port"):
            bound_socket(port)


def test_the_way_through_ssh_is_told_to_who_came_by_it() -> None:
    came = {"SSH_CONNECTION": "192.0.2.7 51234 2001:db8::9 2222", "LOGNAME": "anna"}
    assert tunnel(8700, came) == "ssh -N -p 2222 -L 8700:127.0.0.1:8700 anna@2001:db8::9"
    assert tunnel(8700, {"SSH_CONNECTION": "odd"}) == ""


@pytest.mark.slow
def test_a_server_looks_for_garbage_often(monkeypatch: pytest.MonkeyPatch) -> None:
    """A command that ends soon never does: a session that lasts for days would take all memory."""
    before = gc.get_threshold()
    monkeypatch.setattr(gc, "freeze", lambda: None)  # for all other tests
    try:
        collect_garbage()
        assert gc.get_threshold()[0] < ENOUGH / 50
    finally:
        gc.set_threshold(*before)
