#!/usr/bin/env bash
# The wheel as a stranger gets it: written, looked at, installed without a network, asked.
#
#   wheel.sh SOURCE WORK PYTHON
set -euo pipefail
source=$1 work=$2 python=$3
cd -- "$source"
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }

wheel=$source/$(./run.sh wheel | tail -n 1)
[[ $wheel =~ /sinew-[0-9.]+-cp311-abi3-manylinux_2_[0-9]+_[a-z0-9_]+\.whl$ ]] || fail "the wheel's name is $wheel"
symbols=$(nm -D --defined-only build/wheel/python/sinew/_sinew.abi3.so | awk '{print $3}')
[[ $symbols == PyInit__sinew ]] || fail "the extension shows more than its entry: $symbols"
stable='_Py_(Dealloc|(None|True|False)Struct)|_PyArg_ParseTuple_SizeT|_PyObject_(Call(Function|Method)_SizeT|New)'
private=$(nm -D --undefined-only build/wheel/python/sinew/_sinew.abi3.so | awk '{print $2}' | grep '^_Py' | grep -vxE "$stable" || true)
[[ -z $private ]] || fail "the extension uses what is not of the stable ABI: $private"

# A bare environment: nothing of the build tree, no NumPy.
rm -rf -- "$work"
mkdir -p "$work"
"$python" -m venv "$work/bare"
"$work/bare/bin/pip" install -q --no-index --disable-pip-version-check "$wheel"
cd -- "$work"
run() { env -i PATH=/usr/bin:/bin HOME="$work" "$@"; }
run bare/bin/python -W error -B "$source/tests/python/no_numpy_test.py"
[[ $(run bare/bin/sinew --version) == "sinew "* ]] || fail "the command does not start"
run bare/bin/sinew sweep 3-rfr-workspace -o bare.h5 -q
[[ -s bare.h5 ]] || fail "the command writes no result"
loaded=$(LD_TRACE_LOADED_OBJECTS=1 bare/lib/python3.*/site-packages/sinew/bin/sinew |
         awk '$3 ~ /^\// {print $3}' | grep -v "/site-packages/sinew/" || true)
strange=$(grep -vE '/(ld-linux[^/]*|lib(c|m|dl|rt|util|pthread|resolv|anl|gcc_s|stdc\+\+))\.so' <<<"$loaded" || true)
[[ -z $strange ]] || fail "the command loads what is not in the wheel: $strange"
bare/bin/pip uninstall -q -y sinew
[[ ! -e bare/bin/sinew && -z $(find bare/lib/python3.*/site-packages -name 'sinew*') ]] || fail "something is left when it is uninstalled"

# With the system's NumPy: all tests.
"$python" -m venv --system-site-packages "$work/numpy"
numpy/bin/pip install -q --no-index --no-deps --disable-pip-version-check "$wheel"
for test in answers columns prepared docs pictures; do
  run numpy/bin/python -W error -B "$source/tests/python/${test}_test.py"
done
echo "passed: $wheel, $(stat -c %s "$wheel") bytes"
