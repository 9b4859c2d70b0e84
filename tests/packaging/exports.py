"""That a shared library exports what headers declare, and nothing else: exports.py LIBRARY HEADERS

Of C it exports the functions of sinew.h, all of them; of C++ names that stand in an installed header.
"""
import pathlib
import re
import subprocess
import sys


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


def is_declared(name, words):
    parts = name.split("::")
    return parts[:2] == ["sinew", "v1"] and all(part.lstrip("~") in words for part in parts[2:] if re.fullmatch(r"~?\w+", part))


def main():
    library, headers = sys.argv[1], pathlib.Path(sys.argv[2])
    listed = subprocess.run(["nm", "--dynamic", "--defined-only", "--demangle", library], capture_output=True, text=True, check=True)
    names = [line.split(" ", 2)[2] for line in listed.stdout.splitlines()]
    of_c = {name for name in names if re.fullmatch(r"sinew_\w+", name)}
    of_cpp = [function_of(name) for name in names if name not in of_c]

    declared = set(re.findall(r"^SINEW_C_API .*?(sinew_\w+)\(", (headers / "sinew.h").read_text(), re.M))
    if of_c != declared:
        sys.exit(f"sinew.h declares {sorted(declared)}; exported are {sorted(of_c)}")
    texts = "\n".join(path.read_text() for path in headers.rglob("*.hpp"))
    words = set(re.findall(r"[A-Za-z_]\w*", re.sub(r"//.*", "", texts)))
    strange = sorted({name for name in of_cpp if not is_declared(name, words)})
    if strange or not of_cpp:
        sys.exit("exported, and in no header that is installed:\n  " + "\n  ".join(strange))
    print(f"exported: {len(of_c)} functions of C, {len(of_cpp)} names of C++ that installed headers declare, no others")


main()
