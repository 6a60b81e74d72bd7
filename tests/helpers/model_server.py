"""A server of a language model on loopback, which gives recorded answers and notes what it is sent.

No model runs: what is tested is what is sent, and what is made of any answer.
"""

from __future__ import annotations

import json
import ssl
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path
    from types import TracebackType

    from rosprivacy.analysis.python_311 import Self


class Reply(NamedTuple):
    """What is answered to one request: so many seconds later; with its length, which may lie, or in two chunks."""

    body: bytes
    status: int = 200
    headers: Mapping[str, str] = {}
    after: float = 0
    missing: int = 0  # bytes that are promised and do not come
    chunks: bool = False


class Sent(NamedTuple):
    """What came in."""

    path: str
    headers: Mapping[str, str]
    body: bytes


def completion(content: str | None, **message: Any) -> Reply:
    """A chat completion with a text."""
    choice = {"index": 0, "message": {"role": "assistant", "content": content, **message}, "finish_reason": "stop"}
    return Reply(json.dumps({"object": "chat.completion", "choices": [choice]}).encode())


def said(*answers: Any) -> Reply:
    """A chat completion of the form that is asked for."""
    return completion(json.dumps({"suggestions": answers}))


def answer(id_: str, role: str, kind: str, quote: str, to: str = "") -> dict[str, str]:
    return {"id": id_, "role": role, "kind": kind, "to": to, "quote": quote}


def elements(body: bytes) -> list[dict[str, Any]]:
    """The elements in a request, read out as a model would find them."""
    begin, data, end = json.loads(body)["messages"][1]["content"].split("\n")
    assert begin.removeprefix("BEGIN DATA ") == end.removeprefix("END DATA ")
    found = json.loads(data)["elements"]
    assert isinstance(found, list)
    return found


class ModelServer:
    """Answers on 127.0.0.1 while the block lasts: with each reply in turn, then the last one again.

    Parameters
    ----------
    replies
        What is answered; or one function that makes a reply of what was sent.
    tls
        Certificate and key.
    port
        Any that is free where none is named.
    """

    def __init__(
        self, *replies: Reply | Callable[[bytes], Reply], tls: tuple[Path, Path] | None = None, port: int = 0
    ) -> None:
        self.sent: list[Sent] = []
        self._replies = list(replies)
        self._scheme = "https" if tls else "http"
        outer = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_POST(self) -> None:
                outer._answer(self)

            def log_message(self, *args: object) -> None:
                del args

        self._server = ThreadingHTTPServer(("127.0.0.1", port), Handler)
        if tls:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.load_cert_chain(*tls)
            self._server.socket = context.wrap_socket(self._server.socket, server_side=True)
        self._thread = threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True)

    @property
    def port(self) -> int:
        return self._server.server_port

    @property
    def url(self) -> str:
        return f"{self._scheme}://127.0.0.1:{self.port}/v1"

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def _answer(self, handler: BaseHTTPRequestHandler) -> None:
        body = handler.rfile.read(int(handler.headers["Content-Length"]))
        self.sent.append(Sent(handler.path, dict(handler.headers), body))
        made = self._replies.pop(0) if len(self._replies) > 1 else self._replies[0]
        reply = made if isinstance(made, Reply) else made(body)
        time.sleep(reply.after)
        try:
            handler.send_response(reply.status)
            if reply.chunks:
                handler.send_header("Transfer-Encoding", "chunked")
            else:
                handler.send_header("Content-Length", str(len(reply.body) + reply.missing))
            for name, value in reply.headers.items():
                handler.send_header(name, value)
            handler.end_headers()
            handler.wfile.write(_in_chunks(reply) if reply.chunks else reply.body)
        except OSError:  # who asked has gone
            pass


def _in_chunks(reply: Reply) -> bytes:
    """The body in two chunks; the last one does not come where bytes are missing."""
    half = len(reply.body) // 2
    parts = b"".join(b"%x\r\n%s\r\n" % (len(part), part) for part in (reply.body[:half], reply.body[half:]))
    return parts if reply.missing else parts + b"0\r\n\r\n"
