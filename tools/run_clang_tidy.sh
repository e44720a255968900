#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the checks of .clang-tidy and ends with 1 if they find anything. Without words: over the sources that changed within
# the two hours before the newest commit, or are not committed yet.
#   tools/run_clang_tidy.sh [--all | --since COMMIT | FILE...]
set -euo pipefail
project=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.." && pwd)

clang_tidy=$(command -v clang-tidy-14 || command -v clang-tidy) || {
  echo "clang-tidy is missing: apt install clang-tidy" >&2
  exit 2
}
# Only the commands that would compile are needed, of a build of single files.
cmake -S "$project" -B "$project/build/tidy" -G Ninja -D CMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
exec python3 "$project/tests/architecture/clang_clean.py" tidy "$project" "$project/build/tidy" "$clang_tidy" "$@"
