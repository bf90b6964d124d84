"""What every table of the file has in common."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict, model_validator
from pydantic_core import PydanticCustomError


def key_error(key: str, message: str) -> PydanticCustomError:
    """An error of a table that belongs to one of its keys."""
    return PydanticCustomError("key_error", "{message}", {"key": key, "message": message})


class Table(BaseModel):
    """A table of the file; a key that it does not know is an error that names the nearest it does know."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    @model_validator(mode="before")
    @classmethod
    def _only_known_keys(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            raise PydanticCustomError("dict_type", "is not a table of keys and values")
        for key in data:
            if key not in cls.model_fields:
                raise PydanticCustomError("unknown_key", "{key}", {"key": key, "known": list(cls.model_fields)})
        return data
