#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Installs a wheel into a virtual environment, without an index, and uses it: a tree from four tripods as LAZ and a picture, the catalogue, the
# module, and what is said where NumPy is missing. Usage: check_wheel.sh WHEEL FOLDER [PYTHON]; WHEEL is a file, or
# a folder with one; FOLDER is emptied.
set -eu
wheel=$(realpath "$(find "$1" -name 'pulsecast-*.whl')") folder=$2 python=${3:-/usr/bin/python3}
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
unset PYTHONPATH
export XDG_CACHE_HOME="$PWD/cache" PYTHONDONTWRITEBYTECODE=1
fail() {
  echo "$*"
  exit 1
}

cat > tree.obj <<'OBJ'
v -0.2 -0.2 0
v 0.2 -0.2 0
v 0.2 0.2 0
v -0.2 0.2 0
v 0 0 6
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
v -20 -20 0
v 20 -20 0
v 20 20 0
v -20 20 0
f 6 7 8 9
OBJ
legs=
for place in 'x="8" y="0"' 'x="0" y="8"' 'x="-8" y="0"' 'x="0" y="-8"'; do
  legs="$legs<leg><platformSettings $place z=\"0\"/><scannerSettings pulseFreq_hz=\"100000\" scanFreq_hz=\"50\" headRotatePerSec_deg=\"60\" headRotateStop_deg=\"360\"/></leg>"
done
cat > tree.xml <<XML
<document>
  <scene id="tree" name="tree"><part id="1"><filter type="objloader"><param type="string" key="filepath" value="tree.obj"/></filter></part></scene>
  <survey name="tree" scene="#tree" platform="data/platforms.xml#tripod" scanner="data/scanners_tls.xml#riegl_vz400" seed="1">$legs</survey>
</document>
XML

start=$(date +%s)
"$python" -m venv --system-site-packages v
v/bin/pip install --quiet --no-index "$wheel"
v/bin/pulsecast tree.xml --format laz --output out --quiet
echo "the first points after $(($(date +%s) - start)) s"
[ "$(find out -name '*_points.laz' -size +10k | wc -l)" = 4 ] || fail "expected a LAZ file with points from each of four tripods: $(find out)"
v/bin/pulsecast preview tree.xml --output out --quiet
[ -s out/tree_preview.png ] || fail "there is no picture"

v/bin/python -c '
import pulsecast
[folder] = pulsecast.asset_folders()
assert folder.is_relative_to(pulsecast.__path__[0]), folder
survey = pulsecast.read_survey("tree.xml")
points = pulsecast.Simulation(survey, assets=["."]).run().points
print(len(points), "points")
assert len(points) > 10_000 and points["z"].max() > 3
'
v/bin/python -m pulsecast doctor > doctor
cat doctor
grep -q "^catalogue .*pulsecast/share/pulsecast: [1-9]" doctor || fail "doctor finds no catalogue"
grep -q "^Python .*, NumPy [1-9]" doctor || fail "doctor does not tell of NumPy"
grep -q "^formats *xyz, xyz.gz, las, laz, copc.laz, ply, pcd, npz, kitti, mcap, ptx$" doctor || fail "doctor misses a format"

# Nothing of a carried library comes from the system, and each has its licence.
package=$(v/bin/python -c 'import importlib.util; print(importlib.util.find_spec("pulsecast").submodule_search_locations[0])')
for file in "$package"/_core.*.so "$package/bin/pulsecast" $(find "$package/lib" -name '*.so*' ! -name 'pulsecast-reference.so'); do
  ! ldd "$file" | grep -F 'not found' || fail "$file lacks the libraries above"
  ldd "$file" | sed -nE 's/^[[:space:]]*(\S+) => (\S+) .*/\1 \2/p' | grep -vE "^lib(c|m|gcc_s|stdc\+\+|z|expat)\.so|$package/" && fail "$file loads the above from the system"
done
[ "$(find "$package/licences" -type f | wc -l)" -ge "$(find "$package/lib/carried" -type f | wc -l)" ] || fail "licences are missing"
[ -s v/share/man/man1/pulsecast.1 ] || fail "there is no man page"

"$python" -m venv bare
bare/bin/pip install --quiet --no-index --no-deps "$wheel"
if ! bare/bin/python -c 'import numpy' 2> /dev/null; then
  bare/bin/python -c 'import pulsecast' 2> message && fail "without NumPy, the module can be imported"
  tail -n 1 message | grep -q '^ImportError: pulsecast needs NumPy: expected the Debian package python3-numpy' || fail "without NumPy: $(cat message)"
  bare/bin/pulsecast doctor | grep -q '^Python .*missing: NumPy' || fail "doctor does not miss NumPy"
fi
echo "the wheel works"
