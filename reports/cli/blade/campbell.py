"""``southwell campbell``: a blade's Campbell diagram, its tables, mode shapes and figures, in one command."""

import errno
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ....cases.campbell import interpolation
from ....cases.campbell.changes import changes as blade_changes
from ....cases.campbell.diagram import Campbell, CampbellRequest
from ....cases.campbell.machine import MachineRequest
from ....cases.campbell.required import required_margin
from ....cases.input.changes import parse
from ....cases.input.errors import CaseError
from ....cases.input.writing import writable
from ....cases.verify import measurements
from ...campbell import changes as changes_table
from ...campbell import confirmation as confirmation_table
from ...campbell import interactive, page, tables
from ...campbell.cover import InputOrigin
from ...documents import html as as_html
from ...documents import pdf as as_pdf
from ...shared import not_used
from ...shared.console import output
from ...shared.paths import file_name
from ...shared.sheets import TOO_NEAR, Sheet, terminal
from ...shared.units import Units
from ..arguments import Accuracy, Changes, Elements, NumberOfModes, Workers, typed
from ..errors import UsageError
from ..mounting import Mounting
from . import campbell_machine
from . import campbell_options as options
from .campbell_solution import confirmed_by, solve
from .subjects import Subject, changed, single
from .subjects import subjects as find_subjects

BLADE_MODES, TURBINE_MODES = 6, 12
"""Default numbers of modes."""


