"""What a packet costs: a service that keeps each on the disk, beside one that only listens."""

import gc
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
from paho.mqtt.client import Client, MQTTMessage, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties

from rga.operation.configuration import read_configuration
from rga.operation.inbox.account import Account
from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import MICROSECONDS, Number, SensorPacket
from rga.operation.served_twin import ServedTwin
from rga.operation.service_clock import ServiceClock
from rga.operation.sources.mqtt import RECEIVE_MAXIMUM, SESSION
from rga.twin import Settings
from rga_bench.operation.broker import Mosquitto
from rga_bench.operation.one_core import one_core
from rga_bench.operation.service_folder import MIDNIGHT, TOPIC, by_broker, write_service

#: channels and samples of a packet of a dense bridge, a second of it
DENSE = (84, 250)
#: one publisher, who sends what it reads from a file: lengths, then payloads
PUBLISHER = """
import sys, time
from pathlib import Path
from paho.mqtt.client import Client, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion
client = Client(CallbackAPIVersion.VERSION2, protocol=MQTTv5)
client.max_inflight_messages_set(1000)
client.connect("127.0.0.1", int(sys.argv[1]))
client.loop_start()
sizes, content = Path(sys.argv[3] + ".sizes"), Path(sys.argv[3]).read_bytes()
first = 0
for size in map(int, sizes.read_text().split()):
    sent = client.publish(sys.argv[2], content[first:first + size], qos=1)
    first += size
    while len(client._out_messages) > 2000:
        time.sleep(0.01)
sent.wait_for_publish()
while client._out_messages:
    time.sleep(0.01)
"""


@dataclass(frozen=True)
class Rate:
    """What packets cost that wait in a broker.

    Attributes:
        packets, size: how many there are, and bytes of one.
        values: readings in one.
        bare: packets a second that a subscriber takes who keeps none [1/s].
        durable: packets a second that are kept, and made into rows [1/s].
    """

    packets: int
    size: int
    values: int
    bare: float
    durable: float

    @property
    def ratio(self) -> float:
        """Durable over bare."""
        return self.durable / self.bare


def rate(
    packets: int, channels: int, samples: int, model: dict[str, Any], settings: Settings
) -> Rate:
    """Let packets wait in a broker, and take them out on one core of this machine.

    Args:
        packets: how many.
        channels, samples: of each.
        model: content of the model file of the twin.
        settings: of the twin.

    Raises:
        InputError: there is no broker.
    """
    names = list(model["sensors"])[:channels]
    payloads = list(_payloads(packets, names, samples))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "payloads").write_bytes(b"".join(payloads))
        (folder / "payloads.sizes").write_text(" ".join(str(len(one)) for one in payloads))
        broker = Mosquitto(folder, "max_queued_messages 0")
        broker.start()
        # As `rga serve` does: what is loaded stays, and is not looked through for garbage.
        gc.freeze()
        try:
            with one_core():
                bare = packets / _bare(broker, folder, packets)
                durable = packets / _durable(broker, folder, packets, model, settings)
        finally:
            gc.unfreeze()
            broker.kill()
    return Rate(packets, len(payloads[-1]), len(names) * samples, bare, durable)


def _payloads(packets: int, names: list[str], samples: int) -> Iterator[bytes]:
    draw = np.random.default_rng(0)
    step = MICROSECONDS // samples
    times = MIDNIGHT + step * np.arange(samples)
    for number in range(packets):
        values = draw.normal(size=(samples, len(names)))
        moments = times + number * samples * step
        packet = SensorPacket(Number("s", number), tuple(names), moments, values)
        yield write_packet(packet, binary=samples > 1, single=samples > 1)


def _publish(broker: Mosquitto, topic: str, folder: Path) -> None:
    command = [sys.executable, "-c", PUBLISHER, str(broker.port), topic, str(folder / "payloads")]
    subprocess.run(command, check=True)


def _bare(broker: Mosquitto, folder: Path, packets: int) -> float:
    """Seconds that a subscriber takes who only acknowledges."""
    topic, done, begun, came = "bare", Event(), [0.0], [0]

    def take(client: Client, _: Any, message: MQTTMessage) -> None:
        begun[0] = begun[0] or time.perf_counter()
        came[0] += 1
        client.ack(message.mid, message.qos)
        if came[0] == packets:
            done.set()

    properties = Properties(PacketTypes.CONNECT)  # type: ignore[no-untyped-call]
    properties.SessionExpiryInterval, properties.ReceiveMaximum = SESSION, RECEIVE_MAXIMUM
    client = Client(CallbackAPIVersion.VERSION2, "bare", protocol=MQTTv5, manual_ack=True)
    client.on_message = take
    for waits in (False, True):
        client.connect("127.0.0.1", broker.port, clean_start=False, properties=properties)
        client.loop_start()
        if waits:
            done.wait()
        else:
            client.subscribe(topic, 1)
            time.sleep(0.5)
        client.disconnect()
        client.loop_stop()
        if not waits:
            _publish(broker, topic, folder)
    return time.perf_counter() - begun[0]


def _durable(
    broker: Mosquitto, folder: Path, packets: int, model: dict[str, Any], settings: Settings
) -> float:
    """Seconds until the inbox of a twin holds them all, and rows were made of them."""
    write_service(folder, model, settings, source=by_broker(broker.url), every=60, lateness=60)
    chosen = read_configuration(folder / "serve.toml").twin[0]

    def taking(until: Callable[[ServedTwin], bool]) -> float:
        twin = ServedTwin(chosen, folder / "east", ServiceClock())
        source = twin.sources()["mqtt"]
        begun = time.perf_counter()
        source.start()
        while not until(twin):
            time.sleep(0.02)
        spent = time.perf_counter() - begun
        source.stop()
        twin.close()
        return spent

    def connected(twin: ServedTwin) -> bool:
        time.sleep(1.0)
        return True

    def kept(twin: ServedTwin) -> bool:
        twin.seal()
        account = sum(twin.packets.account().values(), Account())
        return account.used + account.waiting >= packets

    taking(connected)
    _publish(broker, TOPIC, folder)
    return taking(kept)
