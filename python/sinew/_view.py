"""The command `sinew`, which a wheel brings along, and its viewer."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from typing import TYPE_CHECKING, Any

from ._errors import InputError

if TYPE_CHECKING:
    from .robot import Robot


def command() -> str:
    """Path of the command: the one of this package, else the first on the path."""
    own = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "sinew")
    found = own if os.access(own, os.X_OK) else shutil.which("sinew")
    if not found:
        raise InputError("the command sinew is not there: it comes with the wheel, or install sinew and put it on the path",
                         "program_missing", "sinew")
    return found


def main() -> None:
    """The command `sinew` of the wheel."""
    try:
        program = command()
    except InputError as error:
        sys.exit(str(error))
    os.execv(program, ["sinew", *sys.argv[1:]])


def _in_notebook() -> bool:
    shell = sys.modules.get("IPython")
    running = shell.get_ipython() if shell else None
    return running is not None and "IPKernelApp" in getattr(running, "config", {})


class View:
    """The viewer that was started. `close()` ends it, as do the end of a `with` and the end of this program."""

    url: str
    """Where it is: `http://127.0.0.1:...`."""

    def __init__(self, robot: Robot, port: int, open_browser: bool) -> None:
        program = command()
        self._folder = tempfile.TemporaryDirectory(prefix="sinew-")
        self._is_frame = _in_notebook()
        arguments = [program, "serve", _source(robot, self._folder.name), "--port", str(port)] + ["--frame"] * self._is_frame
        for path, value in robot._settings.items():
            arguments += ["--set", f"{path}={value if isinstance(value, str) else json.dumps(value)}"]
        self._process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self._process.stdout and self._process.stderr
        self.url = self._process.stdout.readline().strip()
        self._readers: list[threading.Thread] = []
        if not self.url:
            told = self._process.stderr.read().strip()
            self.close()
            raise InputError(told or "the viewer did not start", "program_failed", "sinew serve")
        for stream in (self._process.stdout, self._process.stderr):  # read, so that the server never waits for a reader
            self._readers.append(threading.Thread(target=stream.read, daemon=True))
            self._readers[-1].start()
        if open_browser and not self._is_frame:
            import webbrowser
            webbrowser.open(self.url)

    def close(self) -> None:
        """Ends the viewer."""
        if self._process.poll() is None:
            self._process.terminate()
            self._process.wait()
        for reader in self._readers:
            reader.join()
        for stream in (self._process.stdout, self._process.stderr):
            if stream:
                stream.close()
        self._folder.cleanup()

    def __enter__(self) -> View:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __del__(self) -> None:
        if hasattr(self, "_readers"):
            self.close()

    def __repr__(self) -> str:
        return f"<the viewer at {self.url}>"

    def _repr_html_(self) -> str:
        return f'<iframe src="{self.url}" width="100%" height="600" style="border:0"></iframe>'


def _source(robot: Robot, folder: str) -> str:
    """The robot as an argument of the command: its name, or a file of it."""
    if robot._copy == robot._source and "\n" not in robot._copy and not robot._copy.startswith("{"):
        return robot._copy
    path = os.path.join(folder, "robot.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(robot._copy)
    return path
