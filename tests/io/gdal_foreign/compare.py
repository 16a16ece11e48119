# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT

"""Rasters that GDAL writes, as we read them: python3 compare.py PROGRAM [FILES [SEED]].

Each file is one of a kind: type and layout of numbers, compression, place, reference system, unit, scale, mask, and
what marks missing heights are drawn. Its truth is what GDAL reads. A file must be read right, noted, or refused.
"""

import os
import random
import subprocess
import sys
import tempfile

import numpy as np
from osgeo import gdal, osr

gdal.UseExceptions()
osr.UseExceptions()

TYPES = {gdal.GDT_Byte: np.uint8, gdal.GDT_UInt16: np.uint16, gdal.GDT_Int16: np.int16, gdal.GDT_UInt32: np.uint32,
         gdal.GDT_Int32: np.int32, gdal.GDT_Float32: np.float32, gdal.GDT_Float64: np.float64}
METRES = {"metre": 1, "m": 1, "ft": 0.3048, "foot": 0.3048, "US survey foot": 1200 / 3937, "cm": 0.01, "": None}
SYSTEMS = ["", "EPSG:25832", "EPSG:2056", "EPSG:28992", "EPSG:27700", "EPSG:2263", "EPSG:2225", "EPSG:26918+6360",
           "EPSG:25832+7837", "EPSG:2263+8228", "EPSG:2222", "EPSG:4326", "EPSG:32633+5773"]


def system(name):
    made = osr.SpatialReference()
    if name:
        made.SetFromUserInput(name)
    return made


def vertical_unit(reference):
    """Metres per unit of height by the vertical system, or None."""
    if not reference.IsVertical():
        return None
    return reference.GetTargetLinearUnits("VERT_CS") or None


def write(path, draw):
    """Writes a raster of one kind; gives a description of it."""
    kind = draw.choice(list(TYPES))
    columns, rows = draw.randint(2, 90), draw.randint(2, 90)
    reference = draw.choice(SYSTEMS)
    options = ["COMPRESS=" + draw.choice(["NONE", "LZW", "DEFLATE", "PACKBITS", "ZSTD"])]
    if options[0].split("=")[1] in ("LZW", "DEFLATE", "ZSTD") and draw.random() < 0.5:
        options.append("PREDICTOR=" + ("3" if kind in (gdal.GDT_Float32, gdal.GDT_Float64) else "2"))
    if draw.random() < 0.5:
        options += ["TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=%d" % draw.choice([16, 32])]
    else:
        options.append("BLOCKYSIZE=%d" % draw.choice([1, 7, 64]))
    options += draw.sample(["BIGTIFF=YES", "ENDIANNESS=BIG", "SPARSE_OK=TRUE", "GEOTIFF_VERSION=1.1"], draw.randint(0, 2))
    bands = draw.choice([1, 1, 1, 2, 3])
    options.append("INTERLEAVE=" + draw.choice(["PIXEL", "BAND"]))
    if draw.random() < 0.2:
        options.append("ALPHA=YES" if bands == 2 else "PROFILE=GDALGeoTIFF")
    if draw.random() < 0.2:
        options.append("TFW=YES")
    mask = draw.choice(["", "", "", "internal", "outside"])
    gdal.SetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES" if mask == "internal" else "NO")
    data = gdal.GetDriverByName("GTiff").Create(path, columns, rows, bands, kind, options)
    size = draw.choice([0.25, 1.0, 30.0])
    down = -1 if draw.random() < 0.9 else 1
    degrees = reference == "EPSG:4326"
    corner = (7.5, 51.25) if degrees else (500000.5, 5400000.25)
    step = 0.001 if degrees else size
    data.SetGeoTransform((corner[0], step, 0, corner[1], 0, down * step))
    if reference:
        data.SetProjection(system(reference).ExportToWkt())
    if draw.random() < 0.3:
        data.SetMetadataItem("AREA_OR_POINT", "Point")
    told = [options, reference, mask, "bands %d" % bands]
    type_ = TYPES[kind]
    for number in range(1, bands + 1):
        band = data.GetRasterBand(number)
        heights = np.array([[draw.randint(0, 200) for _ in range(columns)] for _ in range(rows)]).astype(type_)
        if np.issubdtype(type_, np.floating):
            heights += type_(0.25)
        if number == 1 or draw.random() < 0.5:
            missing = draw.choice([None, None, 0, 255, 17]) if number == 1 else None  # which is one for all bands
            if missing is not None:
                band.SetNoDataValue(missing)
                told.append("missing %s" % missing)
            if draw.random() < 0.3:
                band.SetScale(draw.choice([0.01, 0.1, 2.0]))
                told.append("scale")
            if draw.random() < 0.3:
                band.SetOffset(draw.choice([-10.0, 100.0]))
                told.append("offset")
            unit = draw.choice(["", "", "", "metre", "m", "ft", "US survey foot", "cm"])
            if unit:
                band.SetUnitType(unit)
                told.append(unit)
        band.WriteArray(heights)
    if mask:
        data.CreateMaskBand(gdal.GMF_PER_DATASET)
        kept = np.array([[draw.choice([0, 255]) for _ in range(columns)] for _ in range(rows)]).astype(np.uint8)
        data.GetRasterBand(1).GetMaskBand().WriteArray(kept)
    data = None
    return told


