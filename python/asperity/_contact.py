"""Static contacts."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _case, _core, fields
from ._capabilities import OfContact
from ._keywords import ContactKeywords, SlideKeywords, takes
from ._plastic_state import PlasticState, of_results
from ._progress import Teller
from ._show import unit_of
from ._table import records, Table, Units
from ._units import path
from .body import Body, Handed, bodies
from .errors import Warner, bad_input
from .fields import Fields
from .material import Material
from .surface import Surface

if TYPE_CHECKING:
    import pathlib

    from matplotlib.axes import Axes
    from pandas import DataFrame
    from typing_extensions import Unpack
    from xarray import Dataset


class Contact(OfContact):
    """A computed static contact.

    :func:`contact`, :func:`slide` and :func:`open` return contacts. The numbers of a contact are attributes with the names of
    `summary.json`. The numbers of friction exist only with friction, those of rolling only in rolling.

    Attributes
    ----------
    load : float
        Normal force, N.
    approach : float
        Rigid-body approach of the two bodies, m.
    contact_area : float
        Real contact area, m²: the cells with pressure, or with more than the largest tension where the bodies attract each other.
    apparent_area : float
        Area of all cells, m².
    max_pressure : float
        Largest pressure, Pa.
    mean_gap : float
        Mean gap between the deformed surfaces, m.
    elastic_energy : float
        Elastic energy of both bodies, J.
    plastic_cells : int
        Number of cells at the hardness.
    plastic_volume : float
        Volume removed by plastic deformation, m³.
    iterations : int
        Number of iterations of the solver.
    convolutions : float
        Number of elastic operator applications, the main cost of the solution.
    residual : float
        Scale-free complementarity residual of the solution.
    tangential_force : list of float
        Tangential force of the upper body on the lower one along x and y, N.
    tangential_displacement : list of float
        Tangential displacement of the upper body relative to the lower one along x and y, m.
    force_ratio : float
        Magnitude of the tangential force over the load.
    friction_coefficient : float or None
        Magnitude of the tangential force over the load if no cell sticks, else `None`.
    stick_area : float
        Area of the cells that stick, m².
    max_shear : float
        Largest shear traction, Pa.
    dissipation : float
        Energy dissipated by friction, J. In rolling: while the contact advances by one cell, from the work of force, moment and
        pressure.
    slip_work : float
        Work of the shear on the slip of the cells in rolling, J: the dissipation without the part of the step from cell to cell.
    creepage : list of float
        Creepage along x and y, in rolling.
    spin : float
        Spin in rolling, 1/m.
    moment : float
        Moment about z in rolling, N m.
    adhesive_load : float
        Force of the tension on the open cells of bodies that attract each other, N.
    min_pressure : float
        Least pressure of such bodies, below 0 in tension, Pa.
    adhesion_energy : float
        Energy of their attraction, J.
    energy_lost : float
        Energy that they lost in jumps, J.
    jumps : int
        Number of jumps.
    cycles : int
        Cycles of bodies that wear or grow films in them.
    worn_volume_lower, worn_volume_upper : float
        Volumes that they have worn off, m³.
    max_wear_lower, max_wear_upper : float
        Deepest wear of a cell of each body, m.
    max_film_lower, max_film_upper : float
        Thickest film on a cell of each body, m.
    friction_work : float
        Energy that friction took in all cycles, J.
    wear_error : float
        Estimate of the error of the heights by cycles that were not computed, m.
    fields : Fields
        The fields `pressure`, `gap`, `displacement`, `lower`, `upper`, `plastic`. Friction adds `traction_x`, `traction_y`,
        `displacement_x`, `displacement_y`, `slip_x`, `slip_y` and `stick`. A map of the hardness adds `cap`. Adhesion adds
        `contact`, 1 in contact and 0 elsewhere.
    sweep : Table
        A record for each point of a sweep, else empty. The numbers and fields of the contact are those of the last point.
    increments : Table
        A record for each increment of a loading in stages, else empty.
    updates : Table
        A record for each update of a contact that slides in place, see :func:`slide`, else empty. The first record is the contact
        before sliding.
    warnings : list of str
        Warnings about doubtful input and results.
    case : dict
        The resolved case, SI.
    plastic_state : dict
        Plastic state of elasto-plastic bodies, a :class:`PlasticState` for ``"lower"`` and for ``"upper"``.
    closed_form : dict or None
        Closed form of the contact of two smooth forms (Hertz, Sneddon) at the same load, and the deviation of the computed contact
        from it: the keys `theory`, `theory_max_pressure`, `max_pressure_deviation` and others of `closed_form` in `summary.json`.
        `None` for other bodies, and if cells yield or wear.
    adhesion : dict or None
        Adhesion of the bodies in numbers: the keys `range`, `process_zone_cells`, `tabor`, `pull_off`, `work_of_separation` and
        others of `adhesion` in `summary.json`. `None` without adhesion.
    directory : pathlib.Path or None
        The results directory, or `None` if the contact was computed without `out`.
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
    adhesive_load: float
    min_pressure: float
    adhesion_energy: float
    energy_lost: float
    jumps: int
    cycles: int
    worn_volume_lower: float
    worn_volume_upper: float
    max_wear_lower: float
    max_wear_upper: float
    max_film_lower: float
    max_film_upper: float
    friction_work: float
    wear_error: float
    fields: Fields
    sweep: Table
    increments: Table
    updates: Table
    warnings: list[str]
    case: dict[str, Any]
    plastic_state: dict[str, PlasticState]
    closed_form: dict[str, Any] | None
    adhesion: dict[str, Any] | None
    directory: pathlib.Path | None

    def __init__(
        self,
        record: dict[str, Any] | None,
        sweep: list[dict[str, Any]],
        increments: list[dict[str, Any]],
        updates: list[dict[str, Any]],
        seen: dict[str, list[dict[str, Any]]],
        found: Fields,
        warnings: list[str],
        case: dict[str, Any],
        plastic_state: dict[str, PlasticState],
        closed_form: dict[str, Any] | None = None,
        adhesion: dict[str, Any] | None = None,
        directory: pathlib.Path | None = None,
    ) -> None:
        self.plastic_state = plastic_state
        self.fields = found
        self.increments = records(increments, _core.INCREMENT_COLUMNS)
        self.updates = records(updates, ["update", "distance"])
        self._seen = seen
        self.sweep = records(sweep, _core.SWEEP_COLUMNS)
        self.warnings = list(warnings)
        self.case = case
        self.closed_form = closed_form
        self.adhesion = adhesion
        self.directory = directory
        self._names = list(record if record is not None else sweep[-1])
        self.__dict__.update(record if record is not None else sweep[-1])

    def _compared(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "directory"}

    @property
    def numbers(self) -> dict[str, Any]:
        """All numbers of the contact by name, SI."""
        return {name: getattr(self, name) for name in self._names}

    def _found(self, capability: str) -> list[dict[str, Any]]:
        return self._seen.get(capability, [])

    @property
    def _table(self) -> Table | None:
        """The table of a sweep, a loading in stages or sliding in place; a contact has one of them at most."""
        # A single increment is the contact itself.
        tables = (self.sweep, *(table for table in (self.increments, self.updates) if len(table) > 1))
        return next((table for table in tables if len(table)), None)

    @property
    def pressure(self) -> NDArray[np.float64]:
        """Pressure on each cell, Pa, ``[ix, iy]``."""
        return self.fields["pressure"].values

    @property
    def gap(self) -> NDArray[np.float64]:
        """Gap between the deformed surfaces, m. It is 0 in contact, and negative where cells yield."""
        return self.fields["gap"].values

    @property
    def displacement(self) -> NDArray[np.float64]:
        """Sum of the normal displacements of both bodies, positive if it opens the gap, m."""
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
    def touching(self) -> NDArray[np.bool_]:
        """Whether each cell is in contact. With adhesion a cell in contact may be under tension."""
        return np.asarray((self.fields["contact"].values if "contact" in self.fields else self.pressure) > 0.0)

    @property
    def contact_fraction(self) -> float:
        """Real contact area over the area of all cells, 0 to 1."""
        return float(np.count_nonzero(self.touching)) / self.touching.size

    @property
    def curve(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Approach, m, and load, N, of the increments or of the points of a sweep: with adhesion, a force–distance curve.

        Any other contact is one point of the curve.

        Examples
        --------
        >>> import asperity as asp
        >>> glass = asp.Material(young="70 GPa", poisson=0.2)
        >>> tip, plane = asp.form.sphere("50 nm"), asp.form.flat((32, 32), pitch="1 nm")
        >>> path = [{"approach": 0.5e-9, "increments": 4}, {"approach": -4e-9, "increments": 6}]
        >>> c = asp.contact(
        ...     plane, tip, glass, glass, approach="-4 nm", history=path, adhesion={"work": "50 mJ/m2", "range": "1 nm"}
        ... )
        >>> approach, load = c.curve
        >>> bool(load.min() == c.adhesion["pull_off"] < 0.0)
        True
        """
        table = self.sweep if len(self.sweep) else self.increments
        if len(table) == 0:
            return np.array([self.approach]), np.array([self.load])
        return np.array(table["approach"]), np.array(table["load"])

    @property
    def lower(self) -> Surface:
        """The prepared surface of the lower body."""
        return Surface(self.fields["lower"].values, self.pitch)

    @property
    def upper(self) -> Surface:
        """The prepared underside of the upper body. A body with it is mounted ``"as-is"``."""
        return Surface(self.fields["upper"].values, self.pitch)

    def to_xarray(self) -> Dataset:
        """Return all fields as an xarray Dataset, with the numbers as attributes.

        The attribute ``load`` has the unit ``load_units``, and so on. The table of a sweep, of a loading in stages or of sliding in
        place is included over `point`, `increment` or `update`.
        """
        dataset = self.fields.to_xarray()
        if self._table is not None:
            dataset = dataset.merge(self._table.to_xarray())
        for name, value in self.numbers.items():
            if value is not None:
                dataset.attrs[name] = value
                dataset.attrs[f"{name}_units"] = unit_of(name)
        return dataset

    def to_pandas(self, units: Units = "si") -> DataFrame:
        """Return the table of a sweep, a loading in stages or sliding in place as a pandas DataFrame, with its units.

        The table of any other contact has one row with its numbers, so that several contacts can be put together by
        ``pandas.concat``.

        Parameters
        ----------
        units : {"si", "display"}
            Units of the numbers, see :meth:`Table.to_pandas`.
        """
        table = self._table
        return (records([_components(self.numbers)], []) if table is None else table).to_pandas(units)

    def plot(self, quantity: str = "pressure", x: str | None = None, *, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw a field, or a curve over the points of a sweep, a loading in stages or sliding in place, with matplotlib.

        Parameters
        ----------
        quantity : str
            Name of a field, such as ``"pressure"``, or a column of the table, such as ``"contact_area"``.
        x : str, optional
            The column along the x axis of a curve, see :meth:`Table.plot`.
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; new ones by default.
        **options
            Passed on to ``Axes.imshow`` or ``Axes.plot``.
        """
        table = self._table
        if table is not None and quantity in (table.dtype.names or ()):
            return table.plot(quantity, x, ax=ax, **options)
        if quantity not in self.fields:
            columns = [] if table is None else table.dtype.names or ()
            known = ", ".join([*self.fields, *columns])
            raise bad_input("quantity", f"'quantity' is {quantity!r}, expected a field or a column of a table: {known}")
        return self.fields[quantity].plot(ax=ax, **options)

    def report(self, out: str | os.PathLike[str] | None = None) -> pathlib.Path:
        """Write a page with the maps, curves and tables of the contact in one HTML file, and return its path.

        The page opens in any browser without a network. The contact must be in a results directory: computed with `out`, or
        opened.

        Parameters
        ----------
        out : path, optional
            The file; by default `report.html` in the results directory.
        """
        if self.directory is None:
            message = "report() needs a results directory, and this contact is in memory only"
            raise bad_input("out", message, 'asp.contact(..., out="directory") keeps the results')
        return report(_core.Results(os.fspath(self.directory)), out)

    def __repr__(self) -> str:
        load, pressure = _core.format(self.load, "force"), _core.format(self.max_pressure, "pressure")
        points = f"sweep of {len(self.sweep)} points, the last one: " if len(self.sweep) else ""
        return (
            f"<Contact: {points}load {load}, {100.0 * self.contact_fraction:.3g} % in contact, largest pressure {pressure}>"
        )

    def _repr_html_(self) -> str:
        from ._html import contact

        return contact(self)


def report(core: Any, out: str | os.PathLike[str] | None) -> pathlib.Path:
    """Writes the page of a results directory."""
    written: pathlib.Path = core.report(None if out is None else path("out", out))
    return written


def _components(numbers: dict[str, Any]) -> dict[str, Any]:
    """Replaces each vector by its components, as the tables do, and keeps only numbers."""
    found: dict[str, Any] = {}
    for name, value in numbers.items():
        if isinstance(value, list):
            found.update({f"{name}_{axis}": part for axis, part in zip("xyz", value, strict=False)})
        elif value is None or isinstance(value, (int, float)):
            found[name] = value
    return found


@takes(ContactKeywords)
def contact(
    lower: Surface | Body,
    upper: Surface | Body,
    lower_material: Material | None = None,
    upper_material: Material | None = None,
    **options: Unpack[ContactKeywords],
) -> Contact:
    """Press two bodies together.

    The arguments have the names and the meaning of the keys of a case file. Exactly one of `load`, `mean_pressure` and
    `approach` is required; `loads`, `mean_pressures` or `approaches` compute a sweep.

    Parameters
    ----------
    lower, upper : Surface or Body
        The bodies. A surface also needs its material. The upper surface is turned over when it is mounted, see :class:`Body`.
    lower_material, upper_material : Material, optional
        Materials of the surfaces.
    **options

    Returns
    -------
    Contact

    Raises
    ------
    asperity.errors.BadInput
        If an argument has no meaning.
    asperity.errors.Failed
        If the contact cannot be computed, for example because the load exceeds the plastic limit.
    KeyboardInterrupt
        At Ctrl-C.

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
    """Slide and wear two bodies in place: the same cells stay in contact, as for a ball on a disc or a punch.

    Parameters
    ----------
    lower, upper, lower_material, upper_material
        The bodies, as in :func:`contact`. At least one of them wears or grows a film, see :class:`Body`.
    **options

    Returns
    -------
    Contact
        The contact of the worn bodies. `updates` has a record for each update. The fields `wear_lower` and `wear_upper` have the
        depth of wear.

    Raises
    ------
    asperity.errors.BadInput, asperity.errors.Failed, KeyboardInterrupt
        For the same reasons as :func:`contact`.

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
    """Solves a static contact in memory, or writes its results and opens them."""
    handed = Handed(*pair)
    case = _case.tables(handed, keywords, options)
    count, existing = _case.execution(options)
    if options["out"] is None:
        written = {key: options.get(key) for key in ("subsurface", "paraview")}
        for key, value in {**written, "resume": options["resume"] or None}.items():
            if value is not None:
                message = f"'{key}' needs 'out', the directory for its files"
                raise bad_input(key, message)
        warner = Warner()
        with Teller(options["progress"]) as tell:
            found = _core.rest(case, handed.given, count, tell, warner)
        pitch = (found["pitch"][0], found["pitch"][1])
        arrays = fields.of_cells(found["fields"], pitch)
        warner.all(found["warnings"])
        return Contact(
            found.get("record"),
            found.get("sweep", []),
            found["increments"],
            found["updates"],
            found["found"],
            arrays,
            found["warnings"],
            found["case"],
            {body: PlasticState(**volume) for body, volume in found.get("plastic_state", {}).items()},
            found["closed_form"],
            found["interface"].get("adhesion"),
        )
    out, warner = path("out", options["out"]), Warner()
    with Teller(options["progress"]) as tell:
        _core.run(case, handed.given, out, existing, count, tell, warner)
    answer = stored(out, _core.Results(out))
    warner.all(answer.warnings)
    return answer


def stored(directory: str, core: Any) -> Contact:
    """Opens the contact of a results directory."""
    # Imported here: otherwise the import of the package takes a third longer.
    import pathlib

    summary = core.summary()
    found = fields.stored(core, "contact", None)
    record = summary.get("static")
    if record is not None:
        # Only a converged contact has a summary.
        del record["converged"]
    return Contact(
        record,
        core.sweep(),
        core.increments(),
        core.updates(),
        core.found(),
        found,
        summary["warnings"],
        core.case(),
        of_results(core, None),
        summary.get("closed_form"),
        summary.get("adhesion"),
        pathlib.Path(directory),
    )
