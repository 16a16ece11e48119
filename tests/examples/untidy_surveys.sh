#!/bin/sh
# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

# Runs surveys as they lie around: each has one thing that is odd, runs to its end with points, and gets a note that names file and line.
# With --strict the note is an error, and nothing is left. Usage: untidy_surveys.sh PROGRAM FOLDER, where FOLDER is emptied.
set -u
export LC_ALL=C
program=$1 folder=$2
rm -rf "$folder"
mkdir -p "$folder/tidy/spectra" "$folder/outside" || exit 2
cd "$folder" || exit 2
export XDG_CACHE_HOME="$folder/cache"

# The tidy survey, of which each case changes a line or a file.
cat > tidy/survey.xml << 'END'
<?xml version="1.0" encoding="UTF-8"?>
<document>
  <scanner id="mirror" optics="rotating" pulseFreqs_Hz="2000" scanAngleMax_deg="60" scanFreqMax_Hz="100" headRotatePerSecMax_deg="180">
    <rangeError expr="0.001*THETA"/>
  </scanner>
  <platform id="stand" type="static"><scannerMount z="1.5"/></platform>
  <scene id="yard" dynTimeStep="0.1">
    <part id="1"><filter type="objloader"><param type="string" key="filepath" value="yard.obj"/></filter></part>
    <part id="2">
      <filter type="xyzloader">
        <param type="string" key="filepath" value="hedge.xyz"/>
        <param type="double" key="voxelSize" value="0.5"/>
      </filter>
      <dmotion id="turn" loop="0"><motion type="rotation" axis="0;0;1" angle="1"/></dmotion>
    </part>
  </scene>
  <survey name="untidy" seed="1" scene="#yard" platform="#stand" scanner="#mirror">
    <leg maxDuration_s="0.2">
      <platformSettings x="0" y="0" z="0"/>
      <scannerSettings scanFreq_hz="20" headRotatePerSec_deg="90" headRotateStop_deg="10"/>
    </leg>
  </survey>
</document>
END
printf 'mtllib yard.mtl\nv -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\nusemtl lawn\nf 1 2 3 4\n' > tidy/yard.obj
printf 'newmtl lawn\nKd 0.5 0.5 0.5\nhelios_spectra turf\n' > tidy/yard.mtl
printf '0 5 0.2 0 0 1\n0 6 0.2 0 0 1\n' > tidy/hedge.xyz
printf '0.5 0.2\n1.5 0.4\n' > tidy/spectra/turf.txt
printf '0,0,0,0,0,0,5\n0.1,0,0,0,1,0,5\n0.1,0,0,0,8,0,5\n0.2,0,0,0,9,0,5\n' > tidy/jump.trj
printf '<document><platform id="far" type="static"/></document>\n' > outside/more.xml

failures=0
fail() {
  echo "$name: $1"
  sed 's/^/  /' said
  failures=$((failures + 1))
}

# Runs a survey: run COMMAND [OPTION...]. What it says is in `said`, without the folder.
run() {
  (cd case && "$program" "$@" "$folder/case/survey.xml" --threads 1 --output ../output) > told 2>&1
  status=$?
  sed "s|$PWD/||g" told > said
}

has_points() { find output -name '*_points.xyz' -size +0 2> /dev/null | grep -q .; }

# One case: untidy NAME FILE SED NOTE, where SED edits the file, and NOTE is what the note must begin with.
untidy() {
  name=$1
  rm -rf case output
  cp -r tidy case
  sed -i "$3" "case/$2"
  if [ -n "$3" ] && cmp -s "case/$2" "tidy/$2"; then fail "changes nothing"; fi
  run run
  [ "$status" = 0 ] || fail "ends with $status"
  has_points || fail "leaves no points"
  grep -qF "note: case/$4" said || fail "does not say: note: case/$4"
  rm -rf output
  run run --strict --quiet
  [ "$status" = 1 ] || fail "--strict ends with $status"
  grep -qF "error: case/$4" said || fail "--strict does not say: error: case/$4"
  [ ! -e output ] || fail "--strict leaves a folder"
}

name=tidy
cp -r tidy case
run run --strict
[ "$status" = 0 ] && has_points || fail "does not run"
grep -q '^note:' said && fail "has a note"

untidy "an MTL file that is not there" yard.obj 's/yard.mtl/gone.mtl/' "yard.obj, line 1: 'mtllib gone.mtl': expected an MTL file at "
untidy "vertical angles wider apart than the scanner's" survey.xml 's/scanFreq_hz/verticalAngleMin_deg="-90" verticalAngleMax_deg="90" &/' \
  'survey.xml:20:24: verticalAngleMin_deg and verticalAngleMax_deg are further apart'
