"""The program held against closed forms."""

from __future__ import annotations

import html
from collections.abc import Iterator
from typing import Annotated, Any, NamedTuple

from . import _case, _core
from ._described import described
from ._progress import Teller, Told
from ._raise import bad_input
from ._same import Comparable


@described
class Check(NamedTuple):
    """One quantity of a closed form on finer and finer grids."""

    case: Annotated[str, "What is computed."]
    source: Annotated[str, "Work in which the closed form is found."]
    quantity: Annotated[str, "What is compared."]
    refinement: Annotated[str, "What grows: cells per length, steps, a ratio."]
    sizes: Annotated[tuple[int, ...], "Values of the refinement, ascending."]
    errors: Annotated[tuple[float, ...], "Relative error at each size."]
    order: Annotated[float,
        "Order k of error ∝ size^(−k), by least squares; NaN where an error is 0 or there is a single size."]
    expected: Annotated[str, "What theory expects."]
    passed: Annotated[bool, "Whether the errors are as expected."]


@described
class Verification(Comparable):
    """What came of the checks; printed, it is the table of ``asperity verify``.

    Made by :func:`asperity.verify`. To go through it is to go through its checks.
    """

    checks: Annotated[list[Check], "All checks that could be computed, in their order."]
    failures: Annotated[dict[str, str], "The message for each case that could not be computed, by name."]

    def __init__(self, checks: list[Check], failures: dict[str, str], parts: list[str]) -> None:
        self.checks = checks
        self.failures = failures
        self._parts = parts

    @property
    def passed(self) -> bool:
        """Whether all checks are as expected."""
        return not self.failures and all(check.passed for check in self.checks)

    @property
    def records(self) -> list[dict[str, Any]]:
        """The checks as dictionaries, as pandas takes them."""
        return [check._asdict() for check in self.checks]

    def __iter__(self) -> Iterator[Check]:
        return iter(self.checks)

    def __len__(self) -> int:
        return len(self.checks)

    def __bool__(self) -> bool:
        return True

    def _verdict(self) -> str:
        passed = sum(check.passed for check in self.checks)
        return str(_core.verdict(passed, len(self.checks) - passed + len(self.failures)))

    def __str__(self) -> str:
        return "".join([*self._parts, self._verdict()])

    def __repr__(self) -> str:
        return f"<Verification: {self._verdict()}>"

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self))}</pre>"


def verification_cases() -> list[str]:
    """Names of the closed forms that :func:`verify` can compute."""
    return [name for name, _ in _core.verification_cases()]


def verify(*names: str, threads: int | None = None, progress: Told = True) -> Verification:
    """Hold the program against closed forms, by the order in which its errors vanish.

    Each case is computed on finer and finer grids; all of them take less than a minute.

    Parameters
    ----------
    *names : str
        Names of cases, or parts of such, in capitals or not, to compute these alone; :func:`verification_cases` lists them.
    threads : int, optional
        Threads that share the work; one for each core by default.
    progress : bool or callable
        Whether a progress bar is shown, if tqdm is installed; or a function that is called with a :class:`Progress`, whose
        positions are the cases.

    Returns
    -------
    Verification

    Raises
    ------
    asperity.errors.CaseError
        If no case is called so.
    KeyboardInterrupt
        At Ctrl-C, between two cases.

    Examples
    --------
    >>> import asperity as asp
    >>> found = asp.verify("loaded rectangle", progress=False)
    >>> found.passed
    True
    """
    cases = _core.verification_cases()
    wanted = set(range(len(cases))) if not names else set()
    for name in names:
        found = {index for index, (known, _) in enumerate(cases) if known == name}
        found = found or {index for index, (known, _) in enumerate(cases) if name.lower() in known.lower()}
        if not found:
            listed = ", ".join(f'"{known}"' for known, _ in cases)
            raise bad_input("names", f"no case is called {name!r}", f"there are {listed}")
        wanted |= found
    chosen = sorted(wanted)
    count = _case.threads(threads)
    checks: list[Check] = []
    failures: dict[str, str] = {}
    parts: list[str] = []
    with Teller(progress) as tell:
        for done, index in enumerate(chosen):
            name, source = cases[index]
            text, rows, error = _core.verify(index, count)
            parts.append(text)
            checks += [
                Check(name, source, quantity, refinement, tuple(sizes), tuple(errors), order, expected, passed)
                for quantity, refinement, sizes, errors, order, expected, passed in rows
            ]
            if error is not None:
                failures[name] = error
            if tell is not None:
                tell(1, 1, 1, done + 1, len(chosen), float("nan"), None)
    return Verification(checks, failures, parts)
