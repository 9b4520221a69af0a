"""A CAN interface of this computer, through python-can."""

import logging
import time
from typing import Any, Final, Self

import can

from hli_bench.base.errors import EnvironmentLacks
from hli_bench.wire.can import CanFrame

# python-can logs what it raises as well; for this program the exception is enough.
logging.getLogger("can").addHandler(logging.NullHandler())

ANSWER_S: Final = 2.0
"""Longest wait for a frame that must come."""


class CanBus:
    """One node's access to a SocketCAN interface; own frames are not received."""

    def __init__(self, interface: str) -> None:
        """Open `interface`. Raises EnvironmentLacks when this computer has none of that name."""
        try:
            self._bus: Any = can.Bus(interface="socketcan", channel=interface)
        except (OSError, can.CanError) as error:
            raise EnvironmentLacks(
                f"no CAN interface {interface} ({error}); `hli-bench doctor` says what this computer offers"
            ) from error
        self._interface = interface

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def send(self, frame: CanFrame) -> None:
        """Put one frame on the bus; wait while the interface's queue is full. Raises EnvironmentLacks."""
        message = can.Message(
            arbitration_id=frame.cob_id,
            data=frame.data,
            is_extended_id=False,
            is_remote_frame=frame.remote,
        )
        try:
            self._bus.send(message, timeout=ANSWER_S)
        except (OSError, can.CanError) as error:
            raise self._failure(error) from error

    def receive(self, timeout_s: float = ANSWER_S) -> CanFrame | None:
        """Return the next 11-bit frame, None when none comes in time. Raises EnvironmentLacks."""
        deadline = time.monotonic() + timeout_s
        while (rest := deadline - time.monotonic()) > 0:
            message = self._next(rest)
            if message is not None and not message.is_extended_id and not message.is_error_frame:
                return _frame(message)
        return None

    def receive_now(self) -> CanFrame | None:
        """Return the next 11-bit frame that is there already."""
        while (message := self._next(0.0)) is not None:
            if not message.is_extended_id and not message.is_error_frame:
                return _frame(message)
        return None

    def clear(self) -> None:
        """Forget the frames that wait."""
        while self._next(0.0) is not None:
            pass

    def _next(self, timeout_s: float) -> Any:
        try:
            return self._bus.recv(timeout_s)
        except (OSError, can.CanError) as error:
            raise self._failure(error) from error

    def _failure(self, error: Exception) -> EnvironmentLacks:
        return EnvironmentLacks(f"CAN interface {self._interface}: {error}")

    def close(self) -> None:
        """Leave the bus."""
        self._bus.shutdown()


def _frame(message: Any) -> CanFrame:
    return CanFrame(message.arbitration_id, bytes(message.data), message.is_remote_frame)
