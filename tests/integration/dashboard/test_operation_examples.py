"""What examples/operation gives for a service: each file does what it says."""

import json
import re
import shutil
import subprocess
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from paho.mqtt.client import Client, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion
from starlette.testclient import TestClient
from typer.testing import CliRunner

from documentation import ROOT
from rga.cli.app import app
from rga.operation.configuration import read_configuration
from rga_bench.operation.broker import PROGRAM, Mosquitto
from served.made_service import write_service

EXAMPLES = ROOT / "examples" / "operation"
#: exposure of a service to the system, of 10, that may not be passed
EXPOSURE = 2.0
METRIC = re.compile(r"\brga_[a-z_]+\b")


def expressions() -> list[str]:
    """Every expression of the rules and of the dashboard."""
    rules = yaml.safe_load((EXAMPLES / "prometheus-rules.yml").read_text("utf-8"))
    found = [rule["expr"] for group in rules["groups"] for rule in group["rules"]]
    panels = json.loads((EXAMPLES / "grafana.json").read_text("utf-8"))["panels"]
    return found + [target["expr"] for panel in panels for target in panel["targets"]]


def test_every_metric_that_is_named_is_one(client: TestClient) -> None:
    told = set(re.findall(r"^# TYPE (\S+)", client.get("/metrics").text, re.MULTILINE))
    named = {name for one in expressions() for name in METRIC.findall(one)}
    assert named <= told
    assert len(named) > 8


def test_prometheus_takes_the_rules() -> None:
    program = shutil.which("promtool")
    if program is None:
        pytest.skip("promtool is not installed")
    rules = str(EXAMPLES / "prometheus-rules.yml")
    subprocess.run([program, "check", "rules", rules], check=True)


def test_the_service_is_hardly_exposed(tmp_path: Path) -> None:
    program = shutil.which("systemd-analyze")
    if program is None:
        pytest.skip("systemd-analyze is not installed")

    def exposure(unit: Path) -> float:
        said = subprocess.run(
            [program, "security", "--offline=true", str(unit)], capture_output=True, text=True
        )
        found = re.search(r"exposure level for \S+: ([\d.]+)", said.stdout)
        if found is None:
            pytest.skip(f"systemd-analyze says nothing: {said.stderr.strip()}")
        return float(found[1])

    text = (EXAMPLES / "rga.service").read_text("utf-8")
    bare = tmp_path / "rga.service"
    bare.write_text("[Service]\nExecStart=/opt/rga/bin/rga serve serve.toml\n", "utf-8")
    assert exposure(EXAMPLES / "rga.service") <= EXPOSURE < exposure(bare)
    assert "DynamicUser=yes" in text


def test_the_configuration_can_be_read() -> None:
    found = read_configuration(EXAMPLES / "serve.toml")
    unit = (EXAMPLES / "rga.service").read_text("utf-8")
    secrets = [found.notify[0].url_file, found.twin[0].source[0].credentials]  # type: ignore[union-attr]
    for one in secrets:
        assert one is not None
        assert f"LoadCredential={one.name}:" in unit
        assert one.parent == Path("/run/credentials/rga.service")


@pytest.fixture
def guarded(tmp_path: Path) -> Iterator[Mosquitto]:
    """A broker of the configuration in examples, with a certificate of its own."""
    programs = [PROGRAM, shutil.which("mosquitto_passwd"), shutil.which("openssl")]
    if None in programs:
        pytest.skip("mosquitto, mosquitto_passwd or openssl is not installed")
    _, password, openssl = (str(one) for one in programs)
    key, certificate = tmp_path / "rga.key", tmp_path / "rga.pem"
    made = ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost"]
    names = ["-addext", "subjectAltName=IP:127.0.0.1"]
    places = ["-keyout", str(key), "-out", str(certificate)]
    subprocess.run([openssl, *made, *names, *places], check=True, capture_output=True)
    passwords = tmp_path / "rga.passwords"
    passwords.touch()
    for user in ("rga", "logger-east", "logger-west"):
        subprocess.run([password, "-b", str(passwords), user, f"secret of {user}"], check=True)
    shutil.copy(EXAMPLES / "acl", tmp_path / "rga.acl")
    text = (EXAMPLES / "mosquitto.conf").read_text("utf-8")
    text = text.replace("/etc/mosquitto/", f"{tmp_path}/")
    text = text.replace("/var/lib/mosquitto/", f"{tmp_path}/")
    broker = Mosquitto(tmp_path)
    # Where tests are run by root, the broker would become a user who may not read the folder.
    text = text.replace("listener 8883", f"listener {broker.port} 127.0.0.1\nuser root")
    (tmp_path / "mosquitto.conf").write_text(text, "utf-8")
    broker.start()
    yield broker
    broker.kill()


