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

# ThreadSanitizer sees what TBB's threads wait for only if TBB is built with it, too: without that it reports races between
# a task and whoever waited for it. The source is that of Debian 12's package.
instrumented_tbb() {
  local version=2021.8.0 sum=7e9111b8bb59c8800bf6d0b06afe7b0891937443d2dae1ee1101c8e2ede6a7ef folder=$PWD/build/tsan-tbb
  if [[ ! -e $folder/lib/libtbb.so.12 ]]; then
    mkdir -p "$folder/lib" && python3 - "https://deb.debian.org/debian/pool/main/o/onetbb/onetbb_$version.orig.tar.xz" "$folder/source.tar.xz" <<'PYTHON' &&
import sys, urllib.request
urllib.request.urlretrieve(*sys.argv[1:])
PYTHON
      echo "$sum  $folder/source.tar.xz" | sha256sum --check --quiet && tar -xf "$folder/source.tar.xz" -C "$folder" &&
      cmake -S "$folder/oneTBB-$version" -B "$folder/build" -G Ninja -D CMAKE_BUILD_TYPE=RelWithDebInfo -D TBB_TEST=OFF -D TBB_STRICT=OFF \
        -D TBBMALLOC_BUILD=OFF -D TBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON -D CMAKE_CXX_FLAGS="-fsanitize=thread -O1 -g1" &&
      cmake --build "$folder/build" --target tbb --parallel "$(nproc)" && cp -P "$folder"/build/gnu*/libtbb.so.12* "$folder/lib/" || return 1
  fi
  export LD_LIBRARY_PATH=$folder/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
}

# HDF5's own threads and their start are not ours to judge, nor is Embree.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1 TSAN_OPTIONS=report_signal_unsafe=0:suppressions=$PWD/tools/tsan.supp
worst=0
for preset in "${presets[@]}"; do
  if [[ $preset == tsan ]] && ! instrumented_tbb; then
    echo "$0: TBB could not be built with ThreadSanitizer; its source is had from deb.debian.org" >&2
    exit 1
  fi
  cmake --preset "$preset" -D PETZVAL_UNITY_BUILD=ON && cmake --build --preset "$preset" --parallel "$(nproc)" &&
    ctest --preset "$preset" --timeout 3600 "$@" || worst=1
done
exit "$worst"
