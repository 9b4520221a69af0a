"""Messages between the processes of a bench."""

import socket
import struct
from typing import Final

from hli_bench.base.errors import EnvironmentLacks

_LENGTH: Final = struct.Struct("<I")
_TIMEVAL: Final = struct.Struct("@ll")
_FIRST: Final = 1 << 12
"""Bytes asked for at first: more than the messages of a cycle have."""
_MOST: Final = 1 << 20


class Gone(EnvironmentLacks):
    """The process at the other end of a pipe has closed it."""

    def __init__(self) -> None:
        super().__init__("a process of the bench has gone")


def framed(message: bytes) -> bytes:
    """Return a message as it passes a pipe."""
    return _LENGTH.pack(len(message)) + message


class Pipe:
    """Messages with a length in front, over one end of a socket pair. It waits for ever unless `limit` was called.

    The operating system keeps the limit: Python would ask before each call whether it is going to wait.
    """

    __slots__ = ("_end", "_receive", "_rest", "_send")

    def __init__(self, end: socket.socket) -> None:
        self._end = end
        self._receive, self._send = end.recv, end.sendall
        self._rest = b""

    def send(self, message: bytes) -> None:
        """Send one message. Raises Gone when the other side has, TimeoutError when it is stuck."""
        try:
            self._send(framed(message))
        except BlockingIOError as error:
            raise TimeoutError from error
        except OSError as error:
            raise Gone from error

    def send_part(self, part: memoryview) -> int:
        """Send some of what `framed` gave, return how many bytes; 0 when the limit is 0 and nothing goes.

        Raises Gone when the other side has, TimeoutError when it is stuck.
        """
        try:
            return self._end.send(part)
        except BlockingIOError as error:
            if self._end.getblocking():
                raise TimeoutError from error
            return 0
        except OSError as error:
            raise Gone from error

    def limit(self, seconds: float) -> None:
        """Wait at most so long from now on, 0: not at all.

        What cannot be sent in time ends the use of the pipe; who waited too long for a message may wait for it again.
        """
        self._end.setblocking(seconds > 0.0)
        limit = _TIMEVAL.pack(int(seconds), int(seconds % 1.0 * 1e6))
        for direction in (socket.SO_RCVTIMEO, socket.SO_SNDTIMEO):
            self._end.setsockopt(socket.SOL_SOCKET, direction, limit)

    def receive(self) -> bytes:
        """Wait for one message. Raises EOFError when the other side has gone, TimeoutError when it is stuck.

        What came of a message before a TimeoutError is kept: it may be called again.
        """
        data = self._rest or self._some()
        self._rest = data
        while len(data) < _LENGTH.size:
            data = self._rest = data + self._some()
        end = _LENGTH.size + _LENGTH.unpack_from(data)[0]
        if len(data) < end:
            data = self._up_to(end, data)
        self._rest = data[end:]
        return data[_LENGTH.size : end]

    def _up_to(self, end: int, data: bytes) -> bytes:
        """Return `data` and what comes, at least `end` bytes."""
        parts, size = [data], len(data)
        try:
            while size < end:
                parts.append(self._some(min(end - size, _MOST)))
                size += len(parts[-1])
        finally:
            data = self._rest = b"".join(parts)
        return data

    def _some(self, size: int = _FIRST) -> bytes:
        try:
            data = self._receive(size)
        except BlockingIOError as error:
            raise TimeoutError from error
        except ConnectionError as error:
            raise EOFError from error
        if not data:
            raise EOFError
        return data

    def close(self) -> None:
        """Close this end."""
        self._end.close()
