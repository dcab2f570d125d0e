"""Bodies of calls: no more bytes, and no longer, than is allowed, before anything reads them."""

import asyncio

from fastapi import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rga.operation.packets.packet import MOST_BYTES

#: bytes of what is no packet
MOST_OF_OTHERS = 256 * 1024
#: how long a body may take [s]
LONGEST = 60.0


class BoundedBody:
    """Breaks off calls whose body is too large, or does not end.

    Args:
        app: that is called.
        longest: how long a body may take [s].
    """

    def __init__(self, app: ASGIApp, longest: float = LONGEST) -> None:
        self._app, self._longest = app, longest

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a call on, with a body that is bounded."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        most = MOST_BYTES if scope["path"].endswith("/packets") else MOST_OF_OTHERS
        end = asyncio.get_running_loop().time() + self._longest
        size, complete = 0, False

        async def bounded() -> Message:
            nonlocal size, complete
            if complete:
                # Nothing comes any more but the end of the call.
                return await receive()
            try:
                async with asyncio.timeout_at(end):
                    message = await receive()
            except TimeoutError:
                raise HTTPException(408, f"the body took more than {self._longest:g} s") from None
            size += len(message.get("body", b""))
            complete = not message.get("more_body", False)
            if size > most:
                raise HTTPException(413, f"at most {most} bytes are taken in at once")
            return message

        await self._app(scope, bounded, send)
