"""Contacts at rest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _case, _core, fields
from ._flow import Flow, of_results
from ._keywords import ContactKeywords, SlideKeywords, takes
from ._progress import Teller
from ._same import Comparable
from ._units import path
from .body import Body, Handed, bodies
from .errors import bad_input, warn
from .fields import Fields
from .material import Material
from .surface import Surface

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Contact(Comparable):
    """A static contact, computed.

    Numbers of the contact are attributes by the names that `summary.json` has; those of the shear are there with friction alone,
    those of rolling in rolling alone.

    Attributes
    ----------
    load : float
        Normal force, N.
    approach : float
        Rigid-body approach, m.
    contact_area, apparent_area : float
        Area of the cells with pressure, and of all cells, m².
    max_pressure : float
        Largest pressure, Pa.
    mean_gap : float
        Mean deformed gap, m.
    elastic_energy : float
        Elastic energy, J.
    plastic_cells : int
        Number of cells at the hardness.
    plastic_volume : float
        m³.
    iterations : int
        Iterations of the solver.
    convolutions : float
        Their cost.
    residual : float
        Scale-free complementarity residual.
    tangential_force, tangential_displacement : list of float
        Force of the upper body on the lower one, N, and its displacement against it, m, along x and y.
    force_ratio : float
        Magnitude of the tangential force over the load.
    friction_coefficient : float or None
        The same where no cell sticks.
    stick_area : float
        Area of the cells that stick, m².
    max_shear : float
        Largest shear traction, Pa.
    dissipation : float
        Energy that friction took, J; in rolling, while the contact moves on by a cell, from the work of force, moment and
        pressure.
    slip_work : float
        Work of the shear on the slip of the cells, J, in rolling: the dissipation without what the step from cell to cell
        takes.
    creepage : list of float
        Creepage along x and y, in rolling.
    spin, moment : float
        1/m and N·m, in rolling.
    fields : Fields
        The fields: `pressure`, `gap`, `displacement`, `lower`, `upper`, `plastic`; with friction also `traction_x` and
        `traction_y`, `displacement_x` and `_y`, `slip_x` and `_y`, `stick`; `cap` where cells differ in what they bear.
    increments : ndarray
        A record for each increment of a loading in stages; else empty.
    updates : ndarray
        Of a contact that slides in place, see :func:`slide`, a record for each update, the first before it slides; else empty.
    sweep : ndarray
        A record for each point of a sweep; else empty. Numbers and fields are those of the last one.
    warnings : list of str
        What to be wary of.
    case : dict
        The case as it was resolved, SI.
    flow : dict
        Of bodies that flow below their surfaces, by ``"lower"`` and ``"upper"``, a :class:`Flow` each.
    """

    load: float
    approach: float
    contact_area: float
    apparent_area: float
    max_pressure: float
    mean_gap: float
    elastic_energy: float
    plastic_cells: int
    plastic_volume: float
    iterations: int
    convolutions: float
    residual: float
    tangential_force: list[float]
    tangential_displacement: list[float]
    force_ratio: float
    friction_coefficient: float | None
    stick_area: float
    max_shear: float
    dissipation: float
    slip_work: float
    creepage: list[float]
    spin: float
    moment: float
    fields: Fields
    increments: NDArray[np.void]
    updates: NDArray[np.void]
    sweep: NDArray[np.void]
    warnings: list[str]
    case: dict[str, Any]
    flow: dict[str, Flow]

    def __init__(
        self,
        record: dict[str, Any] | None,
        sweep: list[dict[str, Any]],
        increments: list[dict[str, Any]],
        updates: list[dict[str, Any]],
        found: Fields,
        warnings: list[str],
        case: dict[str, Any],
        flow: dict[str, Flow],
    ) -> None:
        self.flow = flow
        self.fields = found
        self.increments = fields.table(increments, _core.INCREMENT_COLUMNS)
        self.updates = fields.table(updates, ["update", "distance"])
        self.sweep = fields.table(sweep, _core.SWEEP_COLUMNS)
        self.warnings = list(warnings)
        self.case = case
        self._names = list(record if record is not None else sweep[-1])
        self.__dict__.update(record if record is not None else sweep[-1])

    @property
    def numbers(self) -> dict[str, Any]:
        """All numbers of the contact, by name."""
        return {name: getattr(self, name) for name in self._names}

    @property
    def pressure(self) -> NDArray[np.float64]:
        """Pressure on each cell, Pa, ``[ix, iy]``."""
        return self.fields["pressure"].values

    @property
    def gap(self) -> NDArray[np.float64]:
        """Gap between the deformed surfaces, m; 0 in contact, below 0 where cells yield."""
        return self.fields["gap"].values

    @property
    def displacement(self) -> NDArray[np.float64]:
        """Displacement that opens the gap, of both bodies together, m."""
        return self.fields["displacement"].values

    @property
    def plastic(self) -> NDArray[np.float64]:
        """Plastic interference of each cell, m."""
        return self.fields["plastic"].values

    @property
    def pitch(self) -> tuple[float, float]:
        """Size of a cell along x and y, m."""
        x, y = self.fields["pressure"].pitch
        return x, y

    @property
    def contact_fraction(self) -> float:
        """Area of contact over the area of all cells, 0 to 1."""
        return float(np.count_nonzero(self.pressure > 0.0)) / self.pressure.size

    @property
    def lower(self) -> Surface:
        """The lower body's surface, as it was prepared."""
        return Surface(self.fields["lower"].values, self.pitch)

    @property
    def upper(self) -> Surface:
        """The upper body's underside, as it was prepared: a body of it is mounted ``"as-is"``."""
        return Surface(self.fields["upper"].values, self.pitch)

    def to_xarray(self) -> Any:
        """All fields as a Dataset of xarray, with the numbers as attributes."""
        dataset = self.fields.to_xarray()
        dataset.attrs.update({name: value for name, value in self.numbers.items() if value is not None})
        return dataset

    def plot(self, field: str = "pressure", **options: Any) -> Any:
        """Draw a field with matplotlib, on the axes `ax` if given; gives the axes. Other `options` go to ``imshow``."""
        return self.fields[field].plot(**options)

    def __repr__(self) -> str:
        load, pressure = _core.format(self.load, "force"), _core.format(self.max_pressure, "pressure")
        return f"<Contact: load {load}, {100.0 * self.contact_fraction:.3g} % in contact, largest pressure {pressure}>"

    def _repr_html_(self) -> str:
        from ._html import contact

        return contact(self)


