"""Queries that only read: answered from the last values, a few replies at a time."""

from collections import deque
from collections.abc import Callable
from typing import Any, Final

import zenoh

from hli_bench.base.errors import InputError
from hli_bench.protocols.hli.access import Refusal
from hli_bench.shells.zenoh_inbox import Budget
from hli_bench.shells.zenoh_requests import Request
from hli_bench.shells.zenoh_session import JSON, PACKED, TEXT
from hli_bench.shells.zenoh_values import Answers, LastValues

OPEN: Final = 100
"""So many queries are open at a time; those beyond are refused."""


class Questions:
    """Queries that wait for their replies."""

    def __init__(
        self, machine: str, values: LastValues, budget_ns: int, report: Callable[[list[Refusal]], None]
    ) -> None:
        self._machine = machine
        self._values = values
        self._budget_ns = budget_ns
        self._report = report
        self._open: deque[tuple[Any, Answers]] = deque()

    @property
    def waiting(self) -> bool:
        """Whether there is something to answer."""
        return bool(self._open)

    def reader(self, answers: Callable[[], Answers]) -> Callable[[zenoh.Query], None]:
        """Return what takes a query of which all is known."""
        return lambda query: self._add(query, answers())

    def on_unit(self, query: zenoh.Query) -> None:
        """Take a query for units or members."""
        path, as_text = str(query.key_expr).removeprefix(f"{self._machine}/"), _wants_text(query)
        if "*" in path:
            self._add(query, self._values.units(self._wanted(query), as_text=as_text))
            return
        try:
            name = self._values.layout.resolve(path.removeprefix("hli/unit/"))
        except InputError as error:
            Request(key=f"{self._machine}/{path}", report=self._report, query=query).refuse(error.message)
            return
        self._add(query, iter([(path, self._values.unit(name, as_text=as_text))]))

    def on_io(self, query: zenoh.Query) -> None:
        """Take a query for images of terminals or entries of them."""
        self._add(query, self._values.terminal_images(self._wanted(query), as_text=_wants_text(query)))

    def answer(self) -> None:
        """Send replies while the budget of a look lasts."""
        budget = Budget(self._budget_ns)
        while self._open:
            query, answers = self._open[0]
            for path, value in answers:
                encoding = JSON if isinstance(value, str) else PACKED
                query.reply(f"{self._machine}/{path}", value, encoding=encoding)
                if not budget.left:
                    return
            self._open.popleft()
            query.drop()

    def _add(self, query: zenoh.Query, answers: Answers) -> None:
        if len(self._open) < OPEN:
            self._open.append((query, answers))
            return
        with query:
            query.reply_err(f"{OPEN} queries wait already: ask again", encoding=TEXT)

    def _wanted(self, query: zenoh.Query) -> Callable[[str], bool]:
        key = query.key_expr
        return lambda path: bool(key.intersects(f"{self._machine}/{path}"))


def _wants_text(query: zenoh.Query) -> bool:
    return query.parameters.get("format") in ("text", "json")
