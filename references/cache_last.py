"""Cache the last result of a function: a code solves a blade at one speed after another."""

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


def cache_last(function: Callable[P, T]) -> Callable[P, T]:
    """Cache the last result of ``function`` and return it again for the same arguments.

    Arguments are the same if they are the same objects, or equal integers or tuples. They and the result must not be changed.
    """
    last: list[tuple[tuple[object, ...], T]] = []

    @wraps(function)
    def cached(*args: P.args, **kwargs: P.kwargs) -> T:
        arguments = (*args, *kwargs.values(), tuple(kwargs))
        if not last or len(last[0][0]) != len(arguments) or not all(map(_same, last[0][0], arguments)):
            last[:] = [(arguments, function(*args, **kwargs))]
        return last[0][1]

    return cached


def _same(a: object, b: object) -> bool:
    return a is b or (isinstance(a, int | tuple) and type(a) is type(b) and a == b)
