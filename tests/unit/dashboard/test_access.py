"""Who may come in: passwords, sessions, tokens, origins, proxies."""

import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import pytest
from argon2 import PasswordHasher
from fastapi import Depends, FastAPI
from starlette.testclient import TestClient

from rga.dashboard.access import passwords, users
from rga.dashboard.access.access import COOKIE, Access
from rga.dashboard.access.failures import OF_A_NAME, OF_AN_ADDRESS, Failures
from rga.dashboard.access.guard import Guard
from rga.dashboard.access.login import router, to_login
from rga.dashboard.access.may import NotLoggedIn, may
from rga.dashboard.access.roles import Who
from rga.dashboard.access.sessions import IDLE
from rga.errors import InputError
from rga.operation.configuration import ServiceSettings

HERE, PASSWORD = "http://127.0.0.1:8471", "four words of mine"
OWN = {"Origin": HERE}


class HandClock:
    """A clock that a test moves."""

    def __init__(self) -> None:
        self.now = 1_795_392_000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Hashes that cost little."""
    hasher = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
    monkeypatch.setattr(passwords, "_HASHER", hasher)
    monkeypatch.setattr(users, "nobodys", lambda: hasher.hash("of nobody"))


@pytest.fixture
def clock() -> HandClock:
    return HandClock()


@pytest.fixture
def access(tmp_path: Path, clock: HandClock) -> Iterator[Access]:
    found = Access(ServiceSettings(data=tmp_path), clock)
    yield found
    found.close()


def client_of(access: Access, host: str = HERE, caller: str = "127.0.0.1") -> TestClient:
    """A browser before an application of one path for each right."""
    app = FastAPI()
    app.state.access = access
    app.add_middleware(Guard, access=access)
    app.add_exception_handler(NotLoggedIn, to_login)
    app.include_router(router)

    @app.get("/look/{twin}")
    def look(twin: str, who: Annotated[Who, Depends(may("viewer"))]) -> str:
        return who.name

    @app.post("/operate/{twin}")
    def operate(twin: str, who: Annotated[Who, Depends(may("operator"))]) -> str:
        return who.name

    @app.post("/send/{twin}")
    def send(twin: str, who: Annotated[Who, Depends(may("ingest"))]) -> str:
        return who.name

    return TestClient(app, base_url=host, client=(caller, 50000), follow_redirects=False)


def log_in(client: TestClient, name: str = "Ada", password: str = PASSWORD) -> Any:
    return client.post("/login", data={"name": name, "password": password}, headers=OWN)


def test_without_users_the_local_person_rules(
    access: Access, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga.dashboard.access.access.getuser", lambda: "ada")
    answer = client_of(access).post("/operate/east")
    assert (answer.status_code, answer.json()) == (200, "ada")


@pytest.mark.parametrize(
    ("host", "headers"),
    [
        ("http://elsewhere.example", {}),
        (HERE, {"X-Forwarded-For": "192.0.2.1"}),
        (HERE, {"Forwarded": "for=192.0.2.1"}),
    ],
)
def test_others_are_no_local_person(access: Access, host: str, headers: dict[str, str]) -> None:
    assert client_of(access, host).get("/look/east", headers=headers).status_code == 401


def test_from_the_first_user_on_everybody_logs_in(access: Access) -> None:
    client = client_of(access)
    access.users.add("Ada", "operator", PASSWORD)
    assert client.post("/operate/east", headers=OWN).status_code == 401
    assert log_in(client, password="not this one").status_code == 401
    answer = log_in(client)
    assert (answer.status_code, answer.headers["location"]) == (303, "/")
    told = answer.headers["set-cookie"]
    assert "HttpOnly" in told
    assert "SameSite=strict" in told
    assert "Secure" not in told
    assert client.post("/operate/east", headers=OWN).json() == "Ada"
    assert client.get("/look/east").json() == "Ada"
    assert client.post("/logout", headers=OWN).status_code == 303
    assert client.get("/look/east").status_code == 401
    assert [one.outcome for one in access.logins.latest()] == ["out", "in", "refused"]


def test_a_token_of_another_twin_is_told_its_own(access: Access) -> None:
    secret = access.tokens.make("reader", "read", "west")
    answer = client_of(access).get("/look/east", headers={"Authorization": f"Bearer {secret}"})
    assert answer.status_code == 403
    assert "is for twin west" in answer.text


def test_a_viewer_looks_and_does_not_operate(access: Access) -> None:
    access.users.add("Eve", "viewer", PASSWORD)
    client = client_of(access)
    log_in(client, "Eve")
    assert client.get("/look/east").status_code == 200
    assert client.post("/operate/east", headers=OWN).status_code == 403
    assert client.post("/send/east", headers=OWN).status_code == 403


def test_an_idle_session_ends_and_one_in_use_does_not(access: Access, clock: HandClock) -> None:
    access.users.add("Ada", "operator", PASSWORD)
    client = client_of(access)
    log_in(client)
    for _ in range(3):
        clock.now += IDLE - 1
        assert client.get("/look/east").status_code == 200
    clock.now += IDLE + 1
    assert client.get("/look/east").status_code == 401


@pytest.mark.parametrize("ends", ["removed", "another password"])
def test_sessions_end_with_their_user(access: Access, ends: str) -> None:
    access.users.add("Ada", "operator", PASSWORD)
    access.users.add("Eve", "viewer", PASSWORD)
    ada, eve = client_of(access), client_of(access)
    log_in(ada)
    log_in(eve, "Eve")
    if ends == "removed":
        access.users.remove("Ada")
    else:
        access.users.change_password("Ada", "another four words")
    assert ada.get("/look/east").status_code == 401
    assert eve.get("/look/east").status_code == 200


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        (OWN, 200),
        ({}, 403),
        ({"Origin": "null"}, 403),
        ({"Origin": "http://elsewhere.example"}, 403),
        ({"Origin": "http://127.0.0.1:80"}, 403),
        ({"Origin": "https://127.0.0.1:8471"}, 403),
        ({"Origin": f"{HERE}.elsewhere.example"}, 403),
        (OWN | {"Sec-Fetch-Site": "cross-site"}, 403),
        (OWN | {"Sec-Fetch-Site": "same-origin"}, 200),
    ],
)
def test_another_page_changes_nothing(access: Access, headers: dict[str, str], status: int) -> None:
    access.users.add("Ada", "operator", PASSWORD)
    client = client_of(access)
    log_in(client)
    assert client.post("/operate/east", headers=headers).status_code == status


def test_another_page_cannot_use_the_local_person(access: Access) -> None:
    client = client_of(access)
    wrong = {"Origin": "http://elsewhere.example"}
    assert client.post("/operate/east", headers=wrong).status_code == 403
    assert client.post("/operate/east", headers=OWN).status_code == 200


@pytest.mark.parametrize(
    ("purpose", "twin", "allowed"),
    [
        ("ingest", "east", {"send"}),
        ("read", "east", {"look"}),
        ("operate", "east", {"look", "operate"}),
        ("operate", "west", set()),
    ],
)
def test_a_token_is_for_one_twin_and_purpose(
    access: Access, purpose: Any, twin: str, allowed: set[str]
) -> None:
    access.users.add("Ada", "admin", PASSWORD)
    client = client_of(access)
    token = {"Authorization": f"Bearer {access.tokens.make('logger', purpose, twin)}"}
    found = {
        "look": client.get("/look/east", headers=token),
        "operate": client.post("/operate/east", headers=token),
        "send": client.post("/send/east", headers=token),
    }
    for name, answer in found.items():
        assert answer.status_code == (200 if name in allowed else 403)
    access.tokens.remove("logger")
    assert client.get("/look/east", headers=token).status_code == 401


def test_a_wrong_token_is_not_passed_over(access: Access) -> None:
    wrong = {"Authorization": "Bearer of nothing"}
    assert client_of(access).get("/look/east", headers=wrong).status_code == 401
    assert client_of(access).get("/look/east").status_code == 200


def test_who_guesses_waits_and_the_right_password_comes_in_after(
    access: Access, clock: HandClock
) -> None:
    access.users.add("Ada", "operator", PASSWORD)
    client = client_of(access)
    for _ in range(OF_A_NAME):
        assert log_in(client, password="not this one").status_code == 401
    waits = []
    for _ in range(3):
        answer = log_in(client)
        assert answer.status_code == 429
        waits.append(int(answer.headers["Retry-After"]))
        clock.now += waits[-1]
        assert log_in(client, password="not this one").status_code == 401
    assert waits == [1, 2, 4]
    clock.now += 8
    assert log_in(client).status_code == 303
    assert log_in(client).status_code == 303


def test_many_names_from_one_address_wait_and_another_address_does_not(access: Access) -> None:
    failures = Failures(access._file, HandClock())
    waits = [failures.begin(f"name {k}", "192.0.2.1") for k in range(OF_AN_ADDRESS + 1)]
    assert waits == [0.0] * OF_AN_ADDRESS + [1.0]
    assert failures.begin("another", "192.0.2.2") == 0.0


def test_secrets_are_kept_as_hashes(access: Access, tmp_path: Path) -> None:
    access.users.add("Ada", "operator", PASSWORD)
    client = client_of(access)
    log_in(client, name=PASSWORD)
    log_in(client)
    token = access.tokens.make("logger", "ingest", "east")
    cookie = client.cookies[COOKIE]
    access.close()
    with sqlite3.connect(tmp_path / "service.sqlite") as connection:
        kept = "\n".join(connection.iterdump())
    assert "$argon2id$" in kept
    assert "logger" in kept
    # The name that failed stands among failures, hashed; a password may have been typed there.
    for secret in (PASSWORD, token, cookie):
        assert secret not in kept


def test_every_answer_keeps_other_pages_out(access: Access) -> None:
    answer = client_of(access).get("/login")
    policy = answer.headers["Content-Security-Policy"]
    assert "default-src 'self'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "script" not in policy
    assert answer.headers["X-Content-Type-Options"] == "nosniff"
    assert "<script" not in answer.text


@pytest.mark.parametrize("given", ["//elsewhere.example", '"><script>alert(1)</script>', "/\\x"])
def test_the_login_leads_nowhere_else(access: Access, given: str) -> None:
    access.users.add("Ada", "operator", PASSWORD)
    client = client_of(access)
    assert "<script" not in client.get("/login", params={"next": given}).text
    form = {"name": "Ada", "password": PASSWORD, "next": given}
    assert client.post("/login", data=form, headers=OWN).headers["location"] == "/"
    form["next"] = "/twins/east"
    assert client.post("/login", data=form, headers=OWN).headers["location"] == "/twins/east"


def test_a_browser_is_led_to_the_login_and_a_program_is_told(access: Access) -> None:
    access.users.add("Ada", "operator", PASSWORD)
    client = client_of(access)
    answer = client.get("/look/east", headers={"Accept": "text/html"})
    assert (answer.status_code, answer.headers["location"]) == (303, "/login?next=/look/east")
    assert client.get("/look/east").status_code == 401


@pytest.mark.parametrize(
    "settings",
    [
        {"listen": "0.0.0.0:8471"},
        {"trusted_proxies": ["127.0.0.1"]},
        {"listen": "0.0.0.0:8471", "trusted_proxies": ["127.0.0.1"]},
    ],
)
def test_a_service_beyond_this_machine_needs_users(
    tmp_path: Path, settings: dict[str, Any]
) -> None:
    chosen = ServiceSettings(data=tmp_path, **settings)
    with pytest.raises(InputError, match="there are no users"):
        Access(chosen)
    Access(ServiceSettings(data=tmp_path)).users.add("Ada", "admin", PASSWORD)
    if "trusted_proxies" in settings:
        Access(chosen).close()
    else:
        with pytest.raises(InputError, match="plain text"):
            Access(chosen)


def behind_a_proxy(tmp_path: Path) -> Access:
    Access(ServiceSettings(data=tmp_path)).users.add("Ada", "operator", PASSWORD)
    return Access(
        ServiceSettings(data=tmp_path, trusted_proxies=["127.0.0.1"], user_header="X-Remote-User")
    )


@pytest.mark.parametrize(("caller", "status"), [("127.0.0.1", 200), ("192.0.2.9", 401)])
def test_a_trusted_proxy_alone_says_who_calls(tmp_path: Path, caller: str, status: int) -> None:
    client = client_of(behind_a_proxy(tmp_path), caller=caller)
    assert client.get("/look/east", headers={"X-Remote-User": "Ada"}).status_code == status
    assert client.get("/look/east", headers={"X-Remote-User": "Eve"}).status_code == 401


def test_no_header_is_believed_by_default(access: Access) -> None:
    access.users.add("Ada", "operator", PASSWORD)
    headers = {"X-Remote-User": "Ada", "X-Forwarded-User": "Ada"}
    assert client_of(access).get("/look/east", headers=headers).status_code == 401


def test_behind_a_proxy_with_tls_the_cookie_is_secure(tmp_path: Path) -> None:
    access = behind_a_proxy(tmp_path)
    client = client_of(access, "http://twins.example")
    passed = {
        "X-Forwarded-Proto": "https",
        "X-Forwarded-For": "203.0.113.5, 192.0.2.7",
        "Origin": "https://twins.example",
    }
    form = {"name": "Ada", "password": PASSWORD}
    answer = client.post("/login", data=form, headers=passed)
    assert "Secure" in answer.headers["set-cookie"]
    assert "Strict-Transport-Security" in answer.headers
    # The first address is what anybody could have written.
    assert access.logins.latest()[0].address == "192.0.2.7"


@pytest.mark.parametrize("password", ["short", "x" * 2000, "AdaLovelace"])
def test_a_poor_password_is_refused(access: Access, password: str) -> None:
    with pytest.raises(InputError):
        access.users.add("adalovelace", "admin", password)
    assert not access.users.exist
    access.users.add("adalovelace", "admin", PASSWORD)


@pytest.mark.parametrize("name", ["", " Ada", "A\nda", "x" * 65, "\x1b[2J"])
def test_a_name_that_is_none_is_refused(access: Access, name: str) -> None:
    with pytest.raises(InputError, match="no name"):
        access.users.add(name, "admin", PASSWORD)
    access.users.add("<script>", "admin", PASSWORD)
