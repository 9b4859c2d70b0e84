"""How far a question is that takes long, told while it is answered."""
from __future__ import annotations

import json
import sys
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ._errors import InputError
from .answer import Record

if TYPE_CHECKING:
    from ._sinew import Session

_SECONDS = 0.1  # between looks


def _say(now: Record) -> None:
    print(f"\r{now.part}, step {now.steps}, error {1e3 * now.error:.3g} mm\033[K", end="", file=sys.stderr, flush=True)


def _is_terminal() -> bool:
    try:
        return sys.stderr is not None and sys.stderr.isatty()
    except ValueError:  # closed
        return False


class Watch:
    """While it is entered, a thread tells `progress` how far `session` is. What that raises stops the question, and is raised in its place."""

    def __init__(self, session: Session, progress: Any) -> None:
        if progress is not None and not isinstance(progress, bool) and not callable(progress):
            raise InputError(f"progress is a function of one argument, or True or False; found {type(progress).__name__}", "wrong_type", "progress")
        self._session = session
        self._tell: Callable[[Record], Any] | None = progress if callable(progress) else _say if (_is_terminal() if progress is None else progress) else None
        self._is_over = threading.Event()
        self._raised: BaseException | None = None
        self._thread: threading.Thread | None = None
        self._last = ""

    def _look(self) -> None:
        while not self._is_over.wait(_SECONDS):
            text = self._session.progress()
            if text == self._last or self._tell is None:
                continue
            self._last = text
            now = json.loads(text)
            if "steps" not in now:
                continue
            try:
                self._tell(Record({key: now[key] for key in ("part", "steps", "error")}))
            except BaseException as error:
                self._raised = error
                self._session.stop()
                return

    def __enter__(self) -> Watch:
        if self._tell is not None:
            self._thread = threading.Thread(target=self._look, name="sinew progress", daemon=True)
            self._thread.start()
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self._is_over.set()
        if self._thread is None:
            return
        self._thread.join()
        if self._tell is _say and self._last:
            print("\r\033[K", end="", file=sys.stderr, flush=True)
        if self._raised is not None and error is None:
            raise self._raised
