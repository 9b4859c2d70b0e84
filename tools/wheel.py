#!/usr/bin/env python3
"""Packs the Python module and the command of a build tree into a wheel, with the standard library alone.

usage: wheel.py BUILD FOLDER

BUILD is a tree of the preset `wheel`. Libraries that a bare system does not have go along, in sinew/lib, where the
programs look for them first, each with the licence that its Debian package has. The wheel serves CPython 3.11 and later.
"""
import base64
import hashlib
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
# What every system with this glibc has: those of glibc and of the compiler.
OF_THE_SYSTEM = re.compile(r"(ld-linux.*|linux-vdso|lib(c|m|dl|rt|util|pthread|resolv|anl|gcc_s|stdc\+\+))\.so.*")
EPOCH = (1980, 1, 1, 0, 0, 0)  # the same bytes from the same files


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def libraries(program):
    """Name and path of each library that a program loads and a system may lack."""
    found = dict(re.findall(r"^\s*(\S+) => (/\S+)", output("ldd", program), flags=re.M))
    return {name: pathlib.Path(path) for name, path in found.items() if not OF_THE_SYSTEM.fullmatch(name)}


def needed_glibc(programs):
    versions = [(0, 0)]
    for program in programs:
        versions += [(int(major), int(minor)) for major, minor in re.findall(r"GLIBC_(\d+)\.(\d+)", output("objdump", "-T", program))]
    return max(versions)


def licence_of(library):
    """Package and text; a wheel passes both on. Files of /usr are known to dpkg by /lib, too."""
    real = library.resolve()
    for path in (library, real, pathlib.Path(str(real).removeprefix("/usr"))):
        owner = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True)
        if owner.returncode == 0:
            package = owner.stdout.split(":")[0]
            text = pathlib.Path("/usr/share/doc") / package / "copyright"
            if text.exists():
                return package, text.read_bytes()
    sys.exit(f"{library}: no licence found that goes with it")


def metadata(version):
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    return f"""Metadata-Version: 2.1
Name: sinew
Version: {version}
Summary: Fast, honest mechanics of continuum robots: robots whose bodies bend
License-File: LICENSE
Requires-Python: >=3.11
Provides-Extra: arrays
Requires-Dist: numpy; extra == "arrays"
Provides-Extra: plot
Requires-Dist: matplotlib; extra == "plot"
Classifier: Programming Language :: Python :: 3
Classifier: Operating System :: POSIX :: Linux
Classifier: Topic :: Scientific/Engineering
Description-Content-Type: text/markdown

{readme}"""


def stage(build, folder):
    """The package as it is installed; its programs."""
    package = folder / "sinew"
    shutil.copytree(build / "python" / "sinew", package, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("bin", "lib"):
        (package / name).mkdir()
    programs = [package / "_sinew.abi3.so", package / "bin" / "sinew"]
    shutil.copy2(build / "bin" / "sinew", programs[1])
    needed = libraries(build / "python" / "sinew" / "_sinew.abi3.so") | libraries(build / "bin" / "sinew")
    licences = {}
    for name, path in sorted(needed.items()):
        shutil.copyfile(path.resolve(), package / "lib" / name)
        owner, text = licence_of(path)
        licences[owner] = text
        programs.append(package / "lib" / name)
    for program in programs:
        program.chmod(0o755)
        subprocess.run(["strip", "--strip-unneeded", program], check=True)
    return programs, licences


def record_row(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def write(path, folder, information):
    """A zip of the package and of dist-info, RECORD last."""
    entries = {str(file.relative_to(folder)): (file.read_bytes(), file.stat().st_mode)
               for file in sorted(folder.rglob("*")) if file.is_file()}
    entries |= {name: (data, 0o100644) for name, data in information.items()}
    record = next(iter(information)).split("/")[0] + "/RECORD"
    rows = "".join(record_row(name, data) for name, (data, _) in entries.items()) + record + ",,\n"
    entries[record] = rows.encode(), 0o100644
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, (data, mode) in entries.items():
            entry = zipfile.ZipInfo(name, EPOCH)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, mode << 16
            archive.writestr(entry, data)


def main():
    build, target = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    version = re.search(r"^CMAKE_PROJECT_VERSION:\w+=(\S+)", (build / "CMakeCache.txt").read_text(), re.M).group(1)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        programs, licences = stage(build, folder)
        major, minor = needed_glibc(programs)
        tag = f"cp311-abi3-manylinux_{major}_{minor}_{platform.machine()}"
        info = f"sinew-{version}.dist-info"
        information = {
            f"{info}/METADATA": metadata(version).encode(),
            f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: sinew\nRoot-Is-Purelib: false\nTag: {tag}\n".encode(),
            f"{info}/entry_points.txt": b"[console_scripts]\nsinew = sinew._view:main\n",
            f"{info}/LICENSE": (ROOT / "LICENSE").read_bytes(),
        } | {f"{info}/licences/{owner}": text for owner, text in licences.items()}
        target.mkdir(parents=True, exist_ok=True)
        for old in target.glob("sinew-*.whl"):
            old.unlink()
        path = target / f"sinew-{version}-{tag}.whl"
        write(path, folder, information)
    print(path)


main()
