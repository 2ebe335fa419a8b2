"""Where the scenarios, models and rovers are that Traction ships."""

from __future__ import annotations

import os
from pathlib import Path

_FOLDERS = ("scenarios", "models", "rovers")


def roots() -> list[Path]:
    """Folders that may hold scenarios/, models/ and rovers/: $TRACTION_ROOT, then the package's own."""
    given = os.environ.get("TRACTION_ROOT")
    return ([Path(given)] if given else []) + [Path(__file__).parent / "data"]


def find(name: str | os.PathLike[str], folder: str) -> str:
    """The file meant by a path, or by the name of a shipped one ("cruise", "scenarios/cruise.toml").

    What is found nowhere is returned as it was given: whoever opens it says so, with the name the user wrote.
    """
    if folder not in _FOLDERS:
        raise ValueError(f"folder: {folder!r} is none of {_FOLDERS}")
    text = os.fspath(name)
    if os.path.exists(text) or os.path.isabs(text):
        return text
    for root in roots():
        for candidate in (root / text, root / folder / text, root / folder / f"{text}.toml"):
            if candidate.is_file():
                return str(candidate)
    return text


def find_map(name: str | os.PathLike[str] | None) -> str:
    """The map meant by a path, or by the name of a shipped one ("robotino"); empty for None."""
    if name is None:
        return ""
    text = os.fspath(name)
    shipped = find(f"models/maps/{text}.toml", "models")
    return text if os.path.exists(text) or not os.path.isfile(shipped) else shipped
