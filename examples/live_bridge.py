"""Serve the twin of a footbridge whose abutment will settle, and play its logger.

    python examples/live_bridge.py [--no-browser] [--folder DIR]

A page opens: the twin calibrates, an alarm is raised, a cause is proposed, and waits for you to
accept it under "Causes"; then the gap falls. The readings come from physics of its own
(rga_bench.synthetic) through a broker (mosquitto), or straight to the service where there is none.
"""

import argparse
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import webbrowser
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path
from urllib.request import urlopen

from rga.operation.feeding.senders import BrokerSender, HttpSender, Sender
from rga.operation.feeding.sent_record import sent_record
from rga.operation.packets.native import write_packet
from rga.records import RecordMapping
from rga_bench.synthetic import Case, draw_case

#: of the bridge and of what happens to it
SEED = 6
#: rows that are there when the page opens
BEFORE = 200
#: rows by which a cause can be proposed: on a slow machine the logger waits for it there
ENOUGH = 290
#: seconds between rows: until a cause is proposed, until it is accepted, and from then on
UNTIL_PROPOSED, UNTIL_ACCEPTED, THEN = 0.25, 2.0, 0.3
TOPIC = "rga/v1/footbridge/data/logger"
CONFIGURATION = """
[service]
listen = "127.0.0.1:{port}"
data = "data"
[[twin]]
name = "footbridge"
model = "model.json"
settings = "settings.json"
rows = {{ every = "30 min", lateness = "30 min", patience = "2 h" }}
[[twin.source]]
name = "logger"
# The record is played faster than it was measured.
clock = {{ check = false }}
{source}
"""
SETTINGS = {"calibration_rows": 120, "packet": 6, "settle": 12, "adopt": "ask"}


def main() -> None:
    """Serve, feed, and end with what was hidden."""
    options = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    options.add_argument("--no-browser", action="store_true", help="open no page")
    options.add_argument("--folder", type=Path, default=Path("runs/live-bridge"), help="of it all")
    options.add_argument("--port", type=int, default=8471, help="of the pages")
    options.add_argument("--pace", type=float, default=1.0, help="times as long between rows")
    given = options.parse_args()
    shutil.rmtree(given.folder, ignore_errors=True)
    case = draw_case(
        SEED, bridge="footbridge", kind="support_settlement", reality="truss", rows=480,
        aims=(100.0, 200.0),
    )  # fmt: skip
    case.write(given.folder)
    # Who ends this process otherwise than by Ctrl-C ends what it has begun as well.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with ExitStack() as running:
        sender = begin(given.folder, given.port, running)
        page = f"http://127.0.0.1:{given.port}/"
        print(f"The twin is served: {page} (end it with Ctrl-C)", flush=True)
        if not given.no_browser:
            webbrowser.open(page)
        try:
            feed(given.folder, sender, f"{page}api/v1/twins/footbridge", given.pace)
            print(f"All rows are sent. {hidden(case)} The pages stay until Ctrl-C.", flush=True)
            while True:
                time.sleep(1.0)
        except KeyboardInterrupt:
            print(hidden(case))


def begin(folder: Path, port: int, running: ExitStack) -> Sender:
    """Begin the broker, if there is one, and the service; gives what sends to them."""
    program = shutil.which("mosquitto", path=f"{os.environ.get('PATH', '')}:/usr/sbin")
    broker, source = "", 'kind = "http"'
    if program is not None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            broker = f"127.0.0.1:{free.getsockname()[1]}"
        listener = broker.replace("127.0.0.1:", "listener ") + " 127.0.0.1"
        (folder / "mosquitto.conf").write_text(f"{listener}\nallow_anonymous true\n", "utf-8")
        running.enter_context(process(program, "-c", str(folder / "mosquitto.conf")))
        source = f'kind = "mqtt"\nurl = "mqtt://{broker}"\ntopics = ["{TOPIC}"]'
    configuration = CONFIGURATION.format(port=port, source=source)
    (folder / "serve.toml").write_text(configuration, "utf-8")
    (folder / "settings.json").write_text(json.dumps(SETTINGS), "utf-8")
    served = process(sys.executable, "-m", "rga", "serve", str(folder / "serve.toml"))
    service = running.enter_context(served)
    address = f"http://127.0.0.1:{port}"
    while True:
        if service.poll() is not None:
            sys.exit("the service has ended: is the port free? (--port)")
        with suppress(OSError), urlopen(f"{address}/healthz", timeout=5):
            break
        time.sleep(0.1)
    if program is None:
        return HttpSender(f"{address}/footbridge")
    return BrokerSender(f"mqtt://{broker}/{TOPIC}", "logger")


@contextmanager
def process(*command: str) -> Iterator[subprocess.Popen[bytes]]:
    """A process that ends with the block."""
    begun = subprocess.Popen(command)
    try:
        yield begun
    finally:
        begun.terminate()
        begun.wait()


def feed(folder: Path, sender: Sender, twin: str, pace: float) -> None:
    """Send the rows of the record one by one, and wait where somebody is to decide."""
    rows = sent_record(folder / "record.csv", RecordMapping(), datetime.now(UTC) - timedelta(10))
    for row in range(len(rows.times)):
        packet = rows.packet(row, row, row + 1)
        sender.send(write_packet(packet), packet.number)
        if row > BEFORE:
            time.sleep(pace * pause(twin))
        while row >= ENOUGH and pause(twin) == UNTIL_PROPOSED:
            time.sleep(UNTIL_PROPOSED)
    sender.finish()


def pause(twin: str) -> float:
    """Seconds to the next row."""
    with urlopen(twin, timeout=30) as answer:
        now = json.load(answer)["now"]
    if now is not None and now["version"] > 1:
        return THEN
    return UNTIL_PROPOSED if now is None or now["undecided"] is None else UNTIL_ACCEPTED


def hidden(case: Case) -> str:
    """What was hidden, in words."""
    truth = case.truth
    support, millimetres = truth["place"]["support"], -1e3 * truth["value"]
    return f"Hidden was: support {support} has settled by {millimetres:.2f} mm."


if __name__ == "__main__":
    main()
