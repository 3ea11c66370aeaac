"""Base classes of the exceptions, and the exceptions that are no variant of the library's error."""

from __future__ import annotations

from typing import Any


class AsperityError(Exception):
    """Base of all exceptions of asperity."""

    hint: str | None = None
    """Advice on what to do, if there is any."""

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self),), dict(self.__dict__))


class BadInput(AsperityError, ValueError):
    """An argument, a key of a case or the content of a file is invalid."""


class Failed(AsperityError, RuntimeError):
    """A computation failed."""


class FileProblem(AsperityError, OSError):
    """A file or a directory cannot be read, written or used."""

    path: str

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class CaseError(BadInput):
    """An argument or a key of a case is wrong: `key`, with dots. In a case file also `path`, `line` and `column`, from 1."""

    key: str


class InternalError(AsperityError, RuntimeError):
    """A mistake in asperity itself. Please report it."""


class ModelWarning(UserWarning):
    """A model may not hold, or a result is less certain than it looks."""


class FailedCases(UserWarning):
    """Cases of a study could not be computed."""


# Their public place.
for _each in (AsperityError, BadInput, Failed, FileProblem, CaseError, InternalError, ModelWarning, FailedCases):
    _each.__module__ = "asperity.errors"
