#!/bin/sh
# Makes sure of what cargo alone cannot bring: a processor of x86-64-v3, a C compiler, and the two
# programs that build SUNDIALS' bindings, cmake and libclang. Uses what is there, else apt-get, else
# Python wheels in .tools (git-ignored). Paths that a plain `cargo build` needs afterwards go to
# .cargo/local.toml (git-ignored), which .cargo/config.toml includes.
set -eu
cd "$(dirname "$0")/.."

say() { echo "setup: $*" >&2; }
die() {
  say "$*"
  exit 1
}

# --- processor ---------------------------------------------------------------------------------

# .cargo/config.toml asks for x86-64-v3; on an older processor the program would die of an illegal instruction.
check_processor() {
  [ "$(uname -m)" = x86_64 ] && [ -r /proc/cpuinfo ] || return 0
  flags=" $(sed -n 's/^flags[[:space:]]*: //p' /proc/cpuinfo | head -n 1) "
  [ "$flags" != "  " ] || return 0
  missing=
  for flag in avx2 fma bmi2; do
    case "$flags" in *" $flag "*) ;; *) missing="$missing $flag" ;; esac
  done
  [ -z "$missing" ] || die "this processor lacks:$missing (x86-64-v3, about 2013 and later, is needed);" \
    "to build without, delete the line with target-cpu=x86-64-v3 from .cargo/config.toml"
}

# --- what is there -----------------------------------------------------------------------------

cmake_found() { cmake --version >/dev/null 2>&1; }

# Prints the path of libclang, searching where bindgen searches. libclang-cpp is another library, and
# llvm-config or even a clang program may be there without it.
find_libclang() {
  if [ -n "${LIBCLANG_PATH:-}" ]; then
    # exclusive for bindgen: if nothing is there, nothing else is searched
    places=$LIBCLANG_PATH
  else
    places="/usr/lib/llvm-*/lib /usr/lib/llvm*/lib64 /usr/lib/*-linux-gnu /usr/lib64 /usr/lib /usr/local/lib"
    if llvm=$(llvm-config --libdir 2>/dev/null); then places="$llvm $places"; fi
  fi
  for place in $places; do
    for file in "$place" "$place"/libclang.so "$place"/libclang.so.* "$place"/libclang-[0-9]*.so* "$place"/libclang.dylib; do
      case "$file" in
      *.so | *.so.* | *.dylib) if [ -f "$file" ]; then
        echo "$file"
        return 0
      fi ;;
      esac
    done
  done
  return 1
}

# Whether libclang's own headers (stddef.h, ...) lie beside it; its runtime package comes without them.
headers_found() {
  for header in "$(dirname "$1")"/clang/*/include/stddef.h "$(dirname "$(readlink -f "$1")")"/clang/*/include/stddef.h; do
    [ -f "$header" ] && return 0
  done
  return 1
}

# --- .cargo/local.toml -------------------------------------------------------------------------

# Bindgen reads C headers with libclang; where that lacks its own ones, the C compiler lends its.
lend_headers() { echo "BINDGEN_EXTRA_CLANG_ARGS = \"-I$("${CC:-cc}" -print-file-name=include)\""; }

native_found() {
  cmake_found && libclang=$(find_libclang) || return 1
  if headers_found "$libclang"; then
    rm -f .cargo/local.toml
  else
    { echo "[env]" && lend_headers; } >.cargo/local.toml
  fi
}

wheels_found() { [ -s .cargo/local.toml ] && .tools/cmake --version >/dev/null 2>&1 && [ -f .tools/libclang.so ]; }

# --- installing --------------------------------------------------------------------------------

as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo -n "$@"; fi; }

install_by_apt() {
  command -v apt-get >/dev/null 2>&1 && as_root true 2>/dev/null || return 1
  say "installing cmake and libclang-dev with apt-get (about 500 MB on disk)"
  {
    as_root apt-get update -q &&
      as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends cmake libclang-dev
  } >.tools/apt.log 2>&1 && native_found && return 0
  say "apt-get did not help (see .tools/apt.log)"
  return 1
}

install_wheels() {
  command -v python3 >/dev/null 2>&1 || return 1
  say "installing cmake and libclang from Python wheels into .tools (about 170 MB)"
  rm -rf .tools/wheels .tools/venv
  wheels="cmake==4.4.4 libclang==18.1.1"
  # shellcheck disable=SC2086
  {
    # a python3 without pip may still have venv, and the other way round
    python3 -m pip install -q --target .tools/wheels $wheels || {
      python3 -m venv .tools/venv && .tools/venv/bin/python -m pip install -q --target .tools/wheels $wheels
    }
  } >.tools/pip.log 2>&1 || {
    say "pip did not help (see .tools/pip.log)"
    return 1
  }
  rm -rf .tools/venv
  ln -sfn wheels/cmake/data/bin/cmake .tools/cmake
  ln -sfn wheels/clang/native/libclang.so .tools/libclang.so
  {
    echo "[env]"
    echo 'CMAKE = { value = ".tools/cmake", relative = true, force = true }'
    echo 'LIBCLANG_PATH = { value = ".tools", relative = true, force = true }'
    lend_headers
  } >.cargo/local.toml
  wheels_found
}

# -----------------------------------------------------------------------------------------------

check_processor
command -v "${CC:-cc}" >/dev/null 2>&1 || die "no C compiler found; install gcc and make (Debian: apt-get install gcc make)"
command -v cargo >/dev/null 2>&1 || die "no cargo found; install Rust 1.95 or later from https://rustup.rs"
if wheels_found || native_found; then exit 0; fi
mkdir -p .tools
if install_by_apt || install_wheels; then exit 0; fi
die "cmake and libclang are needed to build SUNDIALS and could not be installed; install them by hand" \
  "(Debian, Ubuntu: apt-get install cmake libclang-dev; Fedora: dnf install cmake clang-devel; macOS: brew install cmake llvm)" \
  "or give this machine python3 with pip or venv, and run make again"
