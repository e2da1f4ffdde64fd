"""Distributions of sampled properties, and their Latin hypercube sample.

Every property is stratified (McKay, Beckman and Conover, 1979): of n samples, one lies in each of n intervals of equal
probability. Properties are independent.
"""

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from msgspec import UNSET, Meta, Struct, UnsetType
from numpy.typing import NDArray
from scipy.special import ndtri
from scipy.stats import qmc

from ..input.changes import PROPERTIES, UNITS, PropertyChange
from ..input.errors import CaseError, nearest
from ..input.toml import convert

Array = NDArray[np.float64]

ABSOLUTE = "whether the numbers are values in the unit of the property; otherwise they are factors"

SMALLEST = 2.0**-53
"""Smallest distance of a probability from 0 and 1; a normal quantile is infinite there."""


class Normal(Struct, frozen=True, forbid_unknown_fields=True, tag_field="distribution", tag="normal"):
    """A normal distribution, of a factor with mean 1 by default."""

    standard_deviation: Annotated[float, Meta(gt=0, description="of a factor: relative")]
    mean: float | UnsetType = UNSET
    absolute: Annotated[bool, Meta(description=ABSOLUTE)] = False

    def quantile(self, probability: Array) -> Array:
        """The values (n,) at probabilities (n,)."""
        mean = 1.0 if self.mean is UNSET else self.mean
        return mean + self.standard_deviation * ndtri(np.clip(probability, SMALLEST, 1.0 - SMALLEST))

    def error(self) -> str | None:
        """Why the parameters are invalid, or None."""
        return "mean: missing: add it, since absolute = true" if self.absolute and self.mean is UNSET else None


class Uniform(Struct, frozen=True, forbid_unknown_fields=True, tag_field="distribution", tag="uniform"):
    """A uniform distribution between two bounds."""

    low: float
    high: float
    absolute: Annotated[bool, Meta(description=ABSOLUTE)] = False

    def quantile(self, probability: Array) -> Array:
        """The values (n,) at probabilities (n,)."""
        return self.low + (self.high - self.low) * probability

    def error(self) -> str | None:
        """Why the parameters are invalid, or None."""
        if not self.low < self.high:
            return f"low: {self.low:g}: not below high = {self.high:g}: exchange them"
        return _factor("low", self.low, self.absolute)


class Values(Struct, frozen=True, forbid_unknown_fields=True, tag_field="distribution", tag="values"):
    """A list of values of equal probability."""

    values: Annotated[tuple[float, ...], Meta(min_length=1)]
    absolute: Annotated[bool, Meta(description=ABSOLUTE)] = False

    def quantile(self, probability: Array) -> Array:
        """The values (n,) at probabilities (n,)."""
        index = np.minimum((probability * len(self.values)).astype(int), len(self.values) - 1)
        return np.array(self.values)[index]

    def error(self) -> str | None:
        """Why the parameters are invalid, or None."""
        return _factor("values", min(self.values), self.absolute)


Distribution = Normal | Uniform | Values


def _factor(field: str, smallest: float, absolute: bool) -> str | None:
    return None if absolute or smallest > 0 else f"{field}: {smallest:g}: a factor is positive: correct it"


def distributions(tables: Mapping[str, Any], path: str) -> dict[str, Distribution]:
    """The distributions in the table ``properties`` of a study file.

    Raises:
        CaseError: naming the property and the field.
    """
    distributions: dict[str, Distribution] = {}
    for name, table in tables.items():
        if name not in PROPERTIES:
            raise CaseError(f"{path}: properties.{name}: not a property of a blade: {nearest(name, PROPERTIES)}")
        distribution: Distribution = convert(table, Distribution, path, f"properties.{name}")  # type: ignore[arg-type]
        if distribution.absolute and name not in UNITS:
            raise CaseError(
                f"{path}: properties.{name}.absolute: {name} varies along the blade: leave it out and give factors"
            )
        if error := distribution.error():
            raise CaseError(f"{path}: properties.{name}.{error}")
        distributions[name] = distribution
    return distributions


def sample(properties: Mapping[str, Distribution], samples: int, seed: int) -> Array:
    """The sample (samples, properties), in the order of the properties; the same for the same arguments."""
    if not properties:
        return np.zeros((samples, 0))
    hypercube = qmc.LatinHypercube(
        len(properties),
        seed=np.random.default_rng(seed),  # pyright: ignore[reportCallIssue] # SciPy before 1.15 has no rng
    )
    unit = hypercube.random(samples)
    return np.stack([distribution.quantile(unit[:, k]) for k, distribution in enumerate(properties.values())], axis=1)


def changes(properties: Mapping[str, Distribution], values: Array) -> tuple[PropertyChange, ...]:
    """The changes of a blade for one sample (properties,)."""
    pairs = zip(properties.items(), values.tolist(), strict=True)
    return tuple(PropertyChange(name, value, not distribution.absolute) for (name, distribution), value in pairs)
