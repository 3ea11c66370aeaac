from _typeshed import Incomplete, SupportsGetItem, SupportsLenAndGetItem
from os import PathLike
from pathlib import Path
from typing import Any, SupportsFloat, SupportsIndex, final

@final
class BearingCurve:
    """
    A material ratio curve.
    """
    def __new__(cls, /, samples: Incomplete) -> BearingCurve: ...
    def at(self, /, what: str, places: Incomplete) -> Incomplete:
        """
        `"height"`, `"ratio"`, `"material_volume"` or `"void_volume"` at each of the places.
        """
    def core(self, /) -> list[tuple[str, float]] | None:
        """
        The core by the names of its parts; none of too few samples.
        """
    def heights(self, /) -> Incomplete: ...

@final
class Correlation:
    """
    An autocorrelation.
    """
    def __new__(cls, /, heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], periodic: bool) -> Correlation: ...
    def along(self, /, axis: str) -> list[tuple[float, float]]: ...
    def decay_length(self, /, angle: SupportsFloat | SupportsIndex, level: SupportsFloat | SupportsIndex) -> float: ...
    def decay_lengths(self, /, level: SupportsFloat | SupportsIndex) -> list[float]: ...
    def radial(self, /) -> list[tuple[float, float]]: ...
    def values(self, /) -> Incomplete: ...
    def variance(self, /) -> float: ...

@final
class Passes:
    """
    A motion under way.
    """
    def __new__(cls, /, source: dict | str | PathLike[str], handed: Incomplete, directory: str | PathLike[str], existing: str, threads: SupportsIndex, has_custom_laws: bool) -> Passes: ...
    def contacts(self, /, number: SupportsIndex) -> tuple[Incomplete, Incomplete, Incomplete, Incomplete, Incomplete, Incomplete, Incomplete, Incomplete, Incomplete]:
        """
        The contacts of the pass that is solved.
        """
    def done(self, /) -> int:
        """
        Number of passes that are finished.
        """
    def end(self, /) -> None:
        """
        Writes the summary; nothing more can be solved.
        """
    def finish(self, /, warn: Any) -> None:
        """
        Finishes the pass that is solved: it is written, and the next one begins on its bodies.
        """
    def grid(self, /) -> tuple[list[float], float, float, list[tuple[int, int]]]:
        """
        Size of a cell, the distance over which the bodies slide from one position to the next, the time that it takes, and the
        numbers of cells of the lower and of the upper body.
        """
    def heights(self, /) -> list[Incomplete]:
        """
        Heights of the lower and of the upper body as they are now.
        """
    def record(self, /) -> Any:
        """
        The pass that is solved, in numbers as they are now.
        """
    def remove(self, /, number: SupportsIndex, law: str, lower: Incomplete, upper: Incomplete) -> None:
        """
        Takes depths off the bodies of the pass that is solved.
        """
    def solve(self, /, progress: Any | None) -> bool:
        """
        Solves the next pass; false where there is none. One that is solved already is forgotten.
        """
    def steps(self, /, number: SupportsIndex) -> Any:
        """
        The positions of the pass that is solved, in numbers.
        """

@final
class Results:
    def __new__(cls, /, directory: str | PathLike[str]) -> Results: ...
    def attributes(self, /, kind: str, number: SupportsIndex | None) -> dict: ...
    def case(self, /) -> Any: ...
    def updates(self, /) -> Any: ...
    def found(self, /) -> Any:
        """
        Returns the rows of the capabilities, by their names.
        """
    def increments(self, /) -> Any: ...
    def names(self, /, kind: str, number: SupportsIndex | None) -> list[str]:
        """
        Names of the fields of a kind: "contact", "pass", "point", "increment", "subsurface", "plasticity".
        """
    def passes(self, /) -> Any: ...
    def read(self, /, kind: str, number: SupportsIndex | None, name: str) -> tuple[Incomplete, str, list[str], list[float], list[float]]: ...
    def report(self, /, out: str | PathLike[str] | None) -> Path:
        """
        Writes the page and gives its path.
        """
    def steps(self, /) -> Any: ...
    def summary(self, /) -> Any | None:
        """
        The summary; none until all is done.
        """
    def sweep(self, /) -> Any: ...

@final
class Spectrum:
    """
    A power spectral density.
    """
    def __new__(cls, /, heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], window: str) -> Spectrum: ...
    def along(self, /, axis: str) -> list[tuple[float, float, int]]: ...
    def angular(self, /, directions: SupportsIndex) -> Incomplete: ...
    def density(self, /) -> Incomplete: ...
    def moments(self, /) -> tuple[float, list[float], list[float], float, float, float, list[float]]: ...
    def nyquist(self, /) -> float: ...
    def radial(self, /, per_decade: SupportsIndex | None = None) -> list[tuple[float, float, int]]: ...
    def self_affinity(self, /, range: SupportsLenAndGetItem[SupportsFloat | SupportsIndex] | None, per_decade: SupportsIndex) -> tuple[float, float, list[float], int, float, float, str | None]:
        """
        The law of the points whose wave numbers lie in a range, or of the longest that follow one.
        """
    def variance(self, /) -> float: ...
    def wave_numbers(self, /) -> list[Incomplete]:
        """
        The wave numbers along x, of both signs, and along y.
        """