class Guest:
    """A client of the broker.

    Attributes:
        came: topics of what came.
        refused: why it may not come in; None: it may.
    """

    def __init__(self, broker: Mosquitto, folder: Path, user: str, password: str) -> None:
        self.came: list[str] = []
        self.refused: str | None = None
        self._known, self._sent = threading.Event(), threading.Event()
        self._reason: Any = None
        self.client = Client(CallbackAPIVersion.VERSION2, user, protocol=MQTTv5)
        self.client.username_pw_set(user, password)
        self.client.tls_set(str(folder / "rga.pem"))
        self.client.on_connect, self.client.on_publish = self._connected, self._published
        self.client.on_message = lambda _, __, one: self.came.append(one.topic)
        self.client.connect("127.0.0.1", broker.port)
        self.client.loop_start()
        assert self._known.wait(20)

    def _connected(self, _: Any, __: Any, ___: Any, reason: Any, *____: Any) -> None:
        self.refused = str(reason) if reason.is_failure else None
        self._known.set()

    def _published(self, _: Any, __: Any, ___: Any, reason: Any, *____: Any) -> None:
        self._reason = reason
        self._sent.set()

    def publishes(self, topic: str) -> bool:
        """Whether the broker takes a message."""
        self._sent.clear()
        self.client.publish(topic, b"1", qos=1)
        assert self._sent.wait(20)
        return not self._reason.is_failure

    def close(self) -> None:
        """Leave."""
        self.client.disconnect()
        self.client.loop_stop()


def test_a_logger_may_send_below_its_twin_alone(guarded: Mosquitto, tmp_path: Path) -> None:
    service = Guest(guarded, tmp_path, "rga", "secret of rga")
    service.client.subscribe("rga/v1/+/data/#", 1)
    logger = Guest(guarded, tmp_path, "logger-east", "secret of logger-east")
    stranger = Guest(guarded, tmp_path, "logger-west", "guessed")
    assert (service.refused, logger.refused) == (None, None)
    assert stranger.refused is not None
    own = "rga/v1/east/data/logger-east"
    for topic in (
        "rga/v1/west/data/logger-east",
        "rga/v1/east/data/logger-west",
        "rga/v1/east/ack/mqtt",
        "rga/v1/east/status",
        "elsewhere",
    ):
        assert not logger.publishes(topic)
    assert logger.publishes(own)
    # The service says what it has kept, and sends no data.
    assert service.publishes("rga/v1/east/ack/mqtt")
    assert not service.publishes(own)
    # What was sent last has come, and nothing that was refused came before.
    for _ in range(200):
        if service.came:
            break
        threading.Event().wait(0.05)
    assert service.came == [own]
    for one in (service, logger, stranger):
        one.close()


@pytest.mark.parametrize(
    ("password", "code", "words"),
    [
        ("secret of rga", 0, "warning: nothing came within 0.6 s"),
        ("guessed", 2, " refuses: Not authorized"),
    ],
)
def test_a_check_comes_in_by_the_password_of_the_service(
    guarded: Mosquitto,
    measured_bridge: dict[str, Any],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    password: str,
    code: int,
    words: str,
) -> None:
    monkeypatch.setenv("SSL_CERT_FILE", str(tmp_path / "rga.pem"))
    (tmp_path / "broker.secret").write_text(f"rga\n{password}\n", "utf-8")
    url = f'url = "mqtts://127.0.0.1:{guarded.port}"'
    more = 'topics = ["rga/v1/east/data/#"]\ncredentials = "broker.secret"'
    write_service(tmp_path, measured_bridge, source=f'kind = "mqtt"\n{url}\n{more}')
    asked = ["serve", str(tmp_path / "serve.toml"), "--check", "--wait", "0.6"]
    found = CliRunner().invoke(app, asked)
    assert found.exit_code == code
    assert words in found.output
