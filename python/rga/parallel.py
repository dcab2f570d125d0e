"""Tasks in several processes: of this machine, or of a Dask cluster."""

import os
import re
import signal
import sys
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from contextlib import AbstractContextManager, contextmanager, suppress
from importlib.metadata import PackageNotFoundError, version
from itertools import islice
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnContext, SpawnProcess
from pathlib import Path
from threading import Lock, Thread, current_thread, main_thread
from typing import Any, TypeVar

from rga.errors import InputError

Task = TypeVar("Task")
Result = TypeVar("Result")
#: an executor, and a count of the processes that it has now
Processes = tuple[Executor, Callable[[], int]]

#: time that a Dask cluster has to answer [s]
PATIENCE = 5.0
#: of a scheduler: a scheme that Dask knows, where there is one, a host and a port
ADDRESS = r"((tcp|tls|ucx|ucxx|ws|wss)://)?[^/\s]+:\d{1,5}"
_ALONE = Lock()


def finished(
    function: Callable[[Task], Result],
    tasks: Iterable[Task],
    *,
    workers: int = 1,
    dask: str | None = None,
) -> Generator[tuple[Task, Future[Result]]]:
    """Tasks as they are finished, each with its result or error.

    A task is taken when a process is free for it, so that tasks may be made as they are needed.
    Whoever takes no more of them closes the generator, and the processes end.

    Args:
        function: of a module that the processes can import.
        tasks: can be pickled, as can be the results and errors.
        workers: processes of this machine; 1: this one.
        dask: address of the scheduler of a Dask cluster; its processes do the work instead.

    Raises:
        InputError: the cluster does not answer, cannot run rga, or is lost.
    """
    waiting = iter(tasks)
    with _processes(workers, dask) as (executor, count):
        going: dict[Future[Result], Task] = {}
        while True:
            # A cluster that has no worker left may get one again.
            for task in islice(waiting, max(count(), 1) - len(going)):
                with _signals_held_back():
                    going[executor.submit(_alone, function, task)] = task
            if not going:
                return
            for future in wait(going, return_when=FIRST_COMPLETED).done:
                if future.cancelled():
                    raise CancelledError
                yield going.pop(future), future


def _alone(function: Callable[[Task], Result], task: Task) -> Result:
    """One task at a time in a process: limits of numerical threads hold for all of its threads."""
    with _ALONE:
        return function(task)


def _processes(workers: int, dask: str | None) -> AbstractContextManager[Processes]:
    if dask is not None:
        return _cluster(dask)
    return _here() if workers == 1 else _local(workers)


@contextmanager
def _here() -> Iterator[Processes]:
    with _Here() as executor:
        yield executor, lambda: 1


@contextmanager
def _local(workers: int) -> Iterator[Processes]:
    if sys.platform != "win32":
        _begin_tracker()
    context = _Spawning()
    end, held = context.Pipe(duplex=False)
    with end, held:
        pool = ProcessPoolExecutor(workers, context, _end_with, (end,))
        try:
            yield pool, lambda: workers
        except BaseException:
            # Nobody waits for what they have begun, nor for one that was killed as it answered.
            pool.shutdown(wait=False, cancel_futures=True)
            context.terminate()
            raise
        pool.shutdown()


class _Spawning(SpawnContext):
    """Begins processes, and can end all that it has begun, those that are beginning as well."""

    def __init__(self) -> None:
        super().__init__()
        self._begun: list[SpawnProcess] = []

    def Process(self, *given: Any, **named: Any) -> SpawnProcess:  # type: ignore[override]
        """A process that is not begun yet."""
        process = SpawnProcess(*given, **named)
        self._begun.append(process)
        return process

    def terminate(self) -> None:
        """End them."""
        for process in self._begun:
            if process.pid is not None:
                process.terminate()


@contextmanager
def _signals_held_back() -> Iterator[None]:
    """Ctrl-C and SIGTERM come after the block: a process whose parent stops as it begins would say.

    Ctrl-C never comes to processes that begin within it: a terminal sends it to all of them.
    """
    if current_thread() is not main_thread() or not hasattr(signal, "pthread_sigmask"):
        yield
        return
    came: list[int] = []
    handler = signal.signal(signal.SIGTERM, lambda number, _frame: came.append(number))
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, handler)
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        if came:
            signal.raise_signal(signal.SIGTERM)


def _begin_tracker() -> None:
    """Begin the process that takes away what killed ones leave, with nobody to tell of it."""
    sys.stderr.flush()
    kept = os.dup(2)
    with Path(os.devnull).open("wb") as nowhere:
        os.dup2(nowhere.fileno(), 2)
        try:
            resource_tracker.ensure_running()
        finally:
            os.dup2(kept, 2)
            os.close(kept)


@contextmanager
def _cluster(address: str) -> Iterator[Processes]:
    try:
        from distributed import Client
    except ImportError:
        raise InputError(
            "Dask's package distributed is not installed", "--dask", "pip install 'rga[dask]'"
        ) from None
    where = f"Dask cluster {address!r}"
    try:
        if not re.fullmatch(ADDRESS, address):
            raise ValueError("that is no address with a port")
        client = _within(
            2 * PATIENCE, lambda: Client(address, timeout=PATIENCE, set_as_default=False)
        )
    except (OSError, ValueError) as error:
        raise InputError(
            f"no Dask scheduler answers: {error}",
            where,
            "give the address that `dask scheduler` shows, such as tcp://host:8786",
        ) from None
    with client:
        _check(client, where)
        try:
            yield client.get_executor(pure=False), lambda: len(client.nthreads())
        except (OSError, CancelledError):
            raise InputError(
                "the cluster was lost", where, "see to its scheduler, and begin again"
            ) from None


def _within(seconds: float, connect: Callable[[], Any]) -> Any:
    """A connection; TimeoutError where a port takes one and never answers."""
    made: Future[Any] = Future()

    def run() -> None:
        try:
            made.set_result(connect())
        except Exception as error:
            made.set_exception(error)

    Thread(target=run, daemon=True).start()
    try:
        return made.result(seconds)
    except TimeoutError:
        raise TimeoutError(f"nothing comes back in {seconds:g} s") from None


def _check(client: Any, where: str) -> None:
    """Refuse a cluster without workers, or whose workers have another rga or none."""
    needed = version("rga")
    remedy = f"install rga {needed} where the workers run"
    try:
        present = client.run(version, "rga")
    except PackageNotFoundError:
        raise InputError("a worker does not have rga", where, remedy) from None
    if not present:
        raise InputError("it has no worker", where, "start one with `dask worker ADDRESS`")
    for worker, found in present.items():
        if found != needed:
            raise InputError(f"the worker {worker} has rga {found}", where, remedy)


class _Here(Executor):
    """Does every task at once, in this process."""

    def submit(self, function: Callable[..., Any], /, *given: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        try:
            future.set_result(function(*given, **named))
        except Exception as error:
            future.set_exception(error)
        return future


def _end_with(end: Connection) -> None:
    """A worker whose parent has stopped ends by itself: nobody will take what it makes.

    Args:
        end: of a pipe that the parent holds as long as it wants results.
    """

    def watch() -> None:
        with suppress(EOFError, OSError):
            end.recv()
        os._exit(1)

    Thread(target=watch, daemon=True).start()