@takes(ContactKeywords)
def contact(
    lower: Surface | Body,
    upper: Surface | Body,
    lower_material: Material | None = None,
    upper_material: Material | None = None,
    **options: Unpack[ContactKeywords],
) -> Contact:
    """Press two bodies together.

    The arguments have the names and the meaning of the keys of a case file.

    Parameters
    ----------
    lower, upper : Surface or Body
        The bodies; of surfaces the materials are given, too. The upper surface is turned over when it is mounted, see
        :class:`Body`.
    lower_material, upper_material : Material, optional
        What the surfaces are made of.
    **options

    Returns
    -------
    Contact

    Raises
    ------
    asperity.errors.BadInput
        For arguments without meaning.
    asperity.errors.Failed
        Where the contact cannot be computed: more load than the bodies bear, no convergence.
    KeyboardInterrupt
        At Ctrl-C, within a convolution.

    Examples
    --------
    >>> import asperity as asp
    >>> steel = asp.Material(young="210 GPa", poisson=0.3)
    >>> ball = asp.form.sphere("10 mm")
    >>> plane = asp.form.flat((64, 64), pitch="10 um")
    >>> c = asp.contact(plane, ball, steel, steel, load="10 N")
    >>> bool(abs(c.max_pressure / asp.reference.HertzSphere(10e-3, 115.4e9, 10.0).peak_pressure() - 1) < 0.01)
    True
    """
    return _solved(bodies(lower, upper, lower_material, upper_material), ContactKeywords, options)


@takes(SlideKeywords)
def slide(
    lower: Surface | Body,
    upper: Surface | Body,
    lower_material: Material | None = None,
    upper_material: Material | None = None,
    **options: Unpack[SlideKeywords],
) -> Contact:
    """Slide two bodies in place: the same cells face each other all the way, as a ball on a disc or a punch, and wear.

    Parameters
    ----------
    lower, upper, lower_material, upper_material
        The bodies, as of :func:`contact`; one of them at least wears or grows a film, see :class:`Body`.
    **options

    Returns
    -------
    Contact
        On the bodies as they are in the end; `updates` has a record for each update, fields `wear_upper`, … the depth of wear.

    Raises
    ------
    asperity.errors.BadInput, asperity.errors.Failed, KeyboardInterrupt
        As of :func:`contact`.

    Examples
    --------
    >>> import asperity as asp
    >>> steel = asp.Material(young="210 GPa", poisson=0.3)
    >>> ball = asp.Body(asp.form.sphere("50 mm"), steel, wear={"coefficient": 1.33e-13})
    >>> disc = asp.Body(asp.form.flat((32, 32), pitch="40 um"), steel)
    >>> worn = asp.slide(disc, ball, load="10 N", distance="160 mm", updates=10, progress=False)
    >>> f"{worn.updates['wear_volume_upper'][-1]:.4g}"
    '2.128e-13'
    """
    return _solved(bodies(lower, upper, lower_material, upper_material), SlideKeywords, options)


def _solved(pair: tuple[Body, Body], keywords: Any, options: Mapping[str, Any]) -> Contact:
    """The contact at rest of two bodies, in memory, or of the results that it leaves."""
    handed = Handed(*pair)
    case = _case.tables(handed, keywords, options)
    count, existing = _case.execution(options)
    if options["out"] is None:
        written = {key: options.get(key) for key in ("subsurface", "paraview")}
        for key, value in {**written, "resume": options["resume"] or None}.items():
            if value is not None:
                message = f"'{key}' is given without 'out', the directory for what it writes"
                raise bad_input(key, message)
        with Teller(options["progress"]) as tell:
            found = _core.rest(case, handed.given, count, tell)
        pitch = (found["pitch"][0], found["pitch"][1])
        arrays = fields.of_cells(found["fields"], pitch)
        warn(found["warnings"])
        return Contact(
            found.get("record"),
            found.get("sweep", []),
            found["increments"],
            found["updates"],
            arrays,
            found["warnings"],
            found["case"],
            {body: Flow(**volume) for body, volume in found.get("flow", {}).items()},
        )
    out = path("out", options["out"])
    with Teller(options["progress"]) as tell:
        _core.run(case, handed.given, out, existing, count, tell)
    answer = stored(_core.Results(out))
    warn(answer.warnings)
    return answer


def stored(core: Any) -> Contact:
    """A contact of a results directory."""
    summary = core.summary()
    found = fields.stored(core, "contact", None)
    record = summary.get("static")
    if record is not None:
        # What has not converged leaves no summary.
        del record["converged"]
    return Contact(
        record, core.sweep(), core.increments(), core.updates(), found, summary["warnings"], core.case(), of_results(core, None)
    )
