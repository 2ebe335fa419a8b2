"""What is wrong, where, and the mend: the exceptions of this package."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input. Its message is complete; its parts are attributes.

    Attributes:
        file: the file, or the name a thing in memory goes by; empty where there is none.
        line: 1-based; 0 where the whole file, or something in memory, is meant.
        column: 1-based field of a log's line; 0 otherwise.
        key: the key of a scenario or model, dotted; empty where none is meant.
        value: the value as it was given; empty where it is missing.
        mend: what to do about it.

    """

    def __init__(
        self, message: str, file: str = "", line: int = 0, column: int = 0, key: str = "", value: str = "", mend: str = ""
    ) -> None:
        super().__init__(message)
        self.file, self.line, self.column, self.key, self.value, self.mend = file, line, column, key, value, mend

    def __reduce__(self) -> tuple[type[InputError], tuple[object, ...]]:
        return type(self), (str(self), self.file, self.line, self.column, self.key, self.value, self.mend)


class ScenarioError(InputError):
    """A scenario, rover or effect is wrong."""


class ModelError(InputError):
    """A model is wrong, or what was asked of it."""


class LogError(InputError):
    """A log or its map is wrong."""


class FileError(LogError):
    """A file cannot be opened, read or written."""


class Refused(InputError):
    """The log fails the check: nothing is learnt from it, unless `despite` names the findings."""


class CampaignError(InputError):
    """A campaign's specification or folder is wrong."""
