"""Packages that only some functions need: the extras of pyproject.toml."""

from __future__ import annotations

import importlib
import sys
from typing import Any


def extra(module: str, name: str) -> Any:
    """A module that the extra `name` brings. Raises ImportError with the mend where it cannot be imported."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        mend = f"pip install './python[{name}]' in Traction's folder"
        raise ImportError(f"{sys.executable}: {module} cannot be imported ({error}); to mend: {mend}", name=module) from None
