"""A service that runs, as commands ask it."""

import json
import os
import time
from collections.abc import Mapping
from http.client import HTTPException
from typing import Any
from urllib.error import HTTPError, URLError
from urllib.parse import urlencode, urlsplit
from urllib.request import Request, urlopen

from rga.errors import InputError

#: environment variable of the token
TOKEN = "RGA_TOKEN"
#: how long an answer is waited for, and what came of a command [s]
ANSWER, OUTCOME = 60.0, 600.0
#: how often is asked what came of a command [s]
LOOK = 0.5
#: letters of an answer that are shown where it is an error
SHOWN = 2000


def is_service(place: str) -> bool:
    """Whether a place is a twin of a service that runs.

    >>> is_service("http://127.0.0.1:8471/east"), is_service("postgresql://host/twins")
    (True, False)
    """
    return place.startswith(("http://", "https://"))


class ServiceClient:
    """A twin of a service that runs.

    Args:
        place: http://host:port/twin.

    Raises:
        InputError: it names no twin.
    """

    def __init__(self, place: str) -> None:
        parts, self._place = urlsplit(place), place
        self.twin = parts.path.strip("/")
        if not parts.netloc or not self.twin or "/" in self.twin:
            raise InputError("this names no twin", place, "write http://host:port/twin")
        self._root = f"{parts.scheme}://{parts.netloc}/api/v1/twins/{self.twin}"

    def get(self, path: str = "", query: Mapping[str, Any] | None = None) -> Any:
        """What the service answers.

        Raises:
            InputError: it does not, or says why not.
        """
        return self._answer(Request(f"{self._root}{path}?{urlencode(query or {})}"))

    def post(self, path: str, content: Any) -> Any:
        """What the service answers to something that is sent.

        Raises:
            InputError: it does not, or says why not.
        """
        told = {"Content-Type": "application/json"}
        body = json.dumps(content).encode()
        return self._answer(Request(f"{self._root}{path}", body, told, method="POST"))

    def outcome_of(self, command: Mapping[str, Any]) -> str:
        """What comes of a command, once the twin has carried it out.

        Raises:
            InputError: it is refused, or it still waits after a while.
        """
        number = self.post("/commands", command)["number"]
        end = time.monotonic() + OUTCOME
        while time.monotonic() < end:
            state = self.get(f"/commands/{number}")
            if state["state"] == "refused":
                raise InputError(state["outcome"], self._place, "look where the twin stands now")
            if state["state"] == "done":
                return str(state["outcome"])
            time.sleep(LOOK)
        remedy = "it is kept, and its outcome will stand in the log: rga replay"
        raise InputError(f"command {number} still waits", self._place, remedy)

    def _answer(self, request: Request) -> Any:
        if token := os.environ.get(TOKEN):
            request.add_header("Authorization", f"Bearer {token}")
        try:
            with urlopen(request, timeout=ANSWER) as answer:
                return json.load(answer)
        except HTTPError as error:
            said = error.read(SHOWN).decode(errors="replace")
            remedy = f"give a token in {TOKEN}" if error.code in (401, 403) else "mend what it says"
            raise InputError(_detail(said) or str(error), self._place, remedy) from None
        except (URLError, OSError, HTTPException, ValueError) as error:
            reason = getattr(error, "reason", error)
            raise InputError(
                f"the service does not answer: {reason}", self._place, "check the address"
            ) from None


def _detail(said: str) -> str:
    """What an error of the service says."""
    try:
        return str(json.loads(said)["detail"])
    except (ValueError, KeyError, TypeError):
        return ""
