#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds with AddressSanitizer and UndefinedBehaviorSanitizer (preset asan) and with ThreadSanitizer (tsan), runs the
# tests in each, and ends with 1 if anything was found. Hours on two cores.
#   tools/run_sanitizers.sh [--only asan|tsan] [ctest options, e.g. -R '^numeric\.']
set -uo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.."

presets=(asan tsan)
if [[ ${1-} == --only ]]; then
  case "${2-}" in
    asan | tsan) presets=("$2") ;;
    *)
      echo "usage: $0 [--only asan|tsan] [ctest options]" >&2
      exit 2
      ;;
  esac
  shift 2
fi

# HDF5's and TBB's own threads and their start are not ours to judge.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1 TSAN_OPTIONS=report_signal_unsafe=0
worst=0
for preset in "${presets[@]}"; do
  cmake --preset "$preset" -D PETZVAL_UNITY_BUILD=ON && cmake --build --preset "$preset" --parallel "$(nproc)" &&
    ctest --preset "$preset" --timeout 3600 "$@" || worst=1
done
exit "$worst"
