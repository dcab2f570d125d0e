"""The file of a service: what it says, and what is refused in a line."""

from pathlib import Path

import pytest

from rga.errors import InputError, SeveralMistakes
from rga.operation.configuration import read_configuration
from rga.operation.served_twin import live_settings
from rga.operation.sources.settings import FolderSource, OpcUaSource, SqlSource

SOUND = """
[service]
listen = "127.0.0.1:8471"
[[twin]]
name = "pratt-7"
model = "pratt.json"
settings = "settings.toml"
rows = { every = "60 s", lateness = "10 min" }
[[twin.source]]
kind = "folder"
path = "logger"
mapping = "import.toml"
[[twin.source]]
kind = "mqtt"
url = "mqtt://broker:1883"
topics = ["rga/v1/pratt-7/data/#"]
clock = { check = false }
[[twin.source]]
kind = "mqtt"
name = "numbers"
url = "mqtt://broker:1883"
topics = ["site/#"]
format = "number"
channel_topic = "site/{channel}"
[[twin.source]]
kind = "http"
format = "row"
columns = ["time", "D1"]
[[twin.source]]
kind = "sql"
url = "postgresql://rga@plant/history"
password = "plant.secret"
table = "public.reading"
position = "id"
[[twin.source]]
kind = "opcua"
url = "opc.tcp://plant:4840"
nodes = { D1 = "ns=2;s=D1" }
[alarms]
disk = 0.2
lag = "2 h"
quality = { off = "0 s" }
[[notify]]
url_file = "mail.secret"
on = ["alarm", "proposal", "silent", "source", "disk", "doubted", "refused"]
at_most = "12 an hour"
all_is_well = "07:00"
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "serve.toml"
    path.write_text(text, "utf-8")
    return path


def test_a_configuration_is_read(tmp_path: Path) -> None:
    found = read_configuration(written(tmp_path, SOUND))
    twin = found.twin[0]
    assert found.service.data == tmp_path / "data"
    assert twin.model == tmp_path / "pratt.json"
    assert (twin.rows.grid.every, twin.rows.grid.lateness) == (60_000_000, 600_000_000)
    folder, broker, numbers, rows, table, server = twin.source
    assert isinstance(folder, FolderSource)
    assert folder.path == tmp_path / "logger"
    assert folder.mapping == tmp_path / "import.toml"
    assert folder.clock.rule is not None
    assert broker.clock.rule is None
    assert numbers.stated.pattern is not None
    assert rows.stated.columns == ("time", "D1")
    assert isinstance(table, SqlSource)
    assert table.password == tmp_path / "plant.secret"
    assert isinstance(server, OpcUaSource)
    assert server.stated.format == "packet"
    assert found.alarms.delays["quality"] == (60.0, 0.0)
    assert (found.alarms.disk, found.alarms.lag) == (0.2, 7200.0)
    (notify,) = found.notify
    assert notify.url_file == tmp_path / "mail.secret"
    assert notify.at_most == (12, 3600.0)
    assert str(notify.all_is_well) == "07:00:00"
    assert found.service.address == "http://127.0.0.1:8471"


def test_a_link_is_where_people_find_the_pages(tmp_path: Path) -> None:
    text = SOUND.replace("[service]", '[service]\nlink = "https://bridges.example/"')
    assert read_configuration(written(tmp_path, text)).service.address == "https://bridges.example"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"pratt-7"', '"../up"', "twin '../up', name: "),
        ('"60 s"', '"60"', "no duration"),
        ('"60 s"', "60", "no duration"),
        ('"60 s"', '"0.1 ms"', "rows.every: it is 0.1 ms, and at least 1 ms is needed"),
        ('"60 s"', '"999999 d"', "it is 999999 d, and at most 366 d is possible"),
        ("rows = {", 'false_alarms = "seldom"\nrows = {', "no rate"),
        ("rows = {", 'false_alarms = "1 an hour"\nrows = {', "one in 60 rows of 60 s"),
        ("check = false", 'check = "no"', "clock.check: write true or false"),
        ('"mqtt"', '"kafka"', "kafka"),
        ("mqtt://broker:1883", "http://broker", "no broker"),
        ("mqtt://broker:1883", "mqtt://a:b@broker", "password"),
        ("127.0.0.1:8471", "everywhere", "service.listen"),
        ("127.0.0.1:8471", "127.0.0.1:99999", "ports go from 1 to 65535"),
        ("127.0.0.1:8471", "127.0.0.1:0", "ports go from 1 to 65535"),
        ("[service]", '[service]\ndata = ""', "service.data: name a folder"),
        ('"mqtt"', '"kafka"', "kind is one of http, mqtt, folder, sql, opcua, and 'kafka' is none"),
        ('kind = "folder"', 'kin = "folder"', "say its kind"),
        ("rows = {", "rws = {}\nrows = {", "twin 'pratt-7', rws: there is no such key"),
        ("rows = {", "rws = {}\nrows = {", "the keys of [twin] are name, model, settings"),
        ("[service]", "[service]\nport = 1", "the keys of [service] are listen, data"),
        (
            'path = "logger"',
            'path = "logger"\npol = 3',
            "the keys of [twin.source.folder] are name",
        ),
        ('topics = ["rga/v1/pratt-7/data/#"]', "topics = []", "topics"),
        ("[service]", "[services]", "services"),
        ('path = "logger"', 'path = "logger"\nshift = 3', "shift"),
        ('path = "logger"', 'path = "logger"\nfiles = "../x"', "names within the folder"),
        ('path = "logger"', 'path = "logger"\nformat = "yaml"', "format"),
        ('channel_topic = "site/{channel}"', "", "needs channel_topic"),
        ('format = "number"', "", "channel_topic is of numbers"),
        ("site/{channel}", "site/channel", "one level of the topic"),
        ('columns = ["time", "D1"]', "", "needs columns"),
        ('format = "row"', "", "columns are of rows"),
        ('format = "row"', 'format = "number"', "names no channel"),
        ('["time", "D1"]', '["D1", "D1"]', "name every column once"),
        ("postgresql://rga@plant", "postgresql://rga:secret@plant", "url holds a password"),
        ("postgresql://rga@plant/history", "plant", "no address of a database"),
        ('position = "id"', 'position = "id"\nvalue = "v"', "both, or neither"),
        ('position = "id"', 'position = "id"\noverlap = -1', "overlap"),
        ("opc.tcp://plant:4840", "http://plant", "no server"),
        ("opc.tcp://plant", "opc.tcp://a:b@plant", "password"),
        ('nodes = { D1 = "ns=2;s=D1" }', "nodes = {}", "nodes"),
        ('"ns=2;s=D1"', '"zz"', "'zz' is no address of a variable"),
        ('"12 an hour"', '"12 a week"', "no rate"),
        ('"12 an hour"', '"0 an hour"', "no rate"),
        ('"silent"', '"mood"', "notify 1, on 3: "),
        ('["alarm", "proposal", "silent", "source", "disk", "doubted", "refused"]', "[]", "on: "),
        ('"07:00"', '"07:00+01:00"', "it is in UTC"),
        ('"07:00"', '"noon"', "all_is_well"),
        ("disk = 0.2", "disk = 2", "alarms.disk"),
        ("[[notify]]", "[[notify]]\nurl = 'x'", "notify 1, url: "),
        ("[service]", "[service]\nlink = 'bridge'", "service.link"),
        ('"0 s"', '"-1 s"', "no duration"),
        ('kind = "folder"', 'kind = "folder"\nname = "mqtt"', "two sources are called 'mqtt'"),
    ],
)
def test_what_is_wrong_is_told(old: str, new: str, words: str, tmp_path: Path) -> None:
    assert old in SOUND
    with pytest.raises(InputError) as refused:
        read_configuration(written(tmp_path, SOUND.replace(old, new)))
    assert words in str(refused.value)
    assert "serve.toml" in str(refused.value)


def test_two_addresses_of_one_name_are_refused(tmp_path: Path) -> None:
    text = f'{SOUND}[[notify]]\nurl_file = "other/mail.secret"\n'
    with pytest.raises(InputError, match=r"have a url_file 'mail\.secret'"):
        read_configuration(written(tmp_path, text))


def test_two_twins_of_one_name_are_refused(tmp_path: Path) -> None:
    twin = SOUND[SOUND.index("[[twin]]") : SOUND.index("[alarms]")]
    with pytest.raises(InputError, match="two twins are called 'pratt-7'"):
        read_configuration(written(tmp_path, SOUND + twin))


@pytest.mark.parametrize(("said", "rows"), [("1 a quarter", 131_490), ("2 a year", 262_980)])
def test_false_alarms_are_rows_between_them(tmp_path: Path, said: str, rows: float) -> None:
    text = SOUND.replace("rows = {", f'false_alarms = "{said}"\nrows = {{')
    twin = read_configuration(written(tmp_path, text)).twin[0]
    assert twin.arl0 == pytest.approx(rows)
    path = tmp_path / "settings.toml"
    path.write_text("packet = 10\n", "utf-8")
    assert live_settings(path, twin.arl0).arl0 == pytest.approx(rows)
    assert live_settings(path, None).arl0 == 10_000
    for line, words in (("arl0 = 20000", "say the same"), ('detector = "window"', "no rate")):
        path.write_text(f"{line}\n", "utf-8")
        with pytest.raises(InputError, match=words):
            live_settings(path, twin.arl0)
        live_settings(path, None)


def test_every_mistake_is_told_with_its_place(tmp_path: Path) -> None:
    text = SOUND.replace("rows = {", "rws = {}\nrows = {", 1).replace('"mqtt"', '"kafka"', 1)
    with pytest.raises(SeveralMistakes) as raised:
        read_configuration(written(tmp_path, text))
    assert len(raised.value.mistakes) == 2
    assert "twin 'pratt-7', rws: there is no such key" in raised.value.mistakes
    assert any(one.startswith("twin 'pratt-7', source 2: kind is") for one in raised.value.mistakes)


def test_a_wrong_entry_of_a_list_is_one_mistake(tmp_path: Path) -> None:
    begin = SOUND.index('on = ["alarm"')
    text = SOUND.replace(SOUND[begin : SOUND.index("\n", begin)], 'on = ["foo"]')
    with pytest.raises(InputError, match="notify 1, on 1: ") as raised:
        read_configuration(written(tmp_path, text))
    assert not isinstance(raised.value, SeveralMistakes)
