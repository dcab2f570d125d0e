"""The server of the HTTP door, within bounds that nobody outside can pass."""

import uvicorn
from starlette.types import ASGIApp

from rga.errors import InputError
from rga.operation.configuration import ServiceSettings

#: calls and streams at once; more are answered by 503
MOST_CALLS = 500
#: how long a connection may be idle, and the service waits for open ones as it ends [s]
IDLE, ENDING = 30, 3
#: bytes of a line of a request with its headers
MOST_HEADERS = 32 * 1024


def server_of(app: ASGIApp, settings: ServiceSettings) -> uvicorn.Server:
    """The server of an application.

    Args:
        app: that answers.
        settings: where it listens, and by which certificate.

    Raises:
        InputError: a file of TLS cannot be used.
    """
    host, _, port = settings.listen.rpartition(":")
    config = uvicorn.Config(
        app,
        host=host.strip("[]"),
        port=int(port),
        ssl_certfile=settings.certificate,
        ssl_keyfile=settings.key,
        # Which proxy is believed is decided where the caller is asked for.
        proxy_headers=False,
        server_header=False,
        log_level="warning",
        http="h11",
        ws="none",
        h11_max_incomplete_event_size=MOST_HEADERS,
        limit_concurrency=MOST_CALLS,
        timeout_keep_alive=IDLE,
        timeout_graceful_shutdown=ENDING,
    )
    try:
        config.load()
    except OSError as error:
        where = f"[service] certificate = {str(settings.certificate)!r}"
        words = (error.strerror or str(error)).lower()
        raise InputError(f"TLS cannot begin: {words}", where, "give PEM files") from None
    return uvicorn.Server(config)
