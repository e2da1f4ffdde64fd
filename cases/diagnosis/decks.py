"""Hypotheses that a blade's file allows: how the program that its format belongs to describes the blade."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...core.blade import Blade
from ..input import files
from ..input.readers import BladeFile
from ..input.readers.hawc2.elements import with_elements
from ..input.readers.openfast import elastodyn, mode_shapes
from ..input.readers.text import integer, keys, load
from .elastodyn_blade import AssumedShapes
from .hypotheses import Hypothesis
from .model import Model

SECTIONS = ("stations", "stiffness", "mass", "twist", "curve", "kinks")
"""Fields of a blade that HAWC2's elements replace; another hypothesis may change the others."""


def hypotheses(file: BladeFile, blade: Blade) -> tuple[Hypothesis, ...]:
    """Hypotheses on the blade of a file; none if its sections are no longer those of the file.

    Raises:
        CaseError: naming the file and line at fault.
    """
    if not all(np.array_equal(getattr(blade, name), getattr(file.blade, name)) for name in SECTIONS):
        return ()
    of_format: dict[str, Callable[[BladeFile], tuple[Hypothesis, ...]]] = {"HAWC2": _hawc2, "ElastoDyn": _elastodyn}
    with files.reading(file.path, *file.source.files, deck=True):
        return of_format.get(file.source.format, lambda _: ())(file)


def _hawc2(file: BladeFile) -> tuple[Hypothesis, ...]:
    elements = with_elements(file.blade, file.path, file.mount)
    if elements is None:
        return ()
    sections = {name: getattr(elements, name) for name in SECTIONS}

    def change(model: Model, _: float) -> Model:
        return replace(model, blade=replace(model.blade, **sections), elements=1, two_node=True)

    count = len(elements.kinks) + 1
    return (Hypothesis(f"with HAWC2's {count} elements (each column averaged)", change),)


def _elastodyn(file: BladeFile) -> tuple[Hypothesis, ...]:
    texts = [load(path) for path in file.source.files]
    main = next((text for text in texts if elastodyn.is_main(text)), None)
    of_blade = next((text for text in texts if elastodyn.is_blade(text)), None)
    if main is None or of_blade is None or "bldnodes" not in keys(main):
        return ()
    shapes = mode_shapes.read(of_blade, mode_shapes.BLADE)
    count = integer(main, keys(main), "BldNodes")
    if not shapes or count < 1:
        return ()
    name = f"in ElastoDyn's {len(shapes)} assumed shapes on {count} nodes"
    return (Hypothesis(name, lambda model, _: replace(model, assumed=AssumedShapes(shapes, count))),)