@final
class Study:
    def __new__(cls, /, file: str | PathLike[str], directory: str | PathLike[str]) -> Study: ...
    def axes(self, /) -> list[tuple[str, str, list]]:
        """
        Key, unit and values of each axis: numbers in SI, or texts.
        """
    def collect(self, /) -> tuple[list[int], tuple[str, str, list, list[int | None]] | None, list[tuple[str, str, Incomplete]], list[int], list[str | None]]:
        """
        Makes tables and page of what is there.
        """
    def indices(self, /) -> Incomplete:
        """
        For each case the index of the value of each axis.
        """
    def run(self, /, task: SupportsLenAndGetItem[SupportsIndex], retry: bool, threads: SupportsIndex, progress: Any | None) -> list[tuple[int, str]]:
        """
        Computes what is left of a task; then, if all is over, makes tables and page. Gives the cases that have failed.
        """
    def states(self, /) -> list[tuple[str, str | None]]:
        """
        How each case stands: "done", "failed", "running" in some process, or "open"; and why it failed.
        """
    def table(self, /) -> tuple[list[int], tuple[str, str, list, list[int | None]] | None, list[tuple[str, str, Incomplete]], list[int], list[str | None]] | None:
        """
        What came of the cases that are over; none before the study is begun.
        """
    def title(self, /) -> str: ...

def channels(path: str | PathLike[str]) -> list[str]:
    """
    The names of the height channels of a file, the default one first.
    """

def check_surface(table: dict) -> None:
    """
    Checks a table as far as it alone can tell.
    """

def closed_form(question: str, data: SupportsGetItem[int, SupportsFloat | SupportsIndex], points: Incomplete) -> Incomplete:
    """
    The answers of a closed form of these `data` at `points`, a row of coordinates each: a row of numbers each.
    """

def named_materials() -> list[tuple[str, str, float, float, float | None, float | None, float | None, float | None, float | None, str]]:
    """
    The materials that are known by name: name, grade, Young's modulus, Poisson's ratio, hardness, conductivity, heat capacity, density,
    resistivity, source.
    """

def compliances(lower: tuple[SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex, SupportsLenAndGetItem[SupportsFloat | SupportsIndex] | None], upper: tuple[SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex, SupportsLenAndGetItem[SupportsFloat | SupportsIndex] | None]) -> list[float]:
    """
    The compliances of a pair, 1/E*, 1/N*, 1/G*; E* and Dundurs' β of them; and the composite tangential modulus.
    """

def conductance(touching: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], edges: SupportsLenAndGetItem[str], kind: str, conductivities: SupportsLenAndGetItem[SupportsFloat | SupportsIndex], film: SupportsFloat | SupportsIndex, gas: tuple[SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex] | None, gap: Incomplete | None, tolerance: SupportsFloat | SupportsIndex, threads: SupportsIndex) -> dict:
    """
    Solves a joint: cells in contact and pitch, boundary along both axes, kind, conductivities of both bodies, film, conductivity and jump
    distance of the gas, gap, tolerance, number of threads.
    """

def damage(over_limit: Incomplete, depths: SupportsGetItem[int, SupportsFloat | SupportsIndex], law: tuple[SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex, bool]) -> tuple[Incomplete, Incomplete]:
    """
    The damage of a pass at each depth `[iz, ix, iy]`, and the wear in a pass below which a column pits, from f over its limit.
    """

def distribution(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], slope: str | None = None, classes: SupportsIndex | None = None) -> tuple[float, float, Incomplete]:
    """
    The distribution of the heights, or of a slope, over so many classes.
    """

def fatigue(pass_: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex], SupportsGetItem[int, SupportsFloat | SupportsIndex], SupportsLenAndGetItem[str], SupportsFloat | SupportsIndex], limits: SupportsLenAndGetItem[SupportsFloat | SupportsIndex], depths: SupportsGetItem[int, SupportsFloat | SupportsIndex], threads: SupportsIndex) -> tuple[list[Incomplete], list[float]]:
    """
    Dang Van's f, the radius of the smallest ball and the amplitude of the shear, each `[iz, ix, iy]`, and a and b of the criterion.
    """

def feature_parameters(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], pruning: SupportsFloat | SupportsIndex) -> list[tuple[str, float, str, str, str, str]]:
    """
    The feature parameters of ISO 25178, pruned at this share of Sz.
    """

def format(value: SupportsFloat | SupportsIndex, dimension: str) -> str:
    """
    A quantity as people write it.
    """

def flow(gap: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], ends: SupportsLenAndGetItem[str], sides: SupportsLenAndGetItem[str], faces: str, fluid: tuple[SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex, SupportsFloat | SupportsIndex | None] | None, threads: SupportsIndex) -> tuple[list[tuple[str, float]], float | None, list[tuple[list[tuple[str, float]], list[float], list[int] | None, float | None, Incomplete, list[Incomplete], Incomplete]]]:
    """
    Solves for the flow through a gap along both axes; a fluid has a viscosity, a drop of its pressure, and the absolute pressure of the
    outlet of a gas. Ends and sides are those of the flow along each axis. Returns numbers of the gap, the coupling of both directions, and the flow along each.
    """

