"""Raising of exceptions, and warnings."""

from __future__ import annotations

import os
import sys
import warnings
from typing import Any

from . import errors


def warn(texts: list[str], category: type[UserWarning] = errors.ModelWarning) -> None:
    """Warns of each text at the line that called asperity."""
    package = os.path.dirname(__file__)
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(package):
        level, frame = level + 1, frame.f_back
    for text in texts:
        warnings.warn(text, category, stacklevel=level)


class Warner:
    """Warns of each text once, at the line that called asperity."""

    def __init__(self) -> None:
        self._texts: set[str] = set()

    def __call__(self, text: str) -> None:
        """Warn of a text that is new."""
        self.all([text])

    def all(self, texts: list[str]) -> None:
        """Warn of the texts that are new."""
        new = [text for text in texts if text not in self._texts]
        self._texts.update(new)
        warn(new)


def bad_input(key: str, message: str, hint: str | None = None) -> errors.AsperityError:
    """Makes the exception of an invalid argument, to be raised."""
    return exception("CaseError", message, {"key": key}, hint)


def exception(name: str, message: str, attributes: dict[str, Any], hint: str | None) -> errors.AsperityError:
    """Makes the exception of that name. The compiled module calls it."""
    if name == "File" and attributes.get("errno") == 2:
        name = "MissingFile"
    error: errors.AsperityError = getattr(errors, name)(message)
    for key, value in attributes.items():
        setattr(error, key, str(value) if isinstance(value, os.PathLike) else value)
    if hint is not None:
        error.hint = hint
        # From Python 3.11 on tracebacks show them.
        error.__dict__["__notes__"] = [f"hint: {hint}"]
    return error
