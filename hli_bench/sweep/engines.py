"""Who does the runs: processes of this computer, or a Dask cluster. Each run gives the same bits with all of them."""

import gc
import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from typing import Any, Final, Protocol, cast

from hli_bench.base import garbage
from hli_bench.base.errors import EnvironmentLacks, InputError
from hli_bench.base.loading import how_to_install, module
from hli_bench.sweep.work import Failure, Job, Row, Run, code_digest, run_chunk

Chunk = list[Row | Failure]
Work = Callable[[Job, Sequence[Run]], Chunk]
"""Does a chunk; a function that another process can import."""
_Pipe = Connection
AHEAD: Final = 2
"""Chunks that a worker has at a time: one at work, one waiting, so that it never waits itself."""
END_S: Final = 5.0
DASK: Final = "dask://"
LOCAL: Final = "local"
DASK_LOCAL: Final = "dask-local"


class Engine(Protocol):
    """Does chunks of runs and yields what they came to, in any order."""

    def chunks(self, job: Job, chunks: Iterator[Sequence[Run]]) -> Iterator[Chunk]:
        """Do all chunks. `chunks` is asked for more as workers become free."""


def engine(text: str, workers: int) -> Engine:
    """Return the engine of `--engine`. Raises InputError."""
    if text == LOCAL:
        return LocalProcesses(workers)
    if text == DASK_LOCAL:
        return Dask(None, workers)
    if text.startswith(DASK) and text.removeprefix(DASK).rpartition(":")[2].isdigit():
        return Dask(text.removeprefix(DASK), workers)
    message = f"{text!r} is not valid, expected {LOCAL}, {DASK}HOST:PORT or {DASK_LOCAL}"
    raise InputError(message, file="--engine")


# -- processes of this computer ---------------------------------------------------------------------------


class LocalProcesses:
    """As many processes as asked for; each ends with its pipe, so none is left when this process is killed."""

    def __init__(self, workers: int, work: Work = run_chunk) -> None:
        self._workers = workers
        self._work = work

    def chunks(self, job: Job, chunks: Iterator[Sequence[Run]]) -> Iterator[Chunk]:
        """Do all chunks. Raises EnvironmentLacks when a process dies."""
        context = multiprocessing.get_context("spawn")
        with ExitStack() as closing:
            waiting: dict[_Pipe, int] = {}
            for _, chunk in zip(range(self._workers), chunks, strict=False):
                pipe = closing.enter_context(_Worker(context, job, self._work))
                waiting[pipe] = _hand_out(pipe, iter([chunk]))
            for pipe in waiting:
                waiting[pipe] += sum(_hand_out(pipe, chunks) for _ in range(AHEAD - 1))
            while any(waiting.values()):
                ready = wait([pipe for pipe, count in waiting.items() if count])
                for pipe in cast("list[_Pipe]", ready):
                    try:
                        done: Chunk = pipe.recv()
                    except (EOFError, ConnectionError) as error:
                        raise _died() from error
                    yield done
                    waiting[pipe] += _hand_out(pipe, chunks) - 1


class _Worker:
    """One worker process as its pipe."""

    def __init__(self, context: Any, job: Job, work: Work) -> None:
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_serve, args=(theirs, job, work), daemon=True)
        with _interrupts_held():
            self._process.start()
        theirs.close()

    def __enter__(self) -> _Pipe:
        pipe: _Pipe = self._pipe
        return pipe

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self._pipe.close()
        if kind is not None:
            self._process.kill()
        self._process.join(END_S)
        if self._process.exitcode is None:
            self._process.kill()
            self._process.join()


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Hold Ctrl-C back; a process that is started here never gets it, from its first instruction on."""
    # It is started with the first process and would end the holding.
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    came: list[int] = []
    # The mask is this thread's: the signal may go to another one, and its handler runs here all the same.
    handler = None
    with suppress(ValueError):  # outside the main thread no handler runs, and none can be set
        handler = signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
    finally:
        if handler is not None:
            signal.signal(signal.SIGINT, handler)
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    if came:
        signal.raise_signal(signal.SIGINT)


def _hand_out(pipe: _Pipe, chunks: Iterator[Sequence[Run]]) -> int:
    """Give the next chunk to a worker; return how many it got. Raises EnvironmentLacks when it has died."""
    chunk = next(chunks, None)
    if chunk is None:
        return 0
    try:
        pipe.send(chunk)
    except ConnectionError as error:
        raise _died() from error
    return 1


def _died() -> EnvironmentLacks:
    return EnvironmentLacks("a worker process has died (out of memory?); the same command goes on from here")


def _serve(pipe: _Pipe, job: Job, work: Work) -> None:
    """Do chunks until the pipe ends. Ctrl-C is left to the process at the other end."""
    gc.collect()
    gc.freeze()
    garbage.seldom()
    while True:
        try:
            runs = pipe.recv()
            pipe.send(work(job, runs))
        except (EOFError, ConnectionError):
            return


# -- Dask -------------------------------------------------------------------------------------------------


class Dask:
    """A Dask cluster: the one at `address`, or `workers` processes of this computer."""

    def __init__(self, address: str | None, workers: int, work: Work = run_chunk) -> None:
        """Raises EnvironmentLacks where Dask is not installed."""
        self._address = address
        self._workers = workers
        self._work = work
        try:
            self._dask: Any = module("distributed")
        except InputError as error:
            raise EnvironmentLacks(f"this engine needs Dask: {how_to_install('distributed')}") from error

    def chunks(self, job: Job, chunks: Iterator[Sequence[Run]]) -> Iterator[Chunk]:
        """Do all chunks. Raises EnvironmentLacks when there is no such cluster or its workers do not fit."""
        dask = self._dask
        with ExitStack() as closing:
            target: Any = self._address
            if target is None:
                target = closing.enter_context(
                    dask.LocalCluster(n_workers=self._workers, threads_per_worker=1, dashboard_address=":0")
                )
            try:
                client = closing.enter_context(dask.Client(target, timeout=END_S))
            except (OSError, TimeoutError) as error:
                raise EnvironmentLacks(f"no Dask scheduler at {self._address}") from error
            threads = client.nthreads()
            _check(client, threads)
            shared = client.scatter(job, broadcast=True)
            first = [
                client.submit(self._work, shared, chunk, pure=False)
                for chunk in _take(chunks, AHEAD * len(threads))
            ]
            running = dask.as_completed(first)
            for future in running:
                done: Chunk = future.result()
                future.release()
                for chunk in _take(chunks, 1):
                    running.add(client.submit(self._work, shared, chunk, pure=False))
                yield done


def _take(chunks: Iterator[Sequence[Run]], count: int) -> list[Sequence[Run]]:
    """Return the next chunks."""
    return [chunk for _ in range(count) if (chunk := next(chunks, None)) is not None]


def _check(client: Any, threads: dict[str, int]) -> None:
    """Raise EnvironmentLacks unless the workers can give the same results as this process."""
    if not threads:
        raise EnvironmentLacks("the Dask cluster has no workers")
    if any(count != 1 for count in threads.values()):
        raise EnvironmentLacks("a bench needs a process of its own: start `dask worker` with --nthreads 1")
    try:
        digests = set(client.run(code_digest).values())
    except ModuleNotFoundError as error:
        raise EnvironmentLacks("hli-bench is not installed where the Dask workers run") from error
    if digests != {code_digest()}:
        raise EnvironmentLacks("the Dask workers run another version of hli-bench than this process")
