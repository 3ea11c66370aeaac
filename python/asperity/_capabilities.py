"""The capabilities: what they compute from a contact, and what they have found in the contacts of a case."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import _conductance, _gap_flow
from ._keywords import takes
from ._solved import Solved
from ._table import Table, by_word, records

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Observed:
    """What the capabilities of a case have found in its contacts."""

    def _found(self, capability: str) -> list[dict[str, Any]]:
        """Return the records of a capability."""
        raise NotImplementedError

    @property
    def conductances(self) -> Table:
        """A record for each contact whose conductance was asked for, with the columns of `conductance.csv`, else empty."""
        return records(self._found("conductance"), [])

    @property
    def leakages(self) -> dict[str, Table]:
        """The flow through the gap under a pressure that falls along ``"x"`` and along ``"y"``: a table each.

        They have the columns of `flow.csv`. Empty if it was not asked for.
        """
        return by_word(self._found("flow"), "along")

    @property
    def joints(self) -> Table:
        """A record for each contact whose law of a joint was asked for, with the columns of `joint.csv`, else empty."""
        return records(self._found("joint"), [])

    @property
    def fatigue(self) -> dict[str, Table]:
        """A record for each pass of the ``"lower"`` and of the ``"upper"`` body whose fatigue was asked for: a table each.

        They have the columns of `fatigue.csv`. Empty if it was not asked for.
        """
        return by_word(self._found("fatigue"), "body")


class OfContact(Observed, Solved):
    """What the capabilities compute from a contact."""

    @takes(_conductance.ConductanceKeywords, kind="thermal", tolerance=1e-6)
    def conductance(self, **options: Unpack[_conductance.ConductanceKeywords]) -> _conductance.Conductance:
        """Compute the thermal or electrical conductance of this contact.

        Cells in contact, gap, pitch and boundary are those of the contact. The bodies are half-spaces without coatings: for coated bodies
        use the keyword `conductance` of :func:`contact`.

        Parameters
        ----------
        **options

        Returns
        -------
        Conductance

        Raises
        ------
        asperity.errors.BadInput, asperity.errors.NotConverged
            For the same reasons as :func:`asperity.conductance`.

        Examples
        --------
        >>> import asperity as asp
        >>> steel = asp.Material(young="210 GPa", poisson=0.3)
        >>> c = asp.contact(asp.form.flat((64, 64), pitch="6 um"), asp.form.sphere("10 mm"), steel, steel, load="10 N")
        >>> f"{c.conductance(conductivity='46 W/(m K)').conductance:.3g} W/K"
        '0.00797 W/K'
        """
        return _conductance.conductance(self, **options)

    @takes(_gap_flow.FlowKeywords, faces="linear")
    def flow(self, **options: Unpack[_gap_flow.FlowKeywords]) -> _gap_flow.GapFlow:
        """Compute the flow of a fluid through the gap of this contact.

        Gap and pitch are those of the contact. So are the ends and sides by default: along a free axis reservoirs and walls.

        Parameters
        ----------
        **options

        Returns
        -------
        GapFlow

        Raises
        ------
        asperity.errors.BadInput, asperity.errors.Memory
            For the same reasons as :func:`asperity.flow`.

        Examples
        --------
        >>> import asperity as asp
        >>> steel = asp.Material(young="210 GPa", poisson=0.3)
        >>> rough = asp.generate.self_affine((64, 64), "1 um", hurst=0.8, sq="0.2 um", shortest="8 um", seed=1)
        >>> c = asp.contact(asp.form.flat(), rough, steel, steel, mean_pressure="50 MPa", boundary="periodic")
        >>> f"{c.flow(viscosity='80 mPa s', pressure='1 bar').leakage[0]:.2g} m³/s"
        '5e-15 m³/s'
        """
        return _gap_flow.flow(self, **options)
