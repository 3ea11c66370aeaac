from _typeshed import Incomplete, SupportsGetItem, SupportsLenAndGetItem
from os import PathLike
from typing import Any, SupportsFloat, SupportsIndex, final

@final
class Passes:
    """
    A motion under way.
    """
    def __new__(cls, /, source: dict | str | PathLike[str], handed: Incomplete, directory: str | PathLike[str], existing: str, threads: SupportsIndex) -> Passes: ...
    def contacts(self, /) -> tuple[Incomplete, Incomplete, Incomplete, Incomplete, Incomplete]:
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
    def finish(self, /) -> None:
        """
        Finishes the pass that is solved: it is written, and the next one begins on its bodies.
        """
    def grid(self, /) -> tuple[list[float], float]:
        """
        Size of a cell, and the distance over which the bodies slide from one position to the next.
        """
    def heights(self, /) -> list[Incomplete]:
        """
        Heights of the lower and of the upper body as they are now.
        """
    def record(self, /) -> Any:
        """
        The pass that is solved, in numbers as they are now.
        """
    def remove(self, /, law: str, lower: Incomplete, upper: Incomplete) -> None:
        """
        Takes depths off the bodies of the pass that is solved.
        """
    def solve(self, /, progress: Any | None) -> bool:
        """
        Solves the next pass; false where there is none.
        """
    def steps(self, /) -> Any:
        """
        The positions of the pass that is solved, in numbers.
        """

@final
class Results:
    def __new__(cls, /, directory: str | PathLike[str]) -> Results: ...
    def attributes(self, /, kind: str, number: SupportsIndex | None) -> dict: ...
    def case(self, /) -> Any: ...
    def increments(self, /) -> Any: ...
    def names(self, /, kind: str, number: SupportsIndex | None) -> list[str]:
        """
        Names of the fields of a kind: "contact", "pass", "point", "subsurface".
        """
    def passes(self, /) -> Any: ...
    def read(self, /, kind: str, number: SupportsIndex | None, name: str) -> tuple[Incomplete, str, list[str], list[float], list[float]]: ...
    def steps(self, /) -> Any: ...
    def summary(self, /) -> Any | None:
        """
        The summary; none until all is done.
        """
    def sweep(self, /) -> Any: ...

def channels(path: str | PathLike[str]) -> list[str]:
    """
    The names of the height channels of a file, the default one first.
    """

def check_surface(table: dict) -> None:
    """
    Checks a table as far as it alone can tell.
    """

def format(value: SupportsFloat | SupportsIndex, dimension: str) -> str:
    """
    A quantity as people write it.
    """

def main(arguments: SupportsGetItem[int, str]) -> int:
    """
    Runs the command with these arguments, the first of which is its name, and gives its exit code.
    """

def quantity(key: str, value: Any, dimension: str, positive: bool = True, infinite: bool = False) -> float:
    """
    A quantity in SI: a number, or a text with a unit. `positive`: it must be above 0; `infinite`: it may be infinite, too.
    Mistakes name the `key`.
    """

def rest(source: dict | str | PathLike[str], handed: Incomplete, threads: SupportsIndex, progress: Any | None) -> dict:
    """
    Computes a contact at rest.
    """

def run(source: dict | str | PathLike[str], handed: Incomplete, directory: str | PathLike[str], existing: str, threads: SupportsIndex, progress: Any | None) -> None:
    """
    Computes a case and writes its results to a directory.
    """

def surface(table: dict, given: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]] | None = None) -> dict:
    """
    The topography that a table describes, as `[lower.topography]` of a case does, with what its preparation came upon.
    `given` are the heights that it names `given = "heights"`.
    """

def write_surface(path: str | PathLike[str], heights: tuple[Incomplete, SupportsLenAndGetItem[SupportsFloat | SupportsIndex]]) -> None:
    """
    Writes heights to a file, in the format that the end of its name tells.
    """

def __getattr__(name: str) -> Incomplete: ...
