"""Which parameters are uncertain, what is asked, and how it is sampled."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from stickslip.checks import brief, unknown
from stickslip.errors import EntryError
from stickslip.settings.balance import HarmonicSettings
from stickslip.settings.entries import ONE_OF, Count, Index
from stickslip.settings.peaks import StoredKeys
from stickslip.settings.quantities import AnyQuantity
from stickslip.settings.ranges import by_parameter
from stickslip.settings.variation import unit_of
from stickslip.units import physical_number

if TYPE_CHECKING:
    from scipy.stats.distributions import rv_frozen

_WANTED = (
    "give a frozen distribution of scipy.stats, as stats.uniform(0.2, 0.4) or "
    '{"distribution": "uniform", "loc": 0.2, "scale": 0.4}'
)

_UNITS = {"residual": "N"}
"""Of parameters that are none of the model."""


def distribution(spec: Mapping[str, Any]) -> rv_frozen[Any, Any]:
    """Return the distribution of SciPy that a table describes."""
    from scipy import stats

    own = dict(spec)
    found: rv_frozen[Any, Any] = getattr(stats, own.pop("distribution"))(**own)
    return found


def _spec_of(parameter: str, given: object) -> dict[str, Any]:
    """Return the name of a distribution with its shape parameters, location and scale."""
    from scipy import stats

    spec = given
    kind = getattr(given, "dist", None)
    if isinstance(kind, stats.rv_continuous):
        arguments = given.args, given.kwds  # type: ignore[attr-defined]
        shapes, loc, scale = kind._parse_args(*arguments[0], **arguments[1])  # type: ignore[attr-defined]
        names = kind.shapes.replace(",", " ").split() if kind.shapes else []
        spec = {
            "distribution": kind.name,
            **dict(zip(names, shapes, strict=True)),
            "loc": loc,
            "scale": scale,
        }
    if not isinstance(spec, Mapping) or "distribution" not in spec:
        raise EntryError("", f": {brief(given)}; {_WANTED}")
    name = spec["distribution"]
    if name not in _known():
        raise EntryError("", f": {unknown('distribution', name, _known())}")
    law = getattr(stats, name)
    shapes = law.shapes.replace(",", " ").split() if law.shapes else []
    numbers = {}
    for key, value in spec.items():
        if key == "distribution":
            continue
        if key not in (*shapes, "loc", "scale"):
            raise EntryError("", f": {unknown('key', key, [*shapes, 'loc', 'scale'])}")
        unit = "" if key in shapes else _UNITS.get(parameter, unit_of(parameter))
        numbers[key] = physical_number(value, unit, f".{key}")
    missing = [key for key in shapes if key not in numbers]
    if missing:
        raise EntryError("", f": {name} lacks {missing[0]!r}; {_WANTED}")
    made = {"distribution": name, "loc": 0.0, "scale": 1.0} | numbers
    try:
        low, high = distribution(made).support()
    except ValueError:
        low = high = float("nan")
    if not low < high:
        raise EntryError("", f": {brief(made)} is no distribution; {_WANTED}")
    return made


@cache
def _known() -> tuple[str, ...]:
    from scipy import stats

    return tuple(name for name, one in vars(stats).items() if isinstance(one, stats.rv_continuous))


def _given_spec(parameter: str, given: object) -> dict[str, Any]:
    """Return the same with texts as they are given."""
    found = _spec_of(parameter, given)
    return found | dict(given) if isinstance(given, Mapping) else found


_TAKEN = '"friction": stats.uniform(0.2, 0.4)', "object", "distribution"
_NAMES = Field(
    description="Names of the uncertain parameters with their distributions, of scipy.stats: "
    'those of `fit`; "residual", the force that stuck contacts hold [N]; "mistuning" of a '
    "tuned disk, the deviation of the stiffness of every sector, which are drawn one by one. "
    "Parameters are independent.",
    examples=[{"pad.friction": {"distribution": "uniform", "loc": 0.2, "scale": 0.4}}],
)


class SampledSettings(HarmonicSettings):
    """What is uncertain, what is asked, and how it is sampled."""

    parameters: Annotated[dict[str, dict[str, Any]], by_parameter(_spec_of, *_TAKEN)] = _NAMES
    quantity: AnyQuantity = Field(
        description="What is asked: a highest peak, an optimum, or a backbone."
    )
    samples: Count = Field(default=512, description="How many samples are drawn.")
    sampling: Annotated[Literal["sobol", "random"], ONE_OF] = Field(
        default="sobol",
        description="How samples are drawn: as points of a scrambled Sobol sequence, which fill "
        "the space evenly, best in powers of 2; or at random, for which intervals of percentiles "
        "are exact.",
    )
    seed: Index = Field(
        default=0,
        description="Seed of the samples. Sample i of a seed is the same for any number of them.",
    )


class UncertaintyKeys(StoredKeys, SampledSettings):
    """How the quantity of a model with uncertain parameters is computed."""

    parameters: Annotated[dict[str, dict[str, Any]], by_parameter(_given_spec, *_TAKEN)] = _NAMES
