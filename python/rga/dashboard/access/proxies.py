"""What a proxy in front of a service says of those who call, where it is trusted."""

from collections.abc import Collection
from dataclasses import dataclass
from ipaddress import ip_address

from starlette.requests import HTTPConnection

#: headers by which a proxy says for whom it calls
_FORWARDED = ("forwarded", "x-forwarded-for", "x-forwarded-host", "x-forwarded-proto")


@dataclass(frozen=True)
class CallOrigin:
    """Where a call comes from.

    Attributes:
        address: of whoever calls.
        secure: whether it came by TLS.
        user: whom a trusted proxy has let in; None: nobody.
        forwarded: whether a proxy passed it on, be it trusted or not.
    """

    address: str
    secure: bool
    user: str | None
    forwarded: bool


def origin_of(
    call: HTTPConnection, trusted: Collection[str], user_header: str | None
) -> CallOrigin:
    """Where a call comes from.

    Args:
        call: of somebody, or of a proxy for somebody.
        trusted: addresses of proxies whose headers are believed.
        user_header: by which they say whom they have let in; None: they do not.
    """
    address, secure = call.client.host if call.client else "", call.url.scheme == "https"
    forwarded = any(name in call.headers for name in _FORWARDED)
    if address not in trusted:
        return CallOrigin(address, secure, None, forwarded)
    # Each proxy appends whom it was called by; what stands before the last that is trusted is
    # what anybody may have written.
    passed = ",".join(call.headers.getlist("x-forwarded-for"))
    chain = [one.strip() for one in passed.split(",")]
    others = [one for one in chain if _is_address(one) and one not in trusted]
    return CallOrigin(
        address=others[-1] if others else address,
        secure=secure or call.headers.get("x-forwarded-proto", "").strip() == "https",
        user=call.headers.get(user_header) if user_header else None,
        forwarded=forwarded,
    )


def is_loopback(host: str) -> bool:
    """Whether only programs of this machine reach a host.

    >>> is_loopback("127.0.0.1"), is_loopback("localhost"), is_loopback("0.0.0.0")
    (True, True, False)
    """
    bare = host.strip("[]")
    return bare == "localhost" or (_is_address(bare) and ip_address(bare).is_loopback)


def _is_address(text: str) -> bool:
    try:
        ip_address(text)
    except ValueError:
        return False
    return True
