"""What a machine folder chooses where drives differ."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import StrEnum

from hli_bench.base.errors import InputError


class FollowingErrorReaction(StrEnum):
    """What leaving the window 0x6065 for longer than 0x6066 does beside statusword bit 13."""

    FAULT = "fault"
    STATUS = "status"


@dataclass(frozen=True, slots=True)
class DriveOptions:
    """What a machine folder chooses where drives differ. A window of 0 always means off (decided here)."""

    following_error: FollowingErrorReaction = FollowingErrorReaction.FAULT

    @classmethod
    def from_mapping(cls, options: Mapping[str, object], drive: str = "") -> "DriveOptions":
        """Return the options of a table of words. Raises InputError for unknown keys and values."""
        known = [field.name for field in fields(cls)]
        for key in options:
            if key not in known:
                raise InputError(f"drive {drive}: option {key!r} is none of {', '.join(known)}")
        word = options.get("following_error", FollowingErrorReaction.FAULT)
        if word not in list(FollowingErrorReaction):
            allowed = ", ".join(FollowingErrorReaction)
            raise InputError(f"drive {drive}: following_error = {word!r} is none of {allowed}")
        return cls(FollowingErrorReaction(str(word)))
