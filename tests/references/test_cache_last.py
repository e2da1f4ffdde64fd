"""The latest result is returned again for the same arguments, and only for those."""

import numpy as np

from southwell.references.cache_last import cache_last


def test_the_latest_result_is_kept_for_the_same_arguments() -> None:
    made = []

    @cache_last
    def double(a: np.ndarray, n: int, sizes: tuple[int, ...] = ()) -> list[float]:
        made.append(n)
        return [*(2.0 * a), *sizes]

    ones, equal = np.ones(2), np.ones(2)
    first = double(ones, 3)
    assert double(ones, 3) is first
    assert made == [3]
    assert double(ones, 4) == first  # another number
    assert double(equal, 4) == first  # equal, but may be changed alone
    assert double(equal, 4, (5, 6)) == [*first, 5, 6]
    assert double(equal, 4, (5, 6)) == [*first, 5, 6]
    assert double(equal, 4, sizes=(5, 7)) == [*first, 5, 7]
    assert double(equal, True, (5, 7)) == [*first, 5, 7]
    assert double(equal, 1, (5, 7)) == [*first, 5, 7]
    assert made == [3, 4, 4, 4, 4, True, 1]
    assert double(ones, 3) is not first  # only the latest is kept