def command(
    blade: str,
    /,
    *,
    rpm: str | None = None,
    omega: str | None = None,
    out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("southwell-campbell"),
    modes: NumberOfModes | None = None,
    per_rev: str = "1:6",
    operating: str | None = None,
    margin: str = "10%",
    elements: Elements | None = None,
    accuracy: Accuracy = 1e-6,
    allow_large_strain: bool = False,
    azimuth: float | None = None,
    tilt: float = 0.0,
    load: Path | None = None,
    workers: Workers = 1,
    changes: Changes = (),
    against: str | None = None,
    add: tuple[str, ...] = (),
    data_uncertainty: str | None = None,
    verify: bool = False,
    strict: bool = False,
    html: bool = False,
    pdf: bool = False,
    blade_only: bool = False,
    mounting: Mounting | None = None,
) -> int:
    """Compute the Campbell diagram of a blade or a turbine and judge its margins.

    The file of a turbine gives the modes of the whole turbine: an OpenFAST .fst file with a tower and at least two blades, a
    HAWC2 .htc file with a tower and at least three, or Southwell's TOML.

    The command prints the verdict on the margins, then tables of the modes, of the margins to n per revolution (nP), of
    resonances, and of crossings and veerings. It writes campbell.md, figures of the diagram and of the mode shapes (SVG, PNG),
    and CSV tables. Speeds are inserted where two modes come close to each other, and the modes are solved at each crossing of
    nP.

    Parameters
    ----------
    blade
        File of a turbine (.fst, .htc, TOML) or of a blade (ElastoDyn, BeamDyn, BModes, HAWC2, windIO, Southwell's TOML or
        CSV), or a case (listed by `southwell cases`), one of its blades as `case/blade`, or its TOML file.
    rpm
        Rotor speeds in rpm: a range `first:last:step` or a list `0,5,10`. Default: the speeds of the case; for a turbine, up
        to 1.25 times its rotor speed.
    omega
        Rotor speeds in rad/s, in the same form.
    out
        Output folder; one sub-folder per blade.
    modes
        Number of modes, from the lowest. Default: 6, for a turbine 12.
    per_rev
        Excitation orders n (nP): `1:6` or `1,2,3,6`.
    operating
        Operating range in the unit of the speeds, for example `6.9:12.1`. Margins are judged over this range.
    margin
        Required distance from nP over the operating range: relative to nP (`10%`, `10` or `0.1`), or absolute (`5Hz`).
    elements
        Number of beam elements of equal length. Default: at each speed as many as --accuracy requires.
    accuracy
        Largest relative uncertainty of a frequency; not used with --elements.
    allow_large_strain
        Accept steady strains above 20 %.
    azimuth
        Azimuth in degrees, 0 with the blade up and positive in the direction of rotation. Gravity is added as a steady load
        on the blade frozen at this azimuth. Default: no gravity.
    tilt
        Tilt of the rotor axis in degrees, positive with the upwind end raised (OpenFAST's ShftTilt has the opposite sign).
        Requires --azimuth.
    load
        CSV table of a steady load: `fraction [-]`, `fx [N/m]`, `fy [N/m]`, `fz [N/m]`, in hub axes (x along the blade, y in
        the direction of motion, z along the rotor axis).
    workers
        Worker processes that share the speeds.
    changes
        Change a property: `EI_flap=*1.1`, also EI_edge, GJ, EA, mass, tip_mass, twist, hub_radius, precone, pitch. May be
        repeated.
    against
        Another blade; adds a table of the change of every frequency relative to it.
    add
        `NAME=FILE.csv`: frequencies of a test rig (`measured [Hz]`) or of another program (`frequency [Hz]`), drawn over the
        lines. May be repeated. `southwell verify --add` compares them with the solver.
    data_uncertainty
        Standard uncertainty of measured frequencies whose file states none, for example `1%`.
    verify
        Solve the blade with all codes at the ends of the operating range, and add the uncertainty of each line and the
        independent codes that confirm it.
    strict
        End with status 1 if a margin is violated or could not be judged.
    html
        Also write campbell.html, one file that includes its figures, and, with the extra `interactive` (Plotly),
        campbell-interactive.html: frequencies, uncertainties and confirming codes under the pointer, zoom, lines that can be
        hidden, and animated mode shapes.
    pdf
        Also write campbell.pdf; requires the extra `pdf` (Typst).
    blade_only
        Solve one blade of a turbine (.fst, .htc), clamped at the hub, instead of the whole turbine.
    """
    if strict and operating is None:
        raise UsageError("--strict: margins are judged over an operating range: add --operating, as in 6.9:12.1")
    if verify and (azimuth is not None or load is not None):
        raise UsageError("--verify: the other codes solve the blade without gravity and steady loads: leave those out")
    if pdf:
        as_pdf.require()
    speed_option = options.speeds(rpm, omega)
    mount = (mounting or Mounting()).mount()
    if not blade_only and campbell_machine.is_turbine(blade):
        options.no_blade_options(
            elements=elements is not None,
            azimuth=azimuth is not None,
            load=load is not None,
            changes=bool(changes),
            against=against is not None,
            add=bool(add),
            verify=verify,
            pdf=pdf,
        )
        turbine = MachineRequest(
            speeds=(),
            modes=modes or TURBINE_MODES,
            per_rev=options.per_rev(per_rev),
            operating=options.operating(operating, speed_option[1], speed_option[0])
            if operating and speed_option
            else None,
            margin=required_margin(margin, "--margin"),
        )
        return int(not campbell_machine.run(blade, speed_option, turbine, mount, out, html) and strict)
    files = [measurements.user_results(text, measurements.defaults(data_uncertainty, None)) for text in add]
    measurements.check(files, data_uncertainty, None)
    subjects = changed(find_subjects(blade, mount), [parse(text) for text in changes])
    baseline = single(against, mount) if against else None
    count = modes or BLADE_MODES
    margins_kept = True
    for subject in subjects:
        if not (speed_option or subject.speeds):
            raise CaseError(f"--rpm: missing: {blade} does not define rotor speeds: give them, as in 0:15:0.5")
        speeds, units = speed_option or (subject.speeds, subject.units)
        request = CampbellRequest(
            speeds=tuple(speeds),
            modes=count,
            per_rev=options.per_rev(per_rev),
            operating=options.operating(operating, units, speeds) if operating else None,
            margin=required_margin(margin, "--margin"),
            elements=elements,
            accuracy=accuracy,
            allow_large_strain=allow_large_strain,
            gravity=options.gravity(azimuth, tilt),
            load=options.load(load, subject.blade),
        )
        folder = out / file_name(subject.blade.name.partition("/")[2]) if len(subjects) > 1 else out
        _check(out)
        diagram = solve(subject.blade, request, units, workers)
        extra, confirmed = [], ()
        if verify:
            confirmed = confirmed_by(diagram, subject, units)
            extra.append(confirmation_table.sheet(diagram, confirmed, units))
        if baseline:
            changes_of_modes = blade_changes(subject.blade, baseline.blade, speeds, count, elements)
            extra.append(changes_table.sheet(changes_of_modes, baseline.blade.name, units))
        facts = (*options.blade_alone(blade), *options.loads(azimuth, tilt, load))
        for text in facts:
            output().print(text, style="bold", markup=False, soft_wrap=True)
        doubts = interpolation.warnings(subject.blade, count)
        _show(diagram, units, subject, extra, doubts)
        margins_kept &= tables.margins_kept(diagram)
        origin = InputOrigin((*facts, *subject.about, *doubts), subject.files, not_used.lines(subject.unused))
        with writable(f"--out {out}"):
            paths = page.write(diagram, folder, units, typed(), origin, extra, files)
            if html:
                paths = (*paths, as_html.write(paths[0]))
                if interactive.installed():
                    codes = {c.track: ", ".join(c.codes) or "none" for c in confirmed}
                    speed_index = page.shapes_at(diagram)
                    paths = (*paths, interactive.write(diagram, folder, units, speed_index, codes))
            if pdf:
                paths = (*paths, as_pdf.write(paths[0]))
        names = ", ".join(path.name for path in paths)
        output().print(f"{folder}: {names}", markup=False, soft_wrap=True)
    return int(strict and not margins_kept)


def _check(out: Path) -> None:
    """Check that the folder can be written, before minutes of work.

    Raises:
        CaseError: if it cannot be written.
    """
    existing = next((path for path in (out, *out.parents) if os.path.exists(path)), Path())
    with writable(f"--out {out}"):
        if not os.path.isdir(existing):
            raise OSError(errno.ENOTDIR, f"{existing} is a file")
        if not os.access(existing, os.W_OK):
            raise OSError(errno.EACCES, f"no permission in {existing}")


def _show(
    diagram: Campbell, units: Units, subject: Subject, extra: Sequence[Sheet], doubts: Sequence[str] = ()
) -> None:
    console = output()
    line = tables.verdict(diagram, units)
    console.print(line, style="bold red" if line.startswith(TOO_NEAR) else "bold", markup=False)
    console.print()
    for sheet in (*tables.sheets(diagram, units), *extra):
        console.print(terminal(sheet, console.width))
        console.print()
    for line in subject.about:
        console.print(line, style="dim", markup=False)
    not_used.show(subject.unused, console)
    for line in (*doubts, *tables.notes(diagram, units)):
        console.print(line, style="yellow", markup=False, soft_wrap=True)
