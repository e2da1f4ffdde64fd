"""Schema of a file for ``southwell condense``: matrices, nodes and sections; unknown keys are rejected."""

from typing import Annotated, Literal

from msgspec import Meta, Struct

from ...core.condense.ties import Kind
from ..input.names import Name

Three = tuple[float, float, float]
Axis = Annotated[
    Literal["x", "y", "z", "-x", "-y", "-z"] | Three, Meta(description="in the model's axes: a name, or a vector")
]
Freedom = Annotated[int, Meta(ge=1, le=6, description="1–3 displacement along x, y, z; 4–6 rotation about them")]


class Matrix(Struct, frozen=True, forbid_unknown_fields=True):
    """One matrix of a file that has several."""

    file: str
    matrix: Annotated[str, Meta(description="TYPE of a *MATRIX, or name of a DMIG, as in KAAX")]


class Body(Struct, frozen=True, forbid_unknown_fields=True):
    """Mass of a segment without a mass matrix, in the units of the file and the axes of the model."""

    mass: Annotated[float, Meta(gt=0)]
    centre: Three
    moments: Annotated[
        list[float | list[float]], Meta(description="moments of inertia about the centre: three principal ones, or 3×3")
    ]


class Model(Struct, frozen=True, forbid_unknown_fields=True):
    """A finite element model exported by another code."""

    stiffness: str | Matrix | None = None
    mass: str | Matrix | None = None
    nodes: Annotated[str | None, Meta(description="CSV of id, x, y, z")] = None
    freedoms: Annotated[
        str | tuple[Freedom, ...] | None,
        Meta(
            description="degrees of freedom of a matrix that does not name them: those of each node, in the order of the CSV "
            "of nodes; or a CSV of node, freedom, one line per row"
        ),
    ] = None


class Piece(Model, frozen=True, forbid_unknown_fields=True):
    """The model of one segment; missing keys are those of the file."""

    body: Body | None = None


class At(Struct, frozen=True, forbid_unknown_fields=True):
    """A section: its plane passes through the point, across the axis."""

    point: Three
    axis: Annotated[Axis | None, Meta(description="none: the span")] = None
    tie: Kind | None = None


class CondenseFile(Model, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A file for ``southwell condense``: one model cut at its sections, or ``[[segments]]`` with a model each."""

    name: Name
    sections: Annotated[
        tuple[float | At, ...],
        Meta(min_length=2, description="from the root to the tip: coordinate along the span, or place"),
    ]
    segments: tuple[Piece, ...] = ()
    title: Annotated[str, Meta(description="one line")] = ""
    source: Annotated[str, Meta(description="source of the matrices")] = ""
    tie: Annotated[Kind, Meta(description="default tie of the sections")] = "average"
    root: Annotated[Kind, Meta(description="tie of the first section")] = "rigid"
    weights: Annotated[
        Literal["mass", "mass matrix", "even"],
        Meta(description="weight of each node of a section in an average tie: see core.condense.ties.average"),
    ] = "mass"
    units: Annotated[
        Literal["m kg s", "mm t s"],
        Meta(description="of nodes, sections, bodies and matrices; mm t s: N/mm and tonnes"),
    ] = "m kg s"
    hub_radius: Annotated[
        Annotated[float, Meta(ge=0)] | None,
        Meta(description="m, from the rotor axis to the first section; none: as in the model"),
    ] = None
    span: Annotated[Axis, Meta(description="from the root to the tip")] = "x"
    rotor: Annotated[Axis, Meta(description="rotor axis, in the sense of rotation")] = "z"
