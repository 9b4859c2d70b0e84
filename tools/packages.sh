# shellcheck shell=bash
# Debian packages and quiet builds, shared by run.sh, test.sh and .ci/run. Sourced, never run.
# All messages go to stderr: stdout belongs to the command that is being run.

# What building the library and the command and drawing figures needs, ...
# shellcheck disable=SC2034
build_packages=(build-essential cmake ninja-build pkgconf libeigen3-dev libyaml-cpp-dev nlohmann-json3-dev libcli11-dev
                libfmt-dev libexpected-dev libhwy-dev libtbb-dev libhdf5-dev libmd-dev libxxhash-dev libcpp-httplib-dev gnuplot-nox)
# ... what building the page of the viewer needs, ...
web_packages=(nodejs npm)
# ... what the Python module needs beside the first, ...
# shellcheck disable=SC2034
python_packages=(python3 libpython3-dev)
# ... what the tests under sanitizers need: clang compiles instrumented code in half of GCC's time, ...
# shellcheck disable=SC2034
sanitizer_packages=(clang lld libclang-rt-14-dev)
# ... what planning needs (sinew::plan, which is left out without it), ...
# shellcheck disable=SC2034
plan_packages=(libfcl-dev libassimp-dev)
# ... what the module of Octave needs, ...
octave_packages=(octave octave-dev)
# ... what the notebooks need (python3-munkres is in the place of python3-scipy, which python3-matplotlib would bring along), ...
notebook_packages=(python3-matplotlib python3-munkres python3-nbconvert python3-ipykernel)
# ... and what the tests and benchmarks need beside it. ccache saves compiling the library again for the packaging tests.
# Doxygen and Sphinx make the reference of the C++ interface and the site. Last, what builds and runs the firmware: the cross
# compilers of ATmega2560 and Cortex-M with their simulators, the tools of the Verilog core, and a browser.
# shellcheck disable=SC2034
test_packages=(libgtest-dev libgmock-dev librapidcheck-dev libbenchmark-dev python3 python3-jsonschema
               doxygen python3-sphinx python3-myst-parser "${notebook_packages[@]}"
               python3-yaml python3-h5py python3-numpy libpython3-dev python3-venv mypy ccache libopenmpi-dev openmpi-bin
               gcc-avr avr-libc libsimavr-dev gcc-arm-none-eabi qemu-system-arm verilator yosys "${octave_packages[@]}" "${web_packages[@]}" chromium-headless-shell)

say() { printf '%s\n' "$*" >&2; }

# is_present PACKAGE: installed, or another package already does its work.
is_present() {
  case $1 in
    gnuplot-nox) command -v gnuplot >/dev/null && return ;;
    pkgconf) command -v pkg-config >/dev/null && return ;;
    nodejs) command -v node >/dev/null && return ;;
    npm) command -v npm >/dev/null && return ;;
  esac
  [[ $installed_packages == *$'\n'"$1"$'\n'* ]]
}

# need_packages YES PACKAGE...: installs those that are missing. YES=1, or no terminal: without asking.
need_packages() {
  local yes=$1 package answer log sudo=""
  local -a missing=() as_root=() apt
  shift
  if ! command -v dpkg-query >/dev/null; then
    say "This is not a Debian system: no packages were checked. Needed are the equivalents of: $*"
    return 0
  fi
  installed_packages=$'\n'$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
                            sed -n 's/^installed //p' || true)$'\n'
  for package; do is_present "$package" || missing+=("$package"); done
  ((${#missing[@]})) || return 0

  if (($(id -u) != 0)) && command -v sudo >/dev/null; then
    sudo="sudo "
    as_root=(sudo)
    [[ -t 0 ]] || as_root=(sudo -n)  # nobody is there to type a password
  fi
  say "Missing Debian packages: ${missing[*]}"
  say "  ${sudo}apt-get update"
  say "  ${sudo}apt-get install -y --no-install-recommends ${missing[*]}"
  if (($(id -u) != 0)) && [[ -z $sudo ]]; then
    say "Installing needs root, and there is no sudo here: run the two lines above as root, then this script again."
    return 1
  fi
  if ((!yes)) && [[ -t 0 && -t 2 ]]; then
    read -r -p "Install them now? [y/N] " answer
    if [[ $answer != [yY]* ]]; then
      say "Nothing was installed. Run the two lines above, then this script again."
      return 1
    fi
  fi
  apt=(env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300)
  log=build/packages.log
  mkdir -p build
  : >"$log"
  # A list that cannot be refreshed (a mirror is down) may still be good enough to install from.
  "${as_root[@]}" "${apt[@]}" update </dev/null >>"$log" 2>&1 || say "apt-get update failed (see $log); going on"
  run_logged "installing ${#missing[@]} packages" "$log" \
    "${as_root[@]}" "${apt[@]}" install -y --no-install-recommends "${missing[@]}"
}

# run_logged WHAT LOG COMMAND...: output goes to the end of LOG. Says WHAT and the seconds, or why it failed.
run_logged() {
  local what=$1 log=$2 start=$SECONDS status=0
  shift 2
  "$@" </dev/null >>"$log" 2>&1 || status=$?
  if ((status)); then
    {
      grep -nE '(^|[ :])(fatal )?error:|CMake Error|^E: |undefined reference|\*\*\*' "$log" | head -n 20 || true
      echo "--- end of $log:"
      tail -n 25 "$log"
      echo "--- $what failed; the whole log is $PWD/$log"
    } >&2
    return "$status"
  fi
  say "$what: $((SECONDS - start)) s"
}

# quick_tools: Ninja and ccache where they are installed, for trees not configured yet. Nothing needs them.
quick_tools() {
  if command -v ninja >/dev/null; then
    export CMAKE_GENERATOR=${CMAKE_GENERATOR-Ninja}
  fi
  if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
    export CCACHE_DEPEND=1  # the compiler's own list of headers, so that nothing is preprocessed twice
    # one cache for all checkouts, where ccache keeps it by itself; objects do not depend on where a checkout is
    export CCACHE_BASEDIR=${CCACHE_BASEDIR-$PWD} CCACHE_NOHASHDIR=1
    [[ -n ${HOME-} || -n ${CCACHE_DIR-} ]] || export CCACHE_DIR=$PWD/build/ccache
  fi
}

# build_preset PRESET [ARGUMENTS]: configures build/PRESET (with more arguments for cmake) and builds it, one at a time.
build_preset() {
  local preset=$1 log=build/$1.log
  mkdir -p build
  : >"$log"
  quick_tools
  say "building build/$preset (log: $log) ..."
  run_logged "configuring $preset" "$log" cmake --preset "$@" || return
  run_logged "building $preset" "$log" cmake --build --preset "$preset" --parallel "$(nproc)"
}
