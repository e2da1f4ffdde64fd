"""Which physical effects an analysis of a rotating blade keeps."""

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Effects:
    """The effects kept; all of them by default. A code declares those it lacks, and core can leave out the same.

    Attributes:
        prestretch: the steady state's displacements are followed (deformed radius), not only its internal forces.
        coriolis: the gyroscopic terms, 2 Ω × velocity.
        rotary_inertia: the sections' moments of inertia.
        geometric: stiffening by the steady internal forces.
    """

    prestretch: bool = True
    coriolis: bool = True
    rotary_inertia: bool = True
    geometric: bool = True

    def lacks(self) -> tuple[str, ...]:
        """Names of the effects left out."""
        return tuple(f.name.replace("_", " ") for f in fields(self) if not getattr(self, f.name))


ALL_EFFECTS = Effects()
