"""Exceptions of bad input, with the library's own sentences."""
import json
import re
from typing import Any


class InputError(ValueError):
    """What was given is not a robot, a question or an array that sinew can read.

    The sentence names the place, what was found, the rule, and the way out. A question that has no solution is no
    error: its answer says so in `status` and `message`.
    """

    code: str
    """One word for programs, of the list in docs/protocol.md: `missing_key`, `out_of_range`, ..."""
    where: str
    """The field (`inputs[1]`), or the line of a file (`mine.yaml:14:11`)."""
    message: str
    """The library's sentence, or a line for each thing that is wrong."""

    def __init__(self, message: str, code: str = "bad_input", where: str = "") -> None:
        super().__init__(message)
        self.message, self.code, self.where = message, code, where

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.message, self.code, self.where)


def from_text(text: str, hint: str = "") -> InputError:
    """Of what the library wrote: the JSON of an answer, to which a hint may be added, or lines `where: sentence [code]`."""
    if text.startswith("{"):
        try:
            error = json.loads(text)["error"]
        except (ValueError, LookupError):  # a line, of a path that begins so
            return InputError(text)
        return InputError(error.get("message", text) + hint, error.get("code", "bad_input"), error.get("where", ""))
    line = re.match(r"(?P<where>.+?): .*\[(?P<code>\w+)\]$", text.splitlines()[0] if text else "")
    if not line:
        return InputError(text)
    return InputError(re.sub(r" \[\w+\]$", "", text, flags=re.M), line["code"], line["where"])
