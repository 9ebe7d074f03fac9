"""Studies on a Dask cluster: work goes out in batches, rows come back into the same store."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, Self, TypeAlias, TypeVar

from stickslip import _core
from stickslip.analyses.pattern_store import Row
from stickslip.analyses.run import Run, refusals
from stickslip.checks import brief
from stickslip.disk.bladed_disk import BladedDisk
from stickslip.disk.mistuned import tuned_disk
from stickslip.errors import ModelError
from stickslip.results.fields import Float
from stickslip.settings.peaks import MistuningSettings

if TYPE_CHECKING:
    import distributed  # type: ignore[import-not-found, unused-ignore]

Client: TypeAlias = "distributed.Client"
"""Of the package that the extra "dask" installs."""

_BATCHES = 16
"""Batches per thread of the cluster: enough to share the work evenly, and to lose little."""
_LARGEST = 256
"""Most disks or samples of a batch."""


class Work(Protocol):
    """What is computed, in batches."""

    @property
    def numbers(self) -> list[int]: ...  # noqa: D102

    def part(self, place: slice) -> Self: ...  # noqa: D102


Kind = TypeVar("Kind", bound=Work)


class Batch(NamedTuple):
    """Disks that one task computes."""

    disks: tuple[BladedDisk, ...]
    settings: MistuningSettings
    groups: list[list[int]]
    orders: list[int]
    which: list[int]
    deviations: Float
    numbers: list[int]

    def part(self, place: slice) -> Batch:
        """Return some of the disks."""
        return self._replace(
            which=self.which[place],
            deviations=self.deviations[place],
            numbers=self.numbers[place],
        )

    def compute(
        self,
        threads: int,
        deliver: Callable[[int, list[_core.Summit], int], None],
        heed: Callable[[float], None],
    ) -> bool:
        """Compute the disks; False if Ctrl-C has ended it."""
        with refusals(*self.disks):
            return _core.mistuning_study(
                [tuned_disk(one) for one in self.disks],
                self.which,
                self.deviations,
                self.groups,
                self.settings,
                self.settings,
                self.orders,
                threads,
                deliver,
                heed,
            )


def computed(batch: Batch) -> tuple[str, list[tuple[int, list[Row], int]]]:
    """Compute a batch with one thread; return the version of stickslip, and what it has found."""
    found: list[tuple[int, list[Row], int]] = []

    def keep(index: int, rows: list[_core.Summit], points: int) -> None:
        found.append((batch.numbers[index], [Row(*row) for row in rows], points))

    batch.compute(1, keep, lambda _: None)
    return _core.__version__, found


def compute_on(
    client: Client,
    compute: Callable[[Kind], tuple[str, Sequence[tuple[Any, ...]]]],
    whole: Kind,
    run: Run,
    deliver: Callable[..., None],
) -> bool:
    """Compute work on a cluster; False if Ctrl-C has ended it.

    `compute` returns the version of stickslip with the rows of a batch, of which `deliver` takes
    each. A worker that is lost costs the batches that it was computing, which others take over.
    """
    try:
        from distributed import as_completed
    except ImportError:
        raise ModelError(
            "client: needs the package distributed: pip install 'stickslip[dask]'"
        ) from None
    threads = sum(getattr(client, "nthreads", dict)().values())
    if not threads:
        raise ModelError(f"client: {brief(client)} has no workers; start some, or leave it out")
    futures = client.map(compute, list(_split(whole, threads)), pure=False)
    waiting = as_completed(futures)  # type: ignore[no-untyped-call, unused-ignore]
    try:
        for _ in futures:
            with run.at_once():
                future: Any = next(waiting)
            version, found = _result_of(future)
            if version != _core.__version__:
                raise ModelError(
                    f"client: a worker has stickslip {version}, and this is {_core.__version__}; "
                    "install the same version everywhere"
                )
            for row in found:
                deliver(*row)
    except KeyboardInterrupt:
        return False
    finally:
        client.cancel(futures)  # type: ignore[no-untyped-call, unused-ignore]
    return True


def _result_of(future: Any) -> Any:
    error = future.exception()
    if error is None:
        return future.result()
    if isinstance(error, ModelError):
        raise error
    raise ModelError(
        f"client: a batch was lost ({type(error).__name__}: {brief(str(error))}); see the log of "
        "the workers, whose memory may be too small"
    )


def _split(whole: Kind, threads: int) -> Iterator[Kind]:
    count = len(whole.numbers)
    size = min(_LARGEST, max(1, count // (_BATCHES * threads)))
    for start in range(0, count, size):
        yield whole.part(slice(start, start + size))