def truth(path):
    """Columns, rows, centre of the north-west pixel and size of pixels [m]; and heights from the north [m]."""
    data = gdal.Open(path)
    band = data.GetRasterBand(1)
    heights = band.ReadAsArray().astype(np.float64)
    reference = data.GetSpatialRef()
    metres = METRES[band.GetUnitType() or ""]
    if metres is None:
        metres = (vertical_unit(reference) if reference else None) or 1.0
    scale, offset = band.GetScale(), band.GetOffset()
    heights = ((offset or 0.0) + (1.0 if scale is None else scale) * heights) * metres
    missing = band.GetMaskBand().ReadAsArray() == 0
    if band.GetNoDataValue() is not None:  # of which GDAL tells one or the other
        missing |= band.ReadAsArray() == band.GetNoDataValue()
    alpha = data.GetRasterBand(data.RasterCount)
    if alpha.GetColorInterpretation() == gdal.GCI_AlphaBand:
        missing |= alpha.ReadAsArray() == 0
    heights[missing] = np.nan
    x, width, _, y, _, height = data.GetGeoTransform()
    unit = reference.GetLinearUnits() if reference and reference.IsProjected() else 1.0
    if height > 0:
        heights = heights[::-1]
        y, height = y + height * data.RasterYSize, -height
    place = [(x + width / 2) * unit, (y + height / 2) * unit, width * unit, -height * unit]
    return [data.RasterXSize, data.RasterYSize] + place, heights


def difference(path, line):
    """What we read otherwise than GDAL; or nothing."""
    expected, heights = truth(path)
    found = [float(word) for word in line.split()[1:7]]
    if max(abs(a - b) for a, b in zip(found, expected)) > 1e-6:
        return "%r in place of %r" % (found, expected)
    ours = np.fromfile(path + ".f32", np.float32).reshape(heights.shape)
    if not np.array_equal(np.isnan(ours), np.isnan(heights)):
        return "missing heights: %d in place of %d" % (np.isnan(ours).sum(), np.isnan(heights).sum())
    worst = np.nanmax(np.abs(ours - heights)) if not np.isnan(heights).all() else 0
    return "" if worst <= 1e-4 else "heights differ by up to %g m" % worst


def main():
    program, files, seed = sys.argv[1], int((sys.argv + ["200"])[2]), int((sys.argv + ["", "1"])[3] or 1)
    draw = random.Random(seed)
    wrong, noted, refused = 0, 0, {}
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, "%04d.tif" % number) for number in range(files)]
        told = [write(path, draw) for path in paths]
        lines = subprocess.run([program] + paths, capture_output=True, text=True, check=True).stdout.splitlines()
        for path, kind, line in zip(paths, told, lines):
            if line.startswith("refused"):
                reason = line.split(": ", 1)[1]
                refused[reason] = refused.get(reason, 0) + 1
                continue
            problem = difference(path, line)
            if problem and "coordinates without a unit" in line:
                noted += 1
            elif problem:
                wrong += 1
                print("%s, seed %d: %s\n  %s\n  %s" % (os.path.basename(path), seed, problem, kind, line))
    for reason, count in sorted(refused.items()):
        print("%d refused: %s" % (count, reason))
    print("%d files, %d wrong, %d of a code alone, noted" % (files, wrong, noted))
    sys.exit(1 if wrong or sum(refused.values()) > files / 2 else 0)


main()
