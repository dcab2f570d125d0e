"""Sends messages to a broker, and waits until it has taken them."""

import time
from collections.abc import Sequence
from pathlib import Path
from threading import Event
from typing import Any

from paho.mqtt.client import Client
from pydantic_core import to_json

from rga.errors import InputError
from rga.operation.sources.broker_client import address_of, broker_client
from rga.operation.telling.twin_messages import TwinMessage

#: how long the broker may take to take messages [s], and how often is looked whether all ends [s]
PATIENCE, LOOK = 20.0, 0.2


class Publisher:
    """Tells a broker of a twin, on a connection of its own: nothing that comes in waits for it.

    Args:
        url: mqtt:// or mqtts://, host and port.
        twin, source: names.
        credentials: file of two lines, user and password.

    Raises:
        InputError: the credentials cannot be read.
    """

    def __init__(self, url: str, twin: str, source: str, credentials: Path | None) -> None:
        self._url, self._above = url, f"rga/v1/{twin}"
        self._client = broker_client(f"rga-{twin}-{source}-tell", url, credentials)
        self._client.on_connect = self._connected
        self._refusal: str | None = None
        #: how often it was connected: a broker that was away may have lost what it retained
        self.connections = 0

    def start(self) -> None:
        """Connect, as often as it takes."""
        self._client.connect_async(*address_of(self._url))
        self._client.loop_start()

    def stop(self) -> None:
        """Let go of the broker."""
        self._client.disconnect()
        self._client.loop_stop()

    def check(self) -> None:
        """Whether the broker is there.

        Raises:
            InputError: it is away.
        """
        if not self._client.is_connected():
            raise InputError(self._refusal or "the broker is away", self._url, "start it")

    def publish(self, messages: Sequence[TwinMessage], ending: Event) -> bool:
        """Send messages; whether the broker has them all, which it has not where all ends before.

        Raises:
            InputError: it does not take them: some may have arrived.
        """
        sent = [
            self._client.publish(
                f"{self._above}/{one.topic}",
                b"" if one.body is None else to_json(one.body, inf_nan_mode="null"),
                qos=1,
                retain=one.retained,
            )
            for one in messages
        ]
        until = time.monotonic() + PATIENCE
        for one in sent:
            while not one.is_published():
                if ending.is_set():
                    return False
                if time.monotonic() > until:
                    raise InputError("the broker takes nothing", self._url, "look at its log")
                one.wait_for_publish(LOOK)
        return True

    def _connected(self, _client: Client, _: Any, __: Any, reason: Any, *___: Any) -> None:
        if reason.is_failure:
            self._refusal = f"the broker refuses: {reason}"
        else:
            self._refusal, self.connections = None, self.connections + 1
