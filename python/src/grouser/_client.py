"""The REST interface of a coordinator, as JSON in and out."""

from __future__ import annotations

import json
import ssl
import urllib.error
import urllib.parse
import urllib.request
from http.client import HTTPException
from typing import Any

from ._error import ServiceError

TIMEOUT_S = 120.0
LOOPBACK = {"127.0.0.1", "localhost", "::1"}


class Client:
    """A coordinator at a URL.

    Args:
        url: as in ``http://host:7070``.
        token: the bearer token that the service asks for, or none.
        ca_certificate: a PEM file with the authority of an https service; by default, those of this machine.
    """

    def __init__(self, url: str, token: str | None = None, ca_certificate: str | None = None) -> None:
        parts = urllib.parse.urlsplit(url)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError(f"{url}: not an http or https URL")
        self.url = url.rstrip("/")
        self.token = token
        self.ca_certificate = ca_certificate
        handlers: list[urllib.request.BaseHandler] = []
        if parts.hostname in LOOPBACK:
            handlers.append(urllib.request.ProxyHandler({}))
        if parts.scheme == "https":
            context = ssl.create_default_context(cafile=ca_certificate)
            handlers.append(urllib.request.HTTPSHandler(context=context))
        self._opener = urllib.request.build_opener(*handlers)

    def get(self, path: str, **query: str | int | bool | None) -> Any:
        """The JSON at a path below ``/v1``."""
        return json.loads(self.text(path, **query))

    def text(self, path: str, **query: str | int | bool | None) -> str:
        """The text at a path below ``/v1``."""
        stated = {k: str(v).lower() if isinstance(v, bool) else v for k, v in query.items() if v is not None}
        question = f"?{urllib.parse.urlencode(stated)}" if stated else ""
        return self._send(urllib.request.Request(f"{self.url}/v1/{path}{question}"))

    def post(self, path: str, body: Any = None) -> Any:
        """Posts JSON to a path below ``/v1`` and returns the JSON of the answer."""
        data = json.dumps({} if body is None else body, allow_nan=False).encode()
        headers = {"Content-Type": "application/json"}
        return json.loads(self._send(urllib.request.Request(f"{self.url}/v1/{path}", data, headers, method="POST")))

    def _send(self, request: urllib.request.Request) -> str:
        if self.token:
            # Not for whom the service redirects to.
            request.add_unredirected_header("Authorization", f"Bearer {self.token}")
        try:
            with self._opener.open(request, timeout=TIMEOUT_S) as answer:
                text: str = answer.read().decode()
                return text
        except urllib.error.HTTPError as error:
            raise _refusal(error, self.url) from None
        except (urllib.error.URLError, HTTPException, OSError) as error:
            reason = getattr(error, "reason", error)
            raise ServiceError(f"no answer from {self.url}: {reason}", "unreachable", 0) from error


def _refusal(error: urllib.error.HTTPError, url: str) -> ServiceError:
    with error:
        body = error.read()
    try:
        detail = json.loads(body)["error"]
        return ServiceError(str(detail["message"]), str(detail["type"]), error.code)
    except (ValueError, KeyError, TypeError):
        return ServiceError(f"{url} answered {error.code} {error.reason}", "unknown", error.code)
