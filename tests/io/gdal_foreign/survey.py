# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

"""What the survey program writes of reference systems, as GDAL reads it: python3 survey.py PROGRAM ASSETS.

The system of LAS, LAZ and COPC files is the one asked for, and a wall's corner in its units lies where it should; trajectories
and footprints are GeoJSON.
"""

import pathlib
import struct
import subprocess
import sys
import tempfile

from osgeo import ogr, osr

ogr.UseExceptions()
osr.UseExceptions()

FOOT = 1200 / 3937  # US survey foot. Source: NIST SP 811 (2008), B.6
# a place in each, and the metres of its units: horizontal and vertical
SYSTEMS = {"2056": ((2600000, 1200000), 1, 1), "28992": ((155000, 463000), 1, 1), "2154": ((700000, 6600000), 1, 1),
           "27700": ((400000, 300000), 1, 1), "2263": ((300000, 60000), FOOT, 1), "2263+6360": ((300000, 60000), FOOT, FOOT),
           "25832+7837": ((500000, 5400000), 1, 1)}

program, assets = sys.argv[1:]
temporary = tempfile.TemporaryDirectory()
folder = pathlib.Path(temporary.name)
wrong = 0


def expect(is_right, *problem):
    global wrong
    if not is_right:
        wrong += 1
        print(*problem)


def write_survey(x, y):
    """A floor of 40 m by 40 m about a scanner 2 m above it; its corner is at x + 20, y + 20."""
    corners = [(x + i, y + j, 50) for i, j in ((-20, -20), (20, -20), (20, 20), (-20, 20))]
    (folder / "floor.obj").write_text("".join("v %r %r %r\n" % c for c in corners) + "f 1 2 3 4\n")
    path = folder / "survey.xml"
    path.write_text("""<document><scene id="w"><part id="1"><filter type="objloader"><param type="string" key="filepath" value="floor.obj"/>
</filter></part></scene><survey name="s" scene="#w" platform="data/platforms.xml#tripod" scanner="data/scanners_tls.xml#riegl_vz400"><leg>
<platformSettings x="%r" y="%r" z="50.5"/><scannerSettings pulseFreq_hz="100000" scanFreq_hz="50" headRotatePerSec_deg="180"
headRotateStop_deg="360" trajectoryTimeInterval_s="0.1"/></leg></survey></document>""" % (x, y))
    return path


def header_of(path):
    """Extent in the units of the file, whether the WKT bit is set, and the text of the system."""
    data = path.read_bytes()
    at, records = struct.unpack_from("<H", data, 94)[0], struct.unpack_from("<I", data, 100)[0]
    wkt = ""
    for _ in range(records):
        user, number, size = data[at + 2:at + 18].rstrip(b"\0"), *struct.unpack_from("<HH", data, at + 18)
        if (user, number) == (b"LASF_Projection", 2112):
            wkt = data[at + 54:at + 54 + size].rstrip(b"\0").decode()
        at += 54 + size
    return struct.unpack_from("<6d", data, 179), data[6] >> 4 & 1, wkt


for system, (place, metres, metres_up) in SYSTEMS.items():
    survey = write_survey(*place)
    for kind in ("las", "laz", "copc.laz"):
        output = folder / system / kind
        subprocess.run([program, survey, "--assets", assets, "--output", output, "--format", kind, "--epsg", system, "--seed", "1",
                        "--quiet", "--geojson"], check=True)
        for path in output.rglob("*.la[sz]"):
            (east, west, north, south, top, bottom), has_wkt, wkt = header_of(path)
            expect(has_wkt, system, kind, "has no WKT bit")
            (folder / "system.wkt").write_text(wkt)
            told = subprocess.run(["gdalsrsinfo", "-o", "epsg", folder / "system.wkt"], capture_output=True, text=True).stdout.strip()
            if "+" in system:  # which GDAL names by its parts
                reference = osr.SpatialReference(wkt)
                told = "EPSG:%s+%s" % (reference.GetAuthorityCode("PROJCS"), reference.GetAuthorityCode("VERT_CS"))
            expect(told == "EPSG:" + system, system, kind, "is", told)
            reach = (place[0] - 20.5 < west * metres < east * metres < place[0] + 20.5 and
                     place[1] - 20.5 < south * metres < north * metres < place[1] + 20.5 and
                     east * metres > place[0] + 19 and north * metres > place[1] + 19)
            expect(reach and abs(bottom * metres_up - 50) < 0.1, system, kind, "spans", west, east, south, north, bottom)
    files = list((folder / system / "las").rglob("*.geojson"))
    expect(files, system, "has no GeoJSON")
    for path in files:
        source = ogr.Open(str(path))  # which owns the layer
        layer = source.GetLayer(0)
        expect(layer.GetFeatureCount() > 0, path.name, "has no feature")
        for feature in layer:
            expect(feature.GetGeometryRef() is not None, path.name, "has a feature without a geometry")
print("wrong:", wrong)
sys.exit(wrong > 0)