untidy "voxels without a size" survey.xml 's/value="0.5"/value="0"/' 'survey.xml:12:46: voxelSize of 0 means 1 m'
untidy "a spectrum beyond all light" spectra/turf.txt 's/0.4/500/' "spectra/turf.txt, line 2: "
untidy "an attribute of another program" survey.xml 's/<leg /&colour="red" /' "survey.xml:18:10: attribute 'colour' of <leg> is not known"
untidy "bins longer than a pulse" survey.xml 's|<leg .*|<FWFSettings binSize_ns="9"/>&|' 'survey.xml:18:6: binSize_ns is 9 ns'
untidy "a path out of all folders" survey.xml 's|platform="#stand"|platform="../outside/more.xml#far"|' \
  'survey.xml:17:48: platform="../outside/more.xml#far" is outside the assets folders'
untidy "a template that nobody names" survey.xml 's|<survey|<scannerSettings id="t" scanFreq_hz="much"/>&|' \
  'survey.xml:17:27: scanFreq_hz="much": expected a number'
untidy "a face of two corners" yard.obj 's/^usemtl.*/&\nf 1 2/' "yard.obj, line 7: a face without area is left out"
untidy "an exponent below 0" yard.mtl 's/^Kd.*/&\nNs -1.96/' "yard.mtl, line 3: material 'lawn': 'Ns -1.96' takes 0 for -1.96"
untidy "a colour of four numbers" yard.mtl 's/^Kd.*/& 1.0/' "yard.mtl, line 2: material 'lawn': 'Kd 0.5 0.5 0.5 1.0' has words after its numbers"
untidy "a cloud with names first" hedge.xyz '1i East North Height A B C' "hedge.xyz, line 1: 'East North Height A B C' is skipped, as names of columns"
untidy "a document in windows-1252" survey.xml 's|name="untidy"|name="unt\xE4dy"|' 'survey.xml:17:20: is no UTF-8, and is taken as windows-1252'
untidy "a name with slashes" survey.xml 's|name="untidy"|name="untidy/1"|' 'survey.xml:17:11: name="untidy/1" is taken as '
untidy "a trajectory that jumps" survey.xml \
  's|platform="#stand"|platform="interpolated"|; s|<platformSettings .*|<platformSettings trajectory="jump.trj"/>|' \
  "jump.trj, line 3: repeats the time of the previous pose at another pose, the first of 1: a jump of the platform"

# Waveforms that LAS cannot take as they are: as_las NAME BINS NOTE.
as_las() {
  name=$1
  rm -rf case output
  cp -r tidy case
  sed -i "s|<leg .*|<FWFSettings binSize_ns=\"$2\"/>&|; s/scanFreq_hz/beamDivergence_rad=\"0.1\" &/" case/survey.xml
  run run --format las --writeWaveform
  [ "$status" = 0 ] || fail "ends with $status"
  find output -name '*_points.wdp' -size +10000c 2> /dev/null | grep -q . || fail "leaves no waveforms"
  grep -qF "note: case/survey.xml:17:4: $3" said || fail "does not say: $3"
}
as_las "waveforms too long for LAS" 0.001 "waveforms are cut after 32.768 ns, 32768 samples, the maximum of LAS"
as_las "bins between picoseconds" 0.3333 "binSize_ns is 0.3333, and samples in LAS are whole picoseconds apart: it is taken as 0.333"

# Surveys without a pulse: silent NAME SED NOTE.
silent() {
  name=$1
  rm -rf case output
  cp -r tidy case
  sed -i "$2" case/survey.xml
  run run
  [ "$status" = 0 ] || fail "ends with $status"
  grep -qF "note: case/$3" said || fail "does not say: note: case/$3"
  grep -qE '(nan|inf)( |$)' said && fail "tells what is no number"
}
silent "a leg that ends at once" 's/ maxDuration_s="0.2"//; s/headRotateStop_deg="10"/headRotateStop_deg="0"/' \
  "survey.xml:20:67: headRotateStop_deg equals headRotateStart_deg: the leg ends at once"
silent "no active leg" 's/scanFreq_hz/active="false" &/' "survey.xml:17:4: no leg is active: there will be no pulses"

# Notes and errors are told together, and --strict does not hide what is wrong.
name="wrong and odd"
rm -rf case
cp -r tidy case
sed -i 's/<leg /&colour="red" /; s/scanFreq_hz="20"/scanFreq_hz="much"/' case/survey.xml
run check
[ "$status" = 1 ] || fail "ends with $status"
grep -qF "note: case/survey.xml:18:10: attribute 'colour'" said || fail "does not tell what is odd"
grep -qF 'case/survey.xml:20:24: scanFreq_hz="much": expected a number' said || fail "does not tell what is wrong"
for command in run check info preview forecast; do
  name="--strict $command"
  cp tidy/survey.xml case/survey.xml
  sed -i 's/<leg /&colour="red" /' case/survey.xml
  run $command --strict
  [ "$status" = 1 ] || fail "ends with $status"
  grep -qF "error: case/survey.xml:18:10: attribute 'colour'" said || fail "does not tell what is odd"
  grep -qF "error: --strict treats notes as errors: 1 of them" said || fail "does not say why"
done

[ "$failures" = 0 ] || exit 1
echo "All untidy surveys run."
