"""A client of a broker, as a configuration states the broker."""

import ssl
from pathlib import Path
from urllib.parse import urlsplit

from paho.mqtt.client import Client, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion

from rga.operation.sources.secrets import credentials_of

#: ports of plain and of encrypted connections
PLAIN, SECURE = 1883, 8883


def broker_client(name: str, url: str, credentials: Path | None) -> Client:
    """A client that is not connected yet, and goes on whatever its callbacks do.

    Args:
        name: by which the broker knows it.
        url: mqtt:// or mqtts://, host and port.
        credentials: file of two lines, user and password.

    Raises:
        InputError: the credentials cannot be read.
    """
    client = Client(CallbackAPIVersion.VERSION2, name, protocol=MQTTv5)
    if credentials is not None:
        client.username_pw_set(*credentials_of(credentials))
    if _is_secure(url):
        client.tls_set_context(ssl.create_default_context())
    client.reconnect_delay_set(1, 60)
    # Else a callback that fails would end the thread of the connection.
    client.suppress_exceptions = True
    return client


def address_of(url: str) -> tuple[str, int]:
    """Host and port of a broker.

    >>> address_of("mqtt://broker"), address_of("mqtts://broker:9000")
    (('broker', 1883), ('broker', 9000))
    """
    parts = urlsplit(url)
    return parts.hostname or "", parts.port or (SECURE if _is_secure(url) else PLAIN)


def _is_secure(url: str) -> bool:
    return urlsplit(url).scheme == "mqtts"
