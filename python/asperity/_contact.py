"""Static contacts."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from . import _case, _core, fields
from ._capabilities import OfContact
from ._described import described
from ._keywords import ContactKeywords, SlideKeywords, takes
from ._plastic_state import PlasticState, of_results
from ._progress import Teller
from ._raise import Warner, bad_input
from ._show import unit_of
from ._table import records, Table, Units
from ._units import path
from .body import Body, Handed, bodies
from .fields import Fields
from .material import Material
from .surface import Surface

if TYPE_CHECKING:
    import pathlib

    from matplotlib.axes import Axes
    from pandas import DataFrame
    from typing_extensions import Unpack
    from xarray import Dataset


@described
class Contact(OfContact):
    """A computed static contact.

    :func:`contact`, :func:`slide` and :func:`open` return contacts. The numbers of a contact are attributes with the names of
    `summary.json`. The numbers of friction exist only with friction, those of rolling only in rolling.
    """

    # Made from the columns of the results: UPDATE=1 cargo test -p asperity-study
    load: Annotated[float, "Total normal force W, N."]
    approach: Annotated[float, "Rigid-body approach δ, m."]
    contact_area: Annotated[float,
        "Area of the cells in contact, m²: with p > 0, or with p > −σ(0) where the bodies attract each other."]
    apparent_area: Annotated[float, "Area of the whole grid, m²."]
    max_pressure: Annotated[float, "Largest pressure, Pa."]
    mean_gap: Annotated[float, "Mean deformed gap, m."]
    elastic_energy: Annotated[float, "Elastic energy ½ ΔA Σ p u, with friction ½ ΔA Σ (p u + q·uₜ), J."]
    plastic_cells: Annotated[int, "Number of cells at the hardness, or at their caps under shear."]
    plastic_volume: Annotated[float,
        "Plastic volume ΔA Σ w, with w the plastic interference of the cells over the whole loading, m³."]
    iterations: Annotated[int, "Iterations of the solver."]
    convolutions: Annotated[float, "Convolutions; a convolution on a coarser grid counts by its fraction of cells."]
    residual: Annotated[float, "Scale-free complementarity residual η."]
    tangential_force: Annotated[list[float], "Force of the upper body on the lower one, along x and y, N."]
    force_ratio: Annotated[float, "Magnitude of the tangential force over the load; 0 unless the load is above 0."]
    friction_coefficient: Annotated[float | None,
        "Force ratio if no cell sticks, that is the friction coefficient of the whole contact; otherwise unknown."]
    tangential_displacement: Annotated[list[float],
        "Rigid-body displacement of the upper body relative to the lower one, along x and y, m; 0 in sliding."]
    stick_area: Annotated[float, "Area of the cells that stick in the last increment, m²."]
    max_shear: Annotated[float, "Largest shear traction, Pa."]
    dissipation: Annotated[float,
        "Energy dissipated by friction, J. In rolling it is the dissipation while the contact moves by one cell, from the work of "
        "force, moment and pressure. In sliding it is 0, because the slip has no limit."]
    slip_work: Annotated[float,
        "In rolling, work of the shear on the slip of the cells while the contact moves by one cell, ΔA Σ q·Δs, J. It converges "
        "to `dissipation` with smaller cells."]
    creepage: Annotated[list[float],
        "In rolling, velocity of the upper body relative to the lower one, over the rolling velocity, along x and y."]
    spin: Annotated[float,
        "In rolling, angular velocity of the upper body relative to the lower one, over the rolling velocity, about z through the "
        "middle of the grid, 1/m."]
    moment: Annotated[float, "In rolling, moment of the upper body on the lower one about the same axis, N m."]
    adhesive_load: Annotated[float, "Force of the tension on the open cells, ΔA Σ σ(g), N."]
    min_pressure: Annotated[float, "Least pressure, Pa; below 0 where the surfaces attract each other."]
    adhesion_energy: Annotated[float,
        "Energy of the attraction, ΔA Σ v(g), J: −w for each area in contact, 0 far apart."]
    energy_lost: Annotated[float,
        "Energy lost in jumps, J: the work done minus the energy stored, by the trapezoidal rule; 0 for bodies that come from "
        "afar."]
    jumps: Annotated[int,
        "Number of jumps: increments, or positions, that lose more than 1 % of the energy, and more than the work of adhesion of "
        "a cell."]
    max_plastic_strain: Annotated[float, "Largest accumulated plastic strain."]
    max_plastic_strain_position: Annotated[list[float],
        "Position of the largest plastic strain, m: x and y from the corner of the body, z from its surface."]
    yielded_volume: Annotated[float, "Volume of all cells with plastic strain, m³."]
    plastic_work: Annotated[float, "Plastic work ∫ σ : dε, J."]
    stored_energy: Annotated[float, "Energy stored in the residual stress, −½ ∫ ε : Kε, J."]
    displaced_volume: Annotated[float,
        "Volume ΔA Σ max(r, 0) by which the surfaces have been displaced inward, m³; r is the inward displacement by the plastic "
        "strain."]
    max_residual_tension: Annotated[float, "Largest principal residual stress, in tension, Pa."]
    residual_displacement: Annotated[float,
        "Range of the inward displacement r of a surface, m: its largest minus its smallest value."]
    products: Annotated[int, "Applications of the operator of the residual stress, over all increments."]
    mismatch: Annotated[float, "Largest return-mapping residual over the yield stress at the end of an increment."]
    regime: Annotated[str, "Response of the bodies to repeated loading, as a word."]
    strain_per_pass: Annotated[float, "Growth of the largest plastic strain per pass, if the bodies ratchet."]
    shift_per_pass: Annotated[float,
        "Displacement of the surface along x per pass, if the bodies ratchet, m; the larger one of the two bodies."]
    residual_max_plastic_strain: Annotated[float, "`max_plastic_strain` after unloading."]
    residual_yielded_volume: Annotated[float, "`yielded_volume` after unloading, m³."]
    residual_plastic_work: Annotated[float, "`plastic_work` after unloading, J."]
    residual_stored_energy: Annotated[float, "`stored_energy` after unloading, J."]
    residual_displaced_volume: Annotated[float, "`displaced_volume` after unloading, m³."]
    residual_max_residual_tension: Annotated[float, "`max_residual_tension` after unloading, Pa."]
    residual_residual_displacement: Annotated[float, "`residual_displacement` after unloading, m."]
    cycles: Annotated[int, "Cycles done at the end of the increment, with those that were not computed."]
    worn_volume_lower: Annotated[float, "Volume that the lower body has worn off so far, m³."]
    worn_volume_upper: Annotated[float, "Volume that the upper body has worn off so far, m³."]
    max_wear_lower: Annotated[float, "Deepest wear of a cell of the lower body so far, m."]
    max_wear_upper: Annotated[float, "Deepest wear of a cell of the upper body so far, m."]
    max_film_lower: Annotated[float, "Thickest film on a cell of the lower body, m; 0 without a film."]
    max_film_upper: Annotated[float, "Thickest film on a cell of the upper body, m; 0 without a film."]
    friction_work: Annotated[float, "Energy dissipated by friction so far, with the cycles that were not computed, J."]
    wear_error: Annotated[float, "Estimate of the error of the heights by cycles that were not computed, m."]
    friction_power: Annotated[float, "Frictional power, W; of a cycle its mean."]
    max_flash_temperature: Annotated[float, "Largest absolute temperature of the surfaces, K."]
    # The end of what is made.
    fields: Annotated[Fields,
        "The fields `pressure`, `gap`, `displacement`, `lower`, `upper`, `plastic`. Friction adds `traction_x`, `traction_y`, "
        "`displacement_x`, `displacement_y`, `slip_x`, `slip_y` and `stick`. A map of the hardness adds `cap`. Adhesion adds "
        "`contact`, 1 in contact and 0 elsewhere. An oil adds it, too, and `oil_pressure`, `solid_pressure` and `cavity`."]
    sweep: Annotated[Table,
        "A record for each point of a sweep, else empty. The numbers and fields of the contact are those of the last point."]
    increments: Annotated[Table, "A record for each increment of a loading in stages, else empty."]
    updates: Annotated[Table,
        "A record for each update of a contact that slides in place, see :func:`slide`, else empty. The first record is the contact "
        "before sliding."]
    warnings: Annotated[list[str], "Warnings about doubtful input and results."]
    case: Annotated[dict[str, Any], "The resolved case, SI."]
    plastic_state: Annotated[dict[str, PlasticState],
        "Plastic state of elasto-plastic bodies, a :class:`PlasticState` for ``\"lower\"`` and for ``\"upper\"``."]
    closed_form: Annotated[dict[str, Any] | None,
        "Closed form of the contact of two smooth forms (Hertz, Sneddon) at the same load, and the deviation of the computed contact "
        "from it: the keys `theory`, `theory_max_pressure`, `max_pressure_deviation` and others of `closed_form` in `summary.json`. "
        "`None` for other bodies, and if cells yield or wear."]
    adhesion: Annotated[dict[str, Any] | None,
        "Adhesion of the bodies in numbers: the keys `range`, `process_zone_cells`, `tabor`, `pull_off`, `work_of_separation` and "
        "others of `adhesion` in `summary.json`. `None` without adhesion."]
    directory: Annotated["pathlib.Path | None",
        "The results directory, or `None` if the contact was computed without `out`."]

    def __init__(
        self, found: Mapping[str, Any], of_cells: Fields, plastic_state: dict[str, PlasticState], directory: pathlib.Path | None = None
    ) -> None:
        sweep = found.get("sweep", [])
        self.fields = of_cells
        self.sweep = records(sweep, _core.SWEEP_COLUMNS)
        self.increments = records(found["increments"], _core.INCREMENT_COLUMNS)
        self.updates = records(found["updates"], ["update", "distance"])
        self.warnings = list(found["warnings"])
        self.case = found["case"]
        self.plastic_state = plastic_state
        self.closed_form = found.get("closed_form")
        self.adhesion = found["interface"].get("adhesion")
        self.directory = directory
        self._seen: dict[str, list[dict[str, Any]]] = found["found"]
        record = found.get("record") or sweep[-1]
        self._names = list(record)
        self.__dict__.update(record)

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
    def displacement(self) -> NDArray[np.float64]:
        """Sum of the normal displacements of both bodies, positive if it opens the gap, m."""
        return self.fields["displacement"].values

    @property
    def plastic(self) -> NDArray[np.float64]:
        """Plastic interference of each cell, m."""
        return self.fields["plastic"].values

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

        return contact(
            self.numbers, self.fields["pressure"], fraction=self.contact_fraction, points=len(self.sweep),
            adhesion=self.adhesion, theory=self.closed_form, warnings=self.warnings,
        )  # fmt: skip


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
        warner.all(found["warnings"])
        arrays = fields.of_cells(found["fields"], (found["pitch"][0], found["pitch"][1]))
        return Contact(found, arrays, {body: PlasticState(**volume) for body, volume in found.get("plastic_state", {}).items()})
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
    record = summary.get("static")
    if record is not None:
        # Only a converged contact has a summary.
        del record["converged"]
    found = {
        "record": record, "warnings": summary["warnings"], "case": core.case(), "closed_form": summary.get("closed_form"),
        "interface": summary, **{table: core.rows(table) for table in ("sweep", "increments", "updates", "found")},
    }  # fmt: skip
    return Contact(found, fields.stored(core, "contact", None), of_results(core, None), pathlib.Path(directory))