def height_differences(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], axis: str) -> list[tuple[float, float]]:
    """
    Lags along an axis and the mean square differences of the heights there.
    """

def invariants(which: str, components: SupportsLenAndGetItem[Incomplete]) -> Incomplete:
    """
    Von Mises' stress, the largest shear or the principal stresses, one after the other, where the components are these.
    """

def line_heights(given: tuple[Incomplete, SupportsFloat | SupportsIndex, SupportsGetItem[int, tuple[str, SupportsFloat | SupportsIndex]]]) -> Incomplete:
    """
    The heights of a profile behind its filters.
    """

def line_parameters(given: tuple[Incomplete, SupportsFloat | SupportsIndex, SupportsGetItem[int, tuple[str, SupportsFloat | SupportsIndex]]]) -> list[tuple[str, float, str, str, str, str]]:
    """
    The parameters of ISO 21920 of a profile behind its filters.
    """

def main(arguments: SupportsGetItem[int, str]) -> int:
    """
    Runs the command with these arguments, the first of which is its name, and gives its exit code.
    """

def moments_by_differences(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]]) -> tuple[float, list[float], list[float], float, float, float, list[float]]:
    """
    The moments by differences between samples.
    """

def most_stressed(given: tuple[tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], SupportsLenAndGetItem[Incomplete | None], SupportsLenAndGetItem[str], SupportsFloat | SupportsIndex, bool], depths: SupportsGetItem[int, SupportsFloat | SupportsIndex], threads: SupportsIndex) -> tuple[tuple[float, list[int], float], tuple[float, list[int], float]]:
    """
    The largest von Mises' stress and the largest shear, on planes at the depths and between them.
    """

def parameters(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]]) -> list[tuple[str, float, str, str, str, str]]:
    """
    All parameters of ISO 25178.
    """

def profile(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], axis: str, index: SupportsIndex) -> tuple[Incomplete, float]:
    """
    The heights of a profile and their pitch.
    """

def profile_parameters(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], axis: str, cutoff: SupportsFloat | SupportsIndex) -> list[tuple[str, float, str, str, str, str]]:
    """
    Parameters of ISO 21920 of the roughness of all profiles along an axis, each the mean over them.
    """

def quantity(key: str, value: Any, dimension: str, positive: bool = True, infinite: bool = False) -> float:
    """
    A quantity in SI: a number, or a text with a unit. `positive`: it must be above 0; `infinite`: it may be infinite, too.
    Mistakes name the `key`.
    """

def rest(source: dict | str | PathLike[str], handed: Incomplete, threads: SupportsIndex, progress: Any | None, warn: Any) -> dict:
    """
    Computes a static contact.
    """

def run(source: dict | str | PathLike[str], handed: Incomplete, directory: str | PathLike[str], existing: str, threads: SupportsIndex, progress: Any | None, warn: Any) -> None:
    """
    Computes a case and writes its results to a directory.
    """

def segments(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], dales: bool, pruning: SupportsFloat | SupportsIndex) -> tuple[Incomplete, list[tuple[int, int, float, float, float, float, float, float, float, bool]]]:
    """
    The hills, or the dales, with the number of its hill for each sample.
    """

def self_affinity_of_differences(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], axis: str, range: SupportsLenAndGetItem[SupportsFloat | SupportsIndex]) -> tuple[float, float, list[float], int, float, float, str | None]:
    """
    The law of the height differences whose lags lie in a range.
    """

def stress(given: tuple[tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]], SupportsLenAndGetItem[Incomplete | None], SupportsLenAndGetItem[str], SupportsFloat | SupportsIndex, bool], depths: SupportsGetItem[int, SupportsFloat | SupportsIndex], threads: SupportsIndex) -> list[Incomplete]:
    """
    The components of the stress at the depths, each `[iz, ix, iy]`.
    """

def summits(heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]]) -> tuple[list[tuple[int, int, float, float]], float, list[float]]:
    """
    The summits.
    """

def surface(table: dict, given: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]] | None = None) -> dict:
    """
    The topography that a table describes, as `[lower.topography]` of a case does, with what its preparation came upon.
    `given` are the heights that it names `given = "heights"`.
    """

def verdict(passed: SupportsIndex, failed: SupportsIndex) -> str:
    """
    The last line of the table.
    """

def verification_cases() -> list[tuple[str, str]]:
    """
    Name and source of each case.
    """

def verify(index: SupportsIndex, threads: SupportsIndex) -> tuple[str, list[tuple[str, str, list[int], list[float], float, str, bool]], str | None]:
    """
    Computes the case of this index: its part of the table of `asperity verify`, its checks, and the error that ended it.
    """

def write_surface(path: str | PathLike[str], heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]]) -> None:
    """
    Writes heights to a file, in the format that the end of its name tells.
    """

def __getattr__(name: str) -> Incomplete: ...
