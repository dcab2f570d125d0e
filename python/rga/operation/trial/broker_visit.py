"""Listens to a broker as a guest: nothing that it says or subscribes to stays there."""

from secrets import token_hex
from typing import Any

from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.subscribeoptions import SubscribeOptions

from rga.operation.sources.broker_client import address_of, broker_client
from rga.operation.sources.settings import MqttSource
from rga.operation.sources.source import Inlet


class BrokerVisit:
    """A connection under a name of its own, whose session ends with it.

    Args:
        settings: of the source.
        inlet: keeps what comes.

    Raises:
        InputError: the credentials cannot be read.
    """

    def __init__(self, settings: MqttSource, inlet: Inlet) -> None:
        self._settings, self._inlet = settings, inlet
        # The name of the service would throw the service out, and take its messages.
        name = f"rga-check-{token_hex(6)}"
        self._client = broker_client(name, settings.url, settings.credentials)
        self._client.on_connect, self._client.on_message = self._connected, self._came
        self._client.on_subscribe, self._client.on_connect_fail = self._subscribed, self._away
        self.fault: str | None = f"the broker {settings.url} does not answer"

    def start(self) -> None:
        """Connect, and take messages."""
        # Without a time of expiry the session ends with the connection.
        self._client.connect_async(*address_of(self._settings.url), clean_start=True)
        self._client.loop_start()

    def stop(self) -> None:
        """Leave, and leave nothing behind."""
        self._client.disconnect()
        self._client.loop_stop()

    def _connected(self, client: Client, _: Any, flags: Any, reason: Any, *__: Any) -> None:
        if reason.is_failure:
            self.fault = f"the broker {self._settings.url} refuses: {reason}"
            return
        options = SubscribeOptions(qos=0)
        client.subscribe([(topic, options) for topic in self._settings.topics])

    def _subscribed(self, _client: Client, _: Any, __: Any, reasons: Any, *___: Any) -> None:
        denied = [
            f"{topic} ({reason})"
            for topic, reason in zip(self._settings.topics, reasons, strict=False)
            if reason.is_failure
        ]
        self.fault = f"the broker refuses the topics {', '.join(denied)}" if denied else None

    def _came(self, _client: Client, _: Any, message: MQTTMessage) -> None:
        self._inlet.receive([(message.topic, bytes(message.payload))])

    def _away(self, *_: Any) -> None:
        self.fault = f"the broker {self._settings.url} cannot be reached"
