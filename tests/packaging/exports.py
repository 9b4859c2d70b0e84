"""What of C++ a shared library exports beyond what headers declare: exports.py LIBRARY INSTALLED_HEADERS SOURCES

A name has to stand in an installed header, or in a header of the sources that marks it with SINEW_API: the libraries of
studies and plans, which are built with it, use those.
"""
import pathlib
import re
import subprocess
import sys


def words_of(folder, is_fit=lambda text: True):
    texts = (path.read_text() for path in sorted(pathlib.Path(folder).rglob("*.h*")))
    return set(re.findall(r"[A-Za-z_]\w*", "\n".join(re.sub(r"//.*", "", text) for text in texts if is_fit(text))))


def function_of(symbol):
    """`sinew::v1::Batch::run` of its whole signature."""
    symbol = re.sub(r"^(vtable|typeinfo name|typeinfo|guard variable|VTT) for ", "", symbol)
    depth, name = 0, ""
    for c in symbol:
        if c == "<":
            depth += 1
        elif c == ">":
            depth -= 1
        elif c == "(" and depth == 0:
            break
        elif depth == 0:
            name += c
    return name.replace("[abi:cxx11]", "").split(" ")[-1]


def main():
    library, installed, sources = sys.argv[1:]
    listed = subprocess.run(["nm", "--dynamic", "--defined-only", "--demangle", library], capture_output=True, text=True, check=True)
    public, marked = words_of(installed), words_of(sources, lambda text: "SINEW_API" in text)
    count, inner, strange = 0, 0, []
    for line in listed.stdout.splitlines():
        name = function_of(line.split(" ", 2)[2])
        if not name.startswith("sinew::v1::"):
            continue
        count += 1
        words = [word.lstrip("~") for word in name.split("::")[2:] if re.fullmatch(r"~?\w+", word)]
        if all(word in public for word in words):
            continue
        inner += 1
        if not all(word in public | marked for word in words):
            strange.append(name)
    if strange or count == 0:
        sys.exit("exported, and in no header that marks it:\n  " + "\n  ".join(sorted(set(strange))))
    print(f"{count} symbols of C++, {inner} of them of headers that are not installed")


main()
