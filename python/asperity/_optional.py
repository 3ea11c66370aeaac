"""Packages that are used where they are installed."""

from __future__ import annotations

import importlib
from typing import Any


def need(module: str, purpose: str) -> Any:
    """Import a module, or raise an error that says how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.split(".")[0]
        message = f"{purpose} needs {package}, which is not installed: pip install {package}"
        raise ModuleNotFoundError(message, name=package) from error
